// Somebody at an emulated device who looks for the place where nothing is felt.
#pragma once
#include "core/draws.h"

#include <array>
#include <cstddef>
#include <string_view>

namespace palpa {

// Naive: follows what is felt, and is done after a second without force. Careful: then also feels
// for both ends of the range without force, and takes its middle.
enum class OperatorManner { Naive, Careful };
inline constexpr std::array<std::string_view, 2> operator_manner_names{"naive", "careful"};

struct OperatorSettings {
    OperatorManner manner = OperatorManner::Naive;
    bool has_force = true;             // false: only the picture says
    double threshold_newton = 0.075;   // weaker forces are not noticed
    double approach_m_per_s = 0.045;   // of the hand, while the molecules are apart
    double guess_angstrom = 2.77;      // where it believes the place to be, by the picture
    double handle_m_per_angstrom = 0;  // A_d, for hands that follow the picture alone
};

// Goes in until there is repulsion, then after what is felt in steps that halve wherever it turns
// round. The force is felt 0.15 s late and with noise, the hand drifts and trembles. How late, how
// noisy and how unsteady is assumed; so is the spread of guesses by the picture, which is why what
// is found without force is no prediction.
class SeekingOperator {
public:
    SeekingOperator(const OperatorSettings& settings, const Draws& draws);

    // One tick: the force on the hand (N, + pushes outward) and the distance in the picture (Å).
    void feel(double force_newton, double distance);

    // Where the hand wants the handle, outward from where it began.
    double wish_m() const noexcept { return intended_m_ + unsteady_m_ + tremor_m_; }
    // Presses the key.
    bool is_done() const noexcept { return is_done_; }

private:
    enum class State { Approach, Follow, FeelInward, FeelOutward, TakeMiddle };

    void enter(State state) noexcept;
    void perceive(double force_newton);
    double choose_speed(double distance) noexcept;
    double follow_force() noexcept;
    double follow_picture(double distance) noexcept;
    double take_middle() noexcept;
    // The state's doubt was gone for so long.
    bool has_rested() const noexcept;

    OperatorSettings settings_;
    Draws draws_;
    double tremor_phase_;

    // what is felt, N
    double smooth_newton_ = 0;  // by the skin
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
