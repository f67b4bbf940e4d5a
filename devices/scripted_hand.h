// The operator of an emulated device: follows a script, or leads the molecule by sight, and uses
// the clutch at the ends of the workspace.
#pragma once
#include "haptics/device.h"
#include "haptics/hand.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// If the path is longer than the workspace, the hand does what a person does: near the end of the
// box it waits for the handle, presses the clutch, carries the handle to the other side, releases
// the clutch and continues. A path that begins outside of the box starts at its edge. The path must
// move less than the width of the box in a tick. A hand that leads begins at the end of the box
// from where it has the longest way, and uses the clutch only on its way or when it must catch up.
class ScriptedHand {
public:
    // `half_workspace_m`: range of the handle in each direction. A hand that leads is never further
    // ahead of the handle than `most_ahead_m`.
    ScriptedHand(HandScript script, const Vec3& half_workspace_m, double most_ahead_m = 0.01);

    // The target of the handle, its speed (m/s) and the pressed buttons.
    struct Wish {
        Vec3 place_m = Vec3::Zero();
        Vec3 m_per_s = Vec3::Zero();
        Quat orientation = Quat::Identity();
        std::uint32_t buttons = 0;
    };

    // Starts the script again at its first position.
    void restart() noexcept;

    // What a leading hand sees; valid until a newer one arrives.
    struct Sight {
        Vec3 molecule_m = Vec3::Zero();  // position of the molecule, any origin
        double displacement_gain = 0;    // handle metres per molecule metre
        Vec3 handle_m = Vec3::Zero();
        std::uint32_t grip_number = 0;  // grip number of the contact model in use
    };
    void see(const Sight& sight) noexcept;

    // Replaces the path; its times count from now. A hand that leads continues from where its path
    // had the molecule; with `takes_anew` it is about to hold something else, and positions count
    // from there.
    void go_on(const std::vector<HandWaypoint>& path, bool takes_anew = false);

    // Advances by one tick.
    Wish step(double tick_s) noexcept;

    // Position of the first target, before any step.
    const Vec3& start_m() const noexcept { return last_m_; }
    const Quat& start_orientation() const noexcept { return orientation_; }

    // Impulse force on the handle at this moment (N, along x).
    double kick_newton(double time_s) const noexcept;

private:
    // The next position of the handle in an unlimited workspace.
    Vec3 follow_script(double tick_s) noexcept;
    Vec3 lead(double tick_s) noexcept;
    // For a leading hand: the displacement from the molecule to the position on its path.
    Vec3 find_lag() const noexcept;
    bool is_worth_clutching(const Vec3& carry) const noexcept;
    // Displacement to the other side if the next position is outside of the box, else 0.
    Vec3 find_carry(const Vec3& before, const Vec3& next) const noexcept;

    HandScript script_;
    Vec3 reach_m_;  // position at which it uses the clutch, by axis
    double most_ahead_m_;
    std::optional<Sight> first_sight_, sight_;
    bool takes_anew_ = false;      // waits for the first sight of the new molecule
    double script_time_s_ = 0;     // stops while clutching, or waiting for the molecule
    Vec3 shift_m_ = Vec3::Zero();  // handle position minus script position, from earlier clutching
    double clutch_time_s_ = -1;    // s since the button was pressed; negative: not clutching
    Vec3 carry_from_m_ = Vec3::Zero();  // start of the present carry
    Vec3 carry_m_ = Vec3::Zero();       // and its displacement
    Vec3 last_m_ = Vec3::Zero();
    Quat orientation_ = Quat::Identity();
};

}  // namespace palpa
