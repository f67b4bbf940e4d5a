// The operator of an emulated device: follows a script, and clutches where the workspace ends.
#pragma once
#include "haptics/device.h"
#include "haptics/hand.h"

#include <cstdint>

namespace palpa {

// A hand whose path is longer than the workspace does what a person does: near the end of the box
// it waits for the handle, presses the clutch, carries it to the other side, lets go, and goes on
// where it stopped. A path that begins outside of the box is begun at its edge. The path must be
// slower than the width of the box in a tick (a hand's few metres per second are).
class ScriptedHand {
public:
    // `half_width_m`: how far the handle can go either way along x.
    ScriptedHand(HandScript script, double half_width_m);

    // Where the hand wants the handle, how fast (m/s), and what it presses.
    struct Wish {
        double x_m = 0;
        double v_m_per_s = 0;
        std::uint32_t buttons = 0;
    };

    // From the beginning of the script, at its first place.
    void restart() noexcept;

    // Moves on by one tick.
    Wish step(double tick_s) noexcept;

    // The place of the first wish, before any step.
    double start_m() const noexcept { return last_x_m_; }

    // Impulse force on the handle at this moment (N, along x).
    double kick_newton(double time_s) const noexcept;

private:
    HandScript script_;
    double reach_m_;             // where it clutches
    double script_time_s_ = 0;   // stands still while clutching
    double shift_m_ = 0;         // handle place minus script place, from earlier clutching
    double clutch_time_s_ = -1;  // since the button went down; negative: not clutching
    double carry_from_m_ = 0;    // the handle is being carried from here
    double carry_m_ = 0;         // and this far
    double last_x_m_ = 0;
};

}  // namespace palpa
