#include "view/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <vector>

namespace palpa {
namespace {

// A point of a cross section whose half width and half thickness are 1: x along `aside`.
struct SectionPoint {
    glm::vec2 place, normal;
};

// Its points counter-clockwise as seen from ahead, the sides that join two of them, and its corners
// once each.
struct SectionShape {
    std::vector<SectionPoint> points;
    std::vector<std::array<std::uint32_t, 2>> sides;
    std::vector<std::uint32_t> corners;
};

SectionShape oval_shape(int sides) {
    SectionShape shape;
    const auto count = static_cast<std::uint32_t>(std::max(sides, 3));
    for (std::uint32_t i = 0; i < count; ++i) {
        const float angle =
            2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(count);
        const glm::vec2 place{std::cos(angle), std::sin(angle)};
        shape.points.push_back({place, place});
        shape.sides.push_back({i, (i + 1) % count});
        shape.corners.push_back(i);
    }
    return shape;
}

// Each side has its own two points, with its normal.
SectionShape box_shape() {
    SectionShape shape;
    constexpr std::array<glm::vec2, 4> corners{{{1, -1}, {1, 1}, {-1, 1}, {-1, -1}}};
    constexpr std::array<glm::vec2, 4> normals{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        shape.points.push_back({corners[i], normals[i]});
        shape.points.push_back({corners[(i + 1) % 4], normals[i]});
        shape.sides.push_back({2 * i, 2 * i + 1});
        shape.corners.push_back(2 * i);
    }
    return shape;
}

// In its own plane; how the body widens tilts it later.
void add_ring(const Ring& ring, const SectionShape& shape, MeshShape& mesh) {
    const glm::vec3 aside = ring.frame.aside, up = ring.frame.up();
    for (const SectionPoint& point : shape.points) {
        // Of an ellipse with these half axes; of a rectangle the length alone changes.
        const glm::vec3 normal =
            point.normal.x * ring.half_thickness * aside + point.normal.y * ring.half_width * up;
        mesh.vertices.push_back({ring.frame.place + point.place.x * ring.half_width * aside +
                                     point.place.y * ring.half_thickness * up,
                                 unit_or(normal, up), ring.colour, ring.pick});
    }
}

// Normals at right angles to the lines along the body. Where these fold back, on the inner side of
// sharp turns, they tilt no further.
void tilt_normals(std::span<const Ring> rings, std::size_t points, std::size_t first,
                  MeshShape& mesh) {
    constexpr float least_forward = 0.3F;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const std::size_t before = first + (i == 0 ? 0 : i - 1) * points;
        const std::size_t behind = first + std::min(i + 1, rings.size() - 1) * points;
        const glm::vec3 along = rings[i].frame.along;
        for (std::size_t k = 0; k < points; ++k) {
            const glm::vec3 line =
                mesh.vertices[behind + k].place - mesh.vertices[before + k].place;
            const float forward =
                std::max(glm::dot(line, along), least_forward * glm::length(line));
            glm::vec3& normal = mesh.vertices[first + i * points + k].normal;
            if (forward > 0)
                normal = glm::normalize(normal - glm::dot(normal, line) / forward * along);
        }
    }
}

void add_sides(const SectionShape& shape, std::uint32_t first, std::size_t rings, MeshShape& mesh) {
    const auto points = static_cast<std::uint32_t>(shape.points.size());
    for (std::size_t i = 0; i + 1 < rings; ++i, first += points) {
        for (const auto& [a, b] : shape.sides) {
            const std::uint32_t here_a = first + a, here_b = first + b;
            mesh.indices.insert(mesh.indices.end(), {here_a, here_b, here_a + points, here_b,
                                                     here_b + points, here_a + points});
        }
    }
}

// A flat face over places that go counter-clockwise as seen from outside.
void add_face(std::span<const glm::vec3> outline, const glm::vec3& normal, const Look& look,
              MeshShape& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const glm::vec3& place : outline)
        mesh.vertices.push_back({place, normal, look.colour, look.pick});
    for (std::uint32_t i = 2; i < outline.size(); ++i)
        mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
}

void add_end(const Ring& ring, const SectionShape& shape, std::size_t first, bool ahead,
             MeshShape& mesh) {
    std::vector<glm::vec3> outline;
    for (const std::uint32_t corner : shape.corners)
        outline.push_back(mesh.vertices[first + corner].place);
    if (!ahead) std::ranges::reverse(outline);
    add_face(outline, ahead ? ring.frame.along : -ring.frame.along, {ring.colour, ring.pick}, mesh);
}

}  // namespace

void add_sweep(std::span<const Ring> rings, CrossSection section, int sides, MeshShape& mesh) {
    if (rings.size() < 2) return;
    const SectionShape shape = section == CrossSection::Oval ? oval_shape(sides) : box_shape();
    const std::size_t first = mesh.vertices.size(), points = shape.points.size();
    for (const Ring& ring : rings) add_ring(ring, shape, mesh);
    tilt_normals(rings, points, first, mesh);
    add_sides(shape, static_cast<std::uint32_t>(first), rings.size(), mesh);
    add_end(rings.front(), shape, first, false, mesh);
    add_end(rings.back(), shape, first + (rings.size() - 1) * points, true, mesh);
}

bool add_plate(std::span<const glm::vec3> outline, float half_thickness, const Look& look,
               MeshShape& mesh) {
    glm::vec3 area{0};
    for (std::size_t i = 2; i < outline.size(); ++i)
        area += glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    const glm::vec3 normal = unit_or(area, glm::vec3(0));
    if (normal == glm::vec3(0)) return false;
    std::vector<glm::vec3> top, bottom;
    for (const glm::vec3& place : outline) {
        top.push_back(place + half_thickness * normal);
        bottom.push_back(place - half_thickness * normal);
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const std::size_t next = (i + 1) % outline.size();
        const std::array side{bottom[i], bottom[next], top[next], top[i]};
        const glm::vec3 out = glm::cross(outline[next] - outline[i], normal);
        add_face(side, unit_or(out, normal), look, mesh);
    }
    add_face(top, normal, look, mesh);
    std::ranges::reverse(bottom);
    add_face(bottom, -normal, look, mesh);
    return true;
}

}  // namespace palpa
