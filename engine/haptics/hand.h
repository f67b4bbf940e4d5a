// Models of the hand that holds the handle, and the path it wants to follow.
#pragma once
#include "core/choices.h"
#include "core/mailbox.h"
#include "math/vec.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace palpa {

// Mass, damping and stiffness of a hand along one axis, held to its target by spring and damper.
// With a grip, a second spring and damper stand between the handle and the hand's mass; without
// one the hand moves with the handle. The values are assumed, not measured.
struct HandModel {
    double mass_kg = 0;
    double damping_N_s_per_m = 0;
    double stiffness_N_per_m = 0;
    double grip_stiffness_N_per_m = 0;  // 0: no grip between
    double grip_damping_N_s_per_m = 0;
};

// The hand of that grip; nothing where nobody holds the handle.
std::optional<HandModel> hand_model(HandGrip grip) noexcept;

// The same hand once it wants no place any more: its mass and its damping stay on the handle.
std::optional<HandModel> relaxed(std::optional<HandModel> hand) noexcept;

// Spring between the handle and the place the hand wants, where nothing moves (N/m).
double static_stiffness(const HandModel& hand) noexcept;

// Where the hand wants the handle at a time. Between two waypoints it goes along a minimum-jerk
// curve, before the first and after the last it rests.
struct HandWaypoint {
    double time_s = 0;
    double x_m = 0, y_m = 0, z_m = 0;
    Vec3 turn_rad = Vec3::Zero();  // rotation vector
};

// From 0 to 1 for s from 0 to 1, at rest at both ends: 10 s^3 - 15 s^4 + 6 s^5; flat outside.
double minimum_jerk(double s) noexcept;

struct HandTarget {
    Vec3 place_m = Vec3::Zero();
    Quat orientation = Quat::Identity();
};

HandTarget find_target(const std::vector<HandWaypoint>& path, double time_s) noexcept;

// A hand turns back this far (m) before the stops of the workspace.
inline constexpr double stop_margin_m = 0.005;

// A hand's plan for a session: a path, when it lets go, and an impulse that knocks the handle.
struct HandScript {
    std::vector<HandWaypoint> path;  // times ascending
    // The path is the molecule's (m from its start): the hand brings it there by sight, and waits
    // for it.
    bool leads = false;
    std::optional<double> release_s = {};
    double kick_N_s = 0;  // along x, spread over `kick_duration_s`
    double kick_time_s = 1.0;
    double kick_duration_s = 0.01;
};

// What a window or an operator asks of the hand on an emulated device: they post, the device reads.
struct HandOrder {
    Vec3 target_m = Vec3::Zero();  // where the hand wants the handle
    std::uint32_t restarts = 0;    // another number: a script begins anew, a live hand rests
    bool frozen = false;           // time stands still for handle and hand
    std::uint32_t grants = 0;      // another number: `granted_ticks` go by although it is frozen
    int granted_ticks = 0;
};
using HandOrders = Mailbox<HandOrder>;

// A game pad as a window sees it: sticks from -1 to 1, x to the right and y towards the person.
// The window posts in every frame, and says beside whether there is a pad at all.
struct PadInput {
    bool is_there = false;
    double left_x = 0, left_y = 0, right_x = 0, right_y = 0;
    bool clutch = false;
};
struct PadLink {
    Mailbox<PadInput> inputs;
    std::atomic<bool> is_there{false};
};

// How a live hand goes after its target: never faster, and with no more pull on the handle, than
// this. A mouse can be anywhere at once, a hand cannot; its pull stays below the clamp of the
// forces that answer it, or it would go through every wall.
inline constexpr double live_hand_m_per_s = 0.25;
inline constexpr double live_hand_newton = 2.4;

}  // namespace palpa
