#include "render/mesh_lists.h"

#include "gpu/device.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace palpa {
namespace {

void check_mesh(const MeshShape& mesh, std::size_t number) {
    if (mesh.indices.size() % 3 != 0) {
        throw GpuError(fmt::format("mesh {} has {} indices; expected three for each triangle",
                                   number, mesh.indices.size()));
    }
    const auto bad = std::ranges::find_if(
        mesh.indices, [&](std::uint32_t index) { return index >= mesh.vertices.size(); });
    if (bad != mesh.indices.end()) {
        throw GpuError(fmt::format("mesh {} has index {}; expected less than its {} vertices",
                                   number, *bad, mesh.vertices.size()));
    }
}

// From -1 to 1 in 16 bits, and from 0 to 1 in 8, as unpackSnorm2x16 and unpackUnorm4x8 read them.
std::uint32_t snorm16(float value) {
    const float scaled = 32767 * value;
    return static_cast<std::uint32_t>(
               static_cast<std::int32_t>(scaled + std::copysign(0.5F, scaled))) &
           0xffffU;
}
std::uint32_t unorm8(float value) {
    return static_cast<std::uint32_t>(255 * std::clamp(value, 0.0F, 1.0F) + 0.5F);
}

// A direction's place on the octahedron |x| + |y| + |z| = 1, its lower half folded outward
// (Meyer et al. 2010, "On floating-point normal vectors").
std::uint32_t pack_normal(const glm::vec3& n) {
    const float sum = std::max(std::abs(n.x) + std::abs(n.y) + std::abs(n.z), 1e-20F);
    float x = n.x / sum, y = n.y / sum;
    if (n.z < 0) {
        const float folded = std::copysign(1 - std::abs(y), x);
        y = std::copysign(1 - std::abs(x), y);
        x = folded;
    }
    return snorm16(x) | snorm16(y) << 16;
}

std::uint32_t pack_paint(const glm::vec3& colour, float opacity) {
    const auto root = [](float value) { return unorm8(std::sqrt(std::max(value, 0.0F))); };
    return root(colour.r) | root(colour.g) << 8 | root(colour.b) << 16 | unorm8(opacity) << 24;
}

constexpr std::uint8_t too_near = 16;

// Which sides of the view a place is outside of, a bit each.
std::uint8_t sides_outside(const glm::vec3& place, const GpuFrame& frame) {
    const float w = -place.z, x = frame.projection.x * place.x + frame.centre.x * w,
                y = frame.projection.y * place.y + frame.centre.y * w;
    return static_cast<std::uint8_t>((x < -w ? 1 : 0) | (x > w ? 2 : 0) | (y < -w ? 4 : 0) |
                                     (y > w ? 8 : 0) | (w < frame.projection.z ? too_near : 0) |
                                     (w > frame.projection.w ? 32 : 0));
}

// From the camera at the origin.
bool faces_away(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return glm::dot(glm::cross(b - a, c - a), a) > 0;
}

}  // namespace

void MeshLists::build(const std::vector<MeshShape>& meshes, const glm::mat4& view,
                      const GpuFrame& frame) {
    for (std::size_t i = 0; i < meshes.size(); ++i) check_mesh(meshes[i], i);
    placed_.clear();
    outside_.clear();
    for (std::vector<Corners>& kind : kinds_) kind.clear();
    for (const MeshShape& mesh : meshes) {
        if (mesh.opacity > 0) add_mesh(mesh, view, frame);
    }
    number_triangles();
}

void MeshLists::add_mesh(const MeshShape& mesh, const glm::mat4& view, const GpuFrame& frame) {
    const auto first = static_cast<std::uint32_t>(placed_.size());
    const glm::mat3 turn(view);
    const glm::vec3 shift(view[3]);
    bool is_cut_by_near_plane = false;
    for (const MeshVertex& vertex : mesh.vertices) {
        const glm::vec3 place = turn * vertex.place + shift;
        placed_.push_back(
            {place, pack_normal(turn * vertex.normal), pack_paint(vertex.colour, mesh.opacity)});
        outside_.push_back(sides_outside(place, frame));
        is_cut_by_near_plane = is_cut_by_near_plane || (outside_.back() & too_near) != 0;
    }
    const std::size_t kind = mesh.opacity < 1 ? 2 : 0;
    const bool hides_backs = mesh.is_closed && kind == 0 && !is_cut_by_near_plane;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t a = first + mesh.indices[i], b = first + mesh.indices[i + 1],
                            c = first + mesh.indices[i + 2];
        if ((outside_[a] & outside_[b] & outside_[c]) != 0) continue;
        if (hides_backs && faces_away(placed_[a].place, placed_[b].place, placed_[c].place))
            continue;
        const bool is_across = (outside_[a] | outside_[b] | outside_[c]) != 0;
        kinds_[kind + (is_across ? 1 : 0)].push_back(
            {{a, b, c}, mesh.vertices[mesh.indices[i]].pick});
    }
}

void MeshLists::number_triangles() {
    vertices_.clear();
    picks_.clear();
    for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
        ranges_[kind] = {picks_.size(), kinds_[kind].size()};
        for (const Corners& corners : kinds_[kind]) {
            for (const std::uint32_t corner : corners.of) vertices_.push_back(placed_[corner]);
            picks_.push_back(corners.pick);
        }
    }
}

}  // namespace palpa
