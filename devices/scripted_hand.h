// The operator of an emulated device: follows a script, or leads the molecule by sight, and
// clutches where the workspace ends.
#pragma once
#include "haptics/device.h"
#include "haptics/hand.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// A hand whose path is longer than the workspace does what a person does: near the end of the box
// it waits for the handle, presses the clutch, carries it to the other side, lets go, and goes on
// where it stopped. A path that begins outside of the box is begun at its edge. The path must be
// slower than the width of the box in a tick (a hand's few metres per second are). A hand that
// leads begins at the end of the box from where it has the longest way, and clutches only on its
// way or where it must catch up.
class ScriptedHand {
public:
    // `half_workspace_m`: how far the handle can go either way. One that leads is never further
    // ahead of the handle than `most_ahead_m`.
    ScriptedHand(HandScript script, const Vec3& half_workspace_m, double most_ahead_m = 0.01);

    // Where the hand wants the handle, how fast (m/s), and what it presses.
    struct Wish {
        Vec3 place_m = Vec3::Zero();
        Vec3 m_per_s = Vec3::Zero();
        Quat orientation = Quat::Identity();
        std::uint32_t buttons = 0;
    };

    // From the beginning of the script, at its first place.
    void restart() noexcept;

    // What one that leads goes by, as long as nothing newer comes.
    struct Sight {
        Vec3 molecule_m = Vec3::Zero();  // where it is, on any origin
        double displacement_gain = 0;    // handle metres per molecule metre
        Vec3 handle_m = Vec3::Zero();
        std::uint32_t start = 0;  // of the contact model by which it was taken
    };
    void see(const Sight& sight) noexcept;

    // From now on it follows this path, whose times count from now, in place of its own. One that
    // leads goes there from where its path had the molecule; `takes_anew`: it is about to hold
    // something else, and places are counted from where that is.
    void go_on(const std::vector<HandWaypoint>& path, bool takes_anew = false);

    // Moves on by one tick.
    Wish step(double tick_s) noexcept;

    // Of the first wish, before any step.
    const Vec3& start_m() const noexcept { return last_m_; }
    const Quat& start_orientation() const noexcept { return orientation_; }

    // Impulse force on the handle at this moment (N, along x).
    double kick_newton(double time_s) const noexcept;

private:
    // Where the handle is to be next, were there no end of the workspace.
    Vec3 follow_script(double tick_s) noexcept;
    Vec3 lead(double tick_s) noexcept;
    // Of one that leads: from where the molecule is to where its path says.
    Vec3 find_lag() const noexcept;
    bool is_worth_clutching(const Vec3& carry) const noexcept;
    // To the other side where the next place is outside of the box; 0 where it is inside.
    Vec3 find_carry(const Vec3& before, const Vec3& next) const noexcept;

    HandScript script_;
    Vec3 reach_m_;  // where it clutches, by axis
    double most_ahead_m_;
    std::optional<Sight> first_sight_, sight_;
    bool takes_anew_ = false;           // what it will hold begins a sight of its own
    double script_time_s_ = 0;          // stands still while clutching, or waiting for the molecule
    Vec3 shift_m_ = Vec3::Zero();       // handle place minus script place, from earlier clutching
    double clutch_time_s_ = -1;         // since the button went down; negative: not clutching
    Vec3 carry_from_m_ = Vec3::Zero();  // the handle is being carried from here
    Vec3 carry_m_ = Vec3::Zero();       // and this far
    Vec3 last_m_ = Vec3::Zero();
    Quat orientation_ = Quat::Identity();
};

}  // namespace palpa
