// A camera that a person turns about what they look at.
#pragma once
#include "haptics/device.h"
#include "render/frame_scene.h"

#include <glm/vec3.hpp>
#include <span>

namespace palpa {

// Looks at `target` from `distance` away; y is up.
struct OrbitCamera {
    glm::vec3 target{0};
    float distance = 10;          // Å
    float azimuth = 0;            // rad, about y; 0 looks along -z
    float elevation = 0;          // rad, + from above
    float vertical_angle = 0.6F;  // rad
};

// The direction from the target to the eye, and to the right and upwards in the picture.
glm::vec3 backward(const OrbitCamera& camera);
glm::vec3 rightward(const OrbitCamera& camera);
glm::vec3 upward(const OrbitCamera& camera);

// Turns; never over the top.
void orbit(OrbitCamera& camera, float azimuth, float elevation);
// Shifts by pixels of a picture `height` pixels high, so that what is at the target's depth
// follows.
void pan(OrbitCamera& camera, float right, float down, float height);
// Å at the depth of a place that a pixel covers, in a picture `height` pixels high.
float angstrom_per_pixel(const OrbitCamera& camera, const glm::vec3& place, float height);
// Nearer for factors below 1.
void zoom(OrbitCamera& camera, float factor);
// What is seen goes at a hand's rate for a time, as if it were in hand: to the right and up by a
// height of the picture, or nearer by a factor of e, for every `carried_m` of the hand. It turns
// with the hand, but never over, and does not roll.
inline constexpr double carried_m = 0.060;
void carry(OrbitCamera& camera, const HandRate& rate, double dt_s);
// All shapes, or these, fit with a margin into the room that the picture has for them, seen in the
// direction in which the camera looks. `aspect` and `share`: the room's width and height over the
// height of the picture. Where there are no shapes, nothing changes.
void frame_all(OrbitCamera& camera, const FrameScene& frame, float aspect, float share = 1);
void frame_shapes(OrbitCamera& camera, std::span<const SphereShape> shapes, float aspect,
                  float share = 1);
// Looks at one place, from near.
void focus(OrbitCamera& camera, const glm::vec3& place, float distance);

// With clip planes in front of and behind all shapes, and fog behind the target.
FrameCamera frame_camera(const OrbitCamera& camera, const FrameScene& frame);

}  // namespace palpa
