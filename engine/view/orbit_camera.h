// A camera that circles around a place: how it moves, and from where it sees all of something.
#pragma once
#include "render/frame_scene.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace palpa {

// Without azimuth and elevation it looks along -z, y up. The azimuth takes it to its right around
// the target, the elevation above it, almost to the poles and no further.
struct OrbitCamera {
    glm::vec3 target{0};               // Å
    float distance = 10;               // Å, from the target
    float azimuth = 0, elevation = 0;  // rad
    float vertical_angle = 0.6F;       // rad, of the whole picture
};

// From the camera to its target, and to its right and up in the picture: unit vectors.
struct CameraAxes {
    glm::vec3 forward, right, up;
};
CameraAxes camera_axes(const OrbitCamera& camera);

void orbit(OrbitCamera& camera, float azimuth, float elevation);

// Takes what is at the target along with a pointer that moves right and up by these shares of the
// picture's height.
void pan(OrbitCamera& camera, const glm::vec2& move);

// Comes nearer by this factor; further away below 1. Stays between 0.5 and 10,000 Å.
void zoom(OrbitCamera& camera, float factor);

// Looks at shapes from where all of them fit into a picture of that aspect (width over height) with
// a margin, in the direction in which it looks already. Where there are none, nothing changes.
void focus(OrbitCamera& camera, std::span<const SphereShape> shapes, float aspect);
void frame_all(OrbitCamera& camera, const FrameScene& scene, float aspect);

// The camera as the renderer wants it, with near and far around everything that the scene shows.
FrameCamera build_camera(const OrbitCamera& camera, const FrameScene& scene);

}  // namespace palpa
