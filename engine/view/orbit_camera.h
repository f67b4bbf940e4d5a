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
// The same, while what is seen at a place of the picture stays there, if it is at the target's
// depth: a place so many pixels to the right of the target and below it.
void zoom_at(OrbitCamera& camera, float factor, float right, float down, float height);
// On the way from one camera to another, `share` from 0 to 1: turns the short way round, and comes
// nearer by equal factors in equal shares.
OrbitCamera between(const OrbitCamera& from, const OrbitCamera& to, float share);
// A share of the time as a share of the way: slow at both ends.
float eased(float share);
// What is seen goes at a hand's rate for a time, as if it were in hand: to the right and up by a
// height of the picture, or nearer by a factor of e, for every `carried_m` of the hand. It turns
// with the hand, but never over, and does not roll.
inline constexpr double carried_m = 0.060;
void carry(OrbitCamera& camera, const HandRate& rate, double dt_s);
// The part of a picture that is there for shapes, over the picture's height: all of a picture of
// that aspect, or less where panels cover the rest.
struct Room {
    float width, height = 1;

    Room(float aspect) : width(aspect) {}  // NOLINT(google-explicit-constructor)
    Room(float width_share, float height_share) : width(width_share), height(height_share) {}
};

// All shapes, or these, fit into the room with a margin, seen in the direction in which the camera
// looks. Where there are none, nothing changes.
void frame_all(OrbitCamera& camera, const FrameScene& frame, const Room& room);
void frame_shapes(OrbitCamera& camera, std::span<const SphereShape> shapes, const Room& room);
// Looks at one place, from near.
void focus(OrbitCamera& camera, const glm::vec3& place, float distance);

// With clip planes in front of and behind all shapes, and fog behind the target.
FrameCamera frame_camera(const OrbitCamera& camera, const FrameScene& frame);

}  // namespace palpa
