#include "view/orbit_camera.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

namespace palpa {
namespace {

constexpr float margin = 1.12F;  // around what is framed
constexpr float pole = 1.55F;    // rad, the highest elevation: up must not be forward
constexpr float nearest = 0.5F, furthest = 1e4F;  // Å
constexpr float near_share = 0.02F;               // of the distance; nothing nearer is drawn

// What a scene shows, as spheres: a cone's ends stand for it.
std::vector<SphereShape> outlines(const FrameScene& scene) {
    std::vector<SphereShape> spheres = scene.spheres;
    for (const ConeShape& cone : scene.cones) {
        spheres.push_back({cone.a, cone.radius_a});
        spheres.push_back({cone.b, cone.radius_b});
    }
    return spheres;
}

}  // namespace

CameraAxes camera_axes(const OrbitCamera& camera) {
    const float sine = std::sin(camera.azimuth), cosine = std::cos(camera.azimuth);
    const float level = std::cos(camera.elevation);
    const glm::vec3 forward(-sine * level, -std::sin(camera.elevation), -cosine * level);
    const glm::vec3 right(cosine, 0, -sine);
    return {forward, right, glm::cross(right, forward)};
}

void orbit(OrbitCamera& camera, float azimuth, float elevation) {
    camera.azimuth = std::remainder(camera.azimuth + azimuth, 6.2831853F);
    camera.elevation = std::clamp(camera.elevation + elevation, -pole, pole);
}

void pan(OrbitCamera& camera, const glm::vec2& move) {
    const CameraAxes axes = camera_axes(camera);
    const float height = 2 * camera.distance * std::tan(camera.vertical_angle / 2);
    camera.target -= height * (move.x * axes.right + move.y * axes.up);
}

void zoom(OrbitCamera& camera, float factor) {
    camera.distance = std::clamp(camera.distance / factor, nearest, furthest);
}

void focus(OrbitCamera& camera, std::span<const SphereShape> shapes, float aspect) {
    if (shapes.empty()) return;
    const CameraAxes axes = camera_axes(camera);
    const auto in_view = [&](const glm::vec3& p) {
        return glm::vec3(glm::dot(p, axes.right), glm::dot(p, axes.up), -glm::dot(p, axes.forward));
    };
    glm::vec3 low(std::numeric_limits<float>::max()), high = -low;
    for (const SphereShape& shape : shapes) {
        low = glm::min(low, in_view(shape.centre) - shape.radius);
        high = glm::max(high, in_view(shape.centre) + shape.radius);
    }
    const glm::vec3 middle = 0.5F * (low + high);
    const float slope = std::tan(camera.vertical_angle / 2);
    float distance = nearest;
    for (const SphereShape& shape : shapes) {
        const glm::vec3 off = glm::abs(in_view(shape.centre) - middle) + shape.radius;
        const float before = in_view(shape.centre).z - middle.z + shape.radius;
        distance = std::max(distance, before + margin * std::max(off.y, off.x / aspect) / slope);
    }
    camera.target = middle.x * axes.right + middle.y * axes.up - middle.z * axes.forward;
    camera.distance = std::min(distance, furthest);
}

void frame_all(OrbitCamera& camera, const FrameScene& scene, float aspect) {
    focus(camera, outlines(scene), aspect);
}

FrameCamera build_camera(const OrbitCamera& camera, const FrameScene& scene) {
    const CameraAxes axes = camera_axes(camera);
    FrameCamera built;
    built.eye = camera.target - camera.distance * axes.forward;
    built.target = camera.target;
    built.up = axes.up;
    built.vertical_angle = camera.vertical_angle;
    built.near = camera.distance;
    built.far = camera.distance;
    for (const SphereShape& shape : outlines(scene)) {
        const float away = glm::dot(shape.centre - built.eye, axes.forward);
        built.near = std::min(built.near, away - 1.01F * shape.radius);
        built.far = std::max(built.far, away + 1.01F * shape.radius);
    }
    built.near = std::max(0.9F * built.near, near_share * camera.distance);
    built.far = std::max(1.1F * built.far, 2 * built.near);
    return built;
}

}  // namespace palpa
