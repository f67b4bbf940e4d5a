// An emulated person who leads a molecule by the mouse, and sees only what a frame of the window
// shows.
#pragma once
#include "core/draws.h"
#include "devices/mouse_lead.h"
#include "haptics/hand.h"
#include "haptics/servo.h"
#include "view/orbit_camera.h"

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace palpa {

// Drags with Space held towards a place in the picture, at most 1,500 pixels a second; releases
// Space after every 600 pixels, and pauses for 0.2 s. The direction of each drag is wrong by some
// degrees; the next one corrects it. The wheel goes in and out. These numbers are assumed.
class MousePerson {
public:
    static constexpr double pixels_per_s = 1500, longest_drag_pixels = 600, pause_s = 0.2;

    explicit MousePerson(std::uint64_t seed) : draws_(seed, 0) {}

    // The person's input until the next frame.
    struct Motion {
        bool holds = false;         // Space
        float right = 0, down = 0;  // pixels
        float notches = 0;          // of the wheel
    };
    // `ring`, `goal`: where the hand wants the molecule by now, and where the person wants it, Å.
    Motion act(const OrbitCamera& camera, float height, const glm::vec3& ring,
               const glm::vec3& goal, double passed_s);

private:
    Draws draws_;
    double paused_s_ = pause_s, dragged_ = 0, until_notch_s_ = 0;
    double error_rad_ = 0;  // of the direction of this drag
    bool holds_ = false;
};

// A MousePerson at a window: every 33 ms a frame, whose view follows the molecule, turns the
// person's input into orders for a mouse handle. Drags beyond the goal if the molecule stays behind
// it.
class MousePersonAtWindow {
public:
    MousePersonAtWindow(double reach_m, HandOrders& orders, std::uint64_t seed)
        : lead_(reach_m), orders_(orders), person_(seed) {}

    static constexpr int ticks_per_frame = 33;

    // One tick of the servo; `goal_angstrom`: where the person wants the molecule, as
    // ContactModel::molecule has its place.
    void see(const ServoTick& tick, const Vec3& goal_angstrom);

private:
    MouseLead lead_;
    HandOrders& orders_;
    MousePerson person_;
    Vec3 beyond_ = Vec3::Zero();  // how far beyond the goal the person drags (Å)
    int ticks_ = 0;
};

}  // namespace palpa
