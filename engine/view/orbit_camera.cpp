#include "view/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace palpa {
namespace {

constexpr float steepest = 1.55F;                        // rad
constexpr float nearest_view = 1, farthest_view = 2000;  // Å, from the target
constexpr float margin = 1.12F;                          // around what is framed

// What a scene shows, as balls: a cone's ends stand for it, and a mesh's vertices.
std::vector<SphereShape> balls_of(const FrameScene& frame) {
    std::vector<SphereShape> balls = frame.spheres;
    for (const ConeShape& cone : frame.cones) {
        balls.push_back({cone.a, cone.radius_a});
        balls.push_back({cone.b, cone.radius_b});
    }
    for (const MeshShape& mesh : frame.meshes)
        for (const MeshVertex& vertex : mesh.vertices) balls.push_back({vertex.place, 0});
    return balls;
}

}  // namespace

glm::vec3 backward(const OrbitCamera& c) {
    return {std::cos(c.elevation) * std::sin(c.azimuth), std::sin(c.elevation),
            std::cos(c.elevation) * std::cos(c.azimuth)};
}

glm::vec3 rightward(const OrbitCamera& c) { return {std::cos(c.azimuth), 0, -std::sin(c.azimuth)}; }

glm::vec3 upward(const OrbitCamera& c) { return glm::cross(backward(c), rightward(c)); }

void orbit(OrbitCamera& camera, float azimuth, float elevation) {
    camera.azimuth += azimuth;
    camera.elevation = std::clamp(camera.elevation + elevation, -steepest, steepest);
}

float angstrom_per_pixel(const OrbitCamera& camera, const glm::vec3& place, float height) {
    const glm::vec3 eye = camera.target + camera.distance * backward(camera);
    const float depth = std::max(glm::dot(eye - place, backward(camera)), 0.1F);
    return 2 * depth * std::tan(camera.vertical_angle / 2) / std::max(height, 1.0F);
}

glm::vec3 find_mouse_way(const OrbitCamera& camera, const glm::vec3& place, float height,
                         float right, float down, float notches) {
    constexpr float angstrom_per_notch = 0.25F;
    const float scale = angstrom_per_pixel(camera, place, height);
    return scale * (right * rightward(camera) - down * upward(camera)) -
           notches * angstrom_per_notch * backward(camera);
}

void pan(OrbitCamera& camera, float right, float down, float height) {
    const float scale = angstrom_per_pixel(camera, camera.target, height);
    camera.target += scale * (down * upward(camera) - right * rightward(camera));
}

void zoom(OrbitCamera& camera, float factor) {
    camera.distance = std::clamp(camera.distance * factor, nearest_view, farthest_view);
}

void zoom_at(OrbitCamera& camera, float factor, float right, float down, float height) {
    const float scale = angstrom_per_pixel(camera, camera.target, height);
    const glm::vec3 off = scale * (right * rightward(camera) - down * upward(camera));
    const float before = camera.distance;
    zoom(camera, factor);
    camera.target += (1 - camera.distance / before) * off;
}

OrbitCamera between(const OrbitCamera& from, const OrbitCamera& to, float share) {
    constexpr float turn = 2 * std::numbers::pi_v<float>;
    OrbitCamera camera;
    camera.target = glm::mix(from.target, to.target, share);
    camera.distance = from.distance * std::pow(to.distance / from.distance, share);
    camera.azimuth = from.azimuth + share * std::remainder(to.azimuth - from.azimuth, turn);
    camera.elevation = glm::mix(from.elevation, to.elevation, share);
    camera.vertical_angle = glm::mix(from.vertical_angle, to.vertical_angle, share);
    return camera;
}

float eased(float share) {
    const float inside = std::clamp(share, 0.0F, 1.0F);
    return inside * inside * (3 - 2 * inside);
}

void carry(OrbitCamera& camera, const HandRate& rate, double dt_s) {
    const Eigen::Vector3f way = (dt_s / carried_m * rate.m_per_s).cast<float>();
    const Eigen::Vector3f turn = (dt_s * rate.rad_per_s).cast<float>();
    pan(camera, way.x(), -way.y(), 1);
    zoom(camera, std::exp(-way.z()));
    orbit(camera, -turn.y(), turn.x());
}

void frame_all(OrbitCamera& camera, const FrameScene& frame, const Room& room) {
    frame_shapes(camera, balls_of(frame), room);
}

void frame_shapes(OrbitCamera& camera, std::span<const SphereShape> shapes, const Room& room) {
    if (shapes.empty()) return;
    const glm::vec3 right = rightward(camera), up = upward(camera), back = backward(camera);
    const auto across = [&](const glm::vec3& p) {
        return glm::vec3(glm::dot(p, right), glm::dot(p, up), glm::dot(p, back));
    };
    glm::vec3 low = across(shapes[0].centre), high = low;
    for (const SphereShape& shape : shapes) {
        low = glm::min(low, across(shape.centre) - shape.radius);
        high = glm::max(high, across(shape.centre) + shape.radius);
    }
    const glm::vec3 middle = 0.5F * (low + high);
    const float slope = std::tan(camera.vertical_angle / 2);
    camera.target = middle.x * right + middle.y * up + middle.z * back;
    camera.distance = nearest_view;
    for (const SphereShape& shape : shapes) {
        const glm::vec3 off = across(shape.centre) - middle;
        const glm::vec3 reach = glm::abs(off) + shape.radius;
        const float before = off.z + shape.radius;
        camera.distance = std::max(
            camera.distance,
            before + margin * std::max(reach.y / room.height, reach.x / room.width) / slope);
    }
}

FrameCamera frame_camera(const OrbitCamera& camera, const FrameScene& frame) {
    FrameCamera made;
    const glm::vec3 back = backward(camera);
    made.target = camera.target;
    made.eye = camera.target + camera.distance * back;
    made.vertical_angle = camera.vertical_angle;
    float nearest = camera.distance, farthest = camera.distance;
    for (const SphereShape& ball : balls_of(frame)) {
        const float depth = glm::dot(made.eye - ball.centre, back);
        nearest = std::min(nearest, depth - ball.radius);
        farthest = std::max(farthest, depth + ball.radius);
    }
    made.far = std::max(1.02F * farthest, 1.0F);
    made.near = std::max(0.98F * nearest, 1e-3F * made.far);
    constexpr float shortest_fog = 30;  // Å, so that a small molecule has next to none
    made.fog_from = camera.distance;
    made.fog_length = std::max(farthest - camera.distance, shortest_fog);
    return made;
}

}  // namespace palpa
