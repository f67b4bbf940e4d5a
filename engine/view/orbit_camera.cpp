#include "view/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace palpa {
namespace {

constexpr float steepest = 1.5F;  // rad
constexpr float margin = 1.15F;   // around all shapes

template <class Include>
void each_ball(const FrameScene& frame, const Include& include) {
    for (const SphereShape& sphere : frame.spheres) include(sphere.centre, sphere.radius);
    for (const ConeShape& cone : frame.cones) {
        include(cone.a, cone.radius_a);
        include(cone.b, cone.radius_b);
    }
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

void pan(OrbitCamera& camera, float right, float down, float height) {
    const float scale = angstrom_per_pixel(camera, camera.target, height);
    camera.target += scale * (down * upward(camera) - right * rightward(camera));
}

void zoom(OrbitCamera& camera, float factor) {
    camera.distance = std::clamp(camera.distance * factor, 1.0F, 2000.0F);
}

void frame_all(OrbitCamera& camera, const FrameScene& frame, float aspect) {
    if (frame.spheres.empty()) return;
    const glm::vec3 right = rightward(camera), up = upward(camera), back = backward(camera);
    const auto across = [&](const glm::vec3& p) {
        return glm::vec3(glm::dot(p, right), glm::dot(p, up), glm::dot(p, back));
    };
    glm::vec3 low = across(frame.spheres[0].centre), high = low;
    each_ball(frame, [&](const glm::vec3& centre, float radius) {
        low = glm::min(low, across(centre) - radius);
        high = glm::max(high, across(centre) + radius);
    });
    const glm::vec3 middle = 0.5F * (low + high), half = 0.5F * (high - low);
    const float slope = std::tan(camera.vertical_angle / 2);
    camera.target = middle.x * right + middle.y * up + middle.z * back;
    camera.distance = half.z + margin * std::max(half.y / slope, half.x / (slope * aspect));
}

void focus(OrbitCamera& camera, const glm::vec3& place, float distance) {
    camera.target = place;
    camera.distance = distance;
}

FrameCamera frame_camera(const OrbitCamera& camera, const FrameScene& frame) {
    FrameCamera made;
    const glm::vec3 back = backward(camera);
    made.target = camera.target;
    made.eye = camera.target + camera.distance * back;
    made.vertical_angle = camera.vertical_angle;
    float nearest = camera.distance, farthest = camera.distance;
    each_ball(frame, [&](const glm::vec3& centre, float radius) {
        const float depth = glm::dot(made.eye - centre, back);
        nearest = std::min(nearest, depth - radius);
        farthest = std::max(farthest, depth + radius);
    });
    made.far = std::max(1.02F * farthest, 1.0F);
    made.near = std::max(0.98F * nearest, 1e-3F * made.far);
    return made;
}

}  // namespace palpa
