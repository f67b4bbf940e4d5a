// Models of the hand that holds the handle, and the path that it follows.
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
    double grip_stiffness_N_per_m = 0;  // 0: rigid grip
    double grip_damping_N_s_per_m = 0;
};

// The hand model for a grip; nothing if nobody holds the handle.
std::optional<HandModel> hand_model(HandGrip grip) noexcept;

// The same hand without a target: only its mass and damping act on the handle.
std::optional<HandModel> relaxed(std::optional<HandModel> hand) noexcept;

// Static stiffness between the handle and the target of the hand, N/m.
double static_stiffness(const HandModel& hand) noexcept;

// Target of the handle at one time. Between two waypoints it follows a minimum-jerk curve; before
// the first and after the last it rests.
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

// Distance (m) from the stops of the workspace at which a hand turns back.
inline constexpr double stop_margin_m = 0.005;

// The plan of a hand: a path, the time of release, and an impulse on the handle.
struct HandScript {
    std::vector<HandWaypoint> path;  // ascending times
    // The path is that of the molecule (m from its start): the hand leads it there by sight and
    // waits for it.
    bool leads = false;
    std::optional<double> release_s = {};
    double kick_N_s = 0;  // along x, spread over `kick_duration_s`
    double kick_time_s = 1.0;
    double kick_duration_s = 0.01;
};

// Orders of a window or an operator for the hand on an emulated device: they post, the device
// reads.
struct HandOrder {
    Vec3 target_m = Vec3::Zero();  // target of the handle
    // Presses the clutch: the hand carries the handle back to the middle without the molecule.
    bool is_clutched = false;
    std::uint32_t restarts = 0;  // a new number restarts the script, or lets a live hand rest
    bool frozen = false;         // stops time for handle and hand
    std::uint32_t grants = 0;    // a new number lets `granted_ticks` pass while frozen
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
