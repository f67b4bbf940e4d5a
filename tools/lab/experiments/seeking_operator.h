// An emulated operator who searches for the place without force.
#pragma once
#include "core/draws.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace palpa {

// Naive: follows the force, and is done after a second without force. Careful: then also finds both
// ends of the range without force, and takes its middle.
enum class OperatorManner { Naive, Careful };
inline constexpr std::array<std::string_view, 2> operator_manner_names{"naive", "careful"};

struct OperatorSettings {
    OperatorManner manner = OperatorManner::Naive;
    bool has_force = true;             // false: only the picture shows the place
    double threshold_newton = 0.075;   // detection threshold of forces
    double approach_m_per_s = 0.045;   // speed of the hand while the molecules are apart
    double guess_angstrom = 2.77;      // place that it estimates from the picture
    double handle_m_per_angstrom = 0;  // A_d, for operators without force
};

// Moves in until it feels repulsion, then follows the force in steps that halve at each reversal.
// The force is felt with a delay of 0.15 s and noise; the hand drifts and trembles. These numbers
// are assumed, and so is the spread of estimates from the picture; results without force are
// therefore inputs, not predictions.
class SeekingOperator {
public:
    SeekingOperator(const OperatorSettings& settings, const Draws& draws);

    // One tick: the force on the hand (N, + pushes outward) and the distance in the picture (Å).
    void feel(double force_newton, double distance);

    // Target of the handle, m, outward from its start.
    double wish_m() const noexcept { return intended_m_ + unsteady_m_ + tremor_m_; }
    // Whether the operator presses the key.
    bool is_done() const noexcept { return is_done_; }

private:
    enum class State { Approach, Follow, FeelInward, FeelOutward, TakeMiddle };

    void enter(State state) noexcept;
    void perceive(double force_newton);
    double choose_speed(double distance) noexcept;
    double follow_force() noexcept;
    double follow_picture(double distance) noexcept;
    double take_middle() noexcept;
    // Whether the state has been certain for long enough.
    bool has_rested() const noexcept;

    OperatorSettings settings_;
    Draws draws_;
    double tremor_phase_;

    // what is felt, N
    double smooth_newton_ = 0;  // low-pass of the skin
    std::array<double, 150> under_way_{};
    std::size_t tick_ = 0;
    double noise_newton_ = 0, noise_share_ = 0;
    double felt_newton_ = 0, mean_newton_ = 0;

    // what is done about it
    State state_ = State::Approach;
    double in_state_s_ = 0, rested_s_ = 0;
    double pace_m_per_s_, side_ = 0;
    double inner_m_ = 0, outer_m_ = 0;  // ends of the range without force
    bool is_done_ = false;

    // where the hand goes
    double intended_m_ = 0, unsteady_m_ = 0, tremor_m_ = 0;
};

}  // namespace palpa
