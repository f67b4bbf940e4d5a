// A camera that orbits a target.
#pragma once
#include "haptics/device.h"
#include "render/frame_scene.h"

#include <glm/vec3.hpp>
#include <span>

namespace palpa {

// Looks at `target` from `distance`; y is up.
struct OrbitCamera {
    glm::vec3 target{0};
    float distance = 10;          // Å
    float azimuth = 0;            // rad, about y; 0 looks along -z
    float elevation = 0;          // rad, + from above
    float vertical_angle = 0.6F;  // rad
};

// Unit vectors from the target to the eye, and to the right and upwards in the picture.
glm::vec3 backward(const OrbitCamera& camera);
glm::vec3 rightward(const OrbitCamera& camera);
glm::vec3 upward(const OrbitCamera& camera);

// Turns the camera; the elevation stays within ±90°.
void orbit(OrbitCamera& camera, float azimuth, float elevation);
// Shifts the camera by pixels of a picture of this height, so that points at the target's depth
// follow the mouse.
void pan(OrbitCamera& camera, float right, float down, float height);
// Å per pixel at the depth of a point, in a picture `height` pixels high.
float angstrom_per_pixel(const OrbitCamera& camera, const glm::vec3& place, float height);
// The way (Å) of a point at `place` by which it follows the mouse, pixels to the right and down, in
// a picture `height` pixels high; a notch of the wheel moves it away from the eye.
glm::vec3 find_mouse_way(const OrbitCamera& camera, const glm::vec3& place, float height,
                         float right, float down, float notches);
// Changes the distance by a factor; below 1 moves nearer.
void zoom(OrbitCamera& camera, float factor);
// The same while a point at the target's depth stays fixed in the picture: the point this many
// pixels to the right of the target and below it.
void zoom_at(OrbitCamera& camera, float factor, float right, float down, float height);
// Interpolates between two cameras, `share` 0 to 1: by the shorter rotation, with the logarithm of
// distance changing linearly.
OrbitCamera between(const OrbitCamera& from, const OrbitCamera& to, float share);
// Converts a share of time to a share of the way: slow at both ends.
float eased(float share);
// Moves the view by the velocity of a hand for a time, as if the hand held what is seen: by one
// picture height to the right or up, or nearer by a factor of e, for every `carried_m` of the hand.
// Turns with the hand, with elevation within ±90° and without roll.
inline constexpr double carried_m = 0.060;
void carry(OrbitCamera& camera, const HandRate& rate, double dt_s);
// The part of a picture available for shapes, relative to the picture's height: the whole of a
// picture of this aspect, or less if panels cover some.
struct Room {
    float width, height = 1;

    Room(float aspect) : width(aspect) {}  // NOLINT(google-explicit-constructor)
    Room(float width_share, float height_share) : width(width_share), height(height_share) {}
};

// Fits all shapes, or these, into the room with a margin, with unchanged direction. Without shapes
// nothing changes.
void frame_all(OrbitCamera& camera, const FrameScene& frame, const Room& room);
void frame_shapes(OrbitCamera& camera, std::span<const SphereShape> shapes, const Room& room);

// The camera of a frame, with clip planes in front of and behind all shapes, and fog behind the
// target.
FrameCamera frame_camera(const OrbitCamera& camera, const FrameScene& frame);

}  // namespace palpa
