#include "tools/lab/experiments/seeking_operator.h"

#include "core/repeatable.h"
#include "haptics/device.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa {
namespace {

constexpr double tick_s = servo_tick_s;

// Feeling: the delay of `under_way_`, 150 ticks, is a person's reaction time.
constexpr double skin_s = 0.03, attention_s = 0.2;
constexpr double noise_newton = 0.02, noise_s = 0.1;
constexpr double noise_share = 0.07, share_s = 0.3;  // of the force: Weber's law
constexpr double contact_newton = 0.15;              // that ends the approach

// Moving.
constexpr double first_pace_m_per_s = 0.02, last_pace_m_per_s = 0.0005;
constexpr double slowest_m_per_s = 0.001;
constexpr double follow_m_per_N_s = 0.02;  // speed for each newton beyond the threshold
constexpr double feel_m_per_s = 0.004, longest_feel_s = 8;
constexpr double drift_m = 0.0003, drift_s = 0.5;
constexpr double tremor_m = 0.00005 * std::numbers::sqrt2, tremor_hz = 9;
constexpr double no_doubt_s = 1;  // without doubt, then it is there

// By the picture.
constexpr double apart_angstrom = 1.2;  // beyond the guess: not in contact
constexpr double stop_angstrom = 0.02, there_angstrom = 0.03;

// Noise that forgets itself in `time_s`, of that size.
double wander(double value, double size, double time_s, Draws& draws) {
    return value - value * tick_s / time_s + size * std::sqrt(2 * tick_s / time_s) * draws.normal();
}

}  // namespace

SeekingOperator::SeekingOperator(const OperatorSettings& settings, const Draws& draws)
    : settings_(settings),
      draws_(draws),
      tremor_phase_(draws_.between(0, 2 * std::numbers::pi)),
      pace_m_per_s_(first_pace_m_per_s) {}

void SeekingOperator::feel(double force_newton, double distance) {
    perceive(force_newton);
    in_state_s_ += tick_s;
    const double speed = settings_.has_force ? choose_speed(distance) : follow_picture(distance);
    intended_m_ += speed * tick_s;
    unsteady_m_ = wander(unsteady_m_, drift_m, drift_s, draws_);
    const double turns = tremor_hz * static_cast<double>(tick_) * tick_s;
    tremor_m_ = tremor_m * (repeatable::sin(2 * std::numbers::pi * turns + tremor_phase_) -
                            repeatable::sin(tremor_phase_));
}

void SeekingOperator::perceive(double force_newton) {
    smooth_newton_ += (force_newton - smooth_newton_) * tick_s / skin_s;
    double& slot = under_way_[tick_++ % under_way_.size()];
    const double late = slot;
    slot = smooth_newton_;
    noise_newton_ = wander(noise_newton_, noise_newton, noise_s, draws_);
    noise_share_ = wander(noise_share_, noise_share, share_s, draws_);
    felt_newton_ = late * (1 + noise_share_) + noise_newton_;
    mean_newton_ += (felt_newton_ - mean_newton_) * tick_s / attention_s;
}

void SeekingOperator::enter(State state) noexcept {
    state_ = state;
    in_state_s_ = rested_s_ = 0;
}

bool SeekingOperator::has_rested() const noexcept { return rested_s_ > no_doubt_s; }

double SeekingOperator::choose_speed(double distance) noexcept {
    const bool is_apart = distance > settings_.guess_angstrom + apart_angstrom;
    const double threshold = settings_.threshold_newton;
    double speed = 0;
    switch (state_) {
        case State::Approach:
            speed = -settings_.approach_m_per_s;
            if (!is_apart && felt_newton_ > std::max(threshold, contact_newton))
                enter(State::Follow);
            return speed;
        case State::Follow:
            speed = follow_force();
            if (is_apart) {
                enter(State::Approach);
            } else if (has_rested()) {
                is_done_ = settings_.manner == OperatorManner::Naive;
                enter(State::FeelInward);
            }
            return speed;
        case State::FeelInward:
            if (mean_newton_ > threshold) {
                inner_m_ = intended_m_;
                enter(State::FeelOutward);
            } else if (is_apart) {
                enter(State::Approach);
            }
            return -feel_m_per_s;
        case State::FeelOutward:
            if (mean_newton_ < -threshold) {
                outer_m_ = intended_m_;
                enter(State::TakeMiddle);
            } else if (is_apart || in_state_s_ > longest_feel_s) {
                enter(State::Approach);
            }
            return feel_m_per_s;
        case State::TakeMiddle:
            break;
    }
    return take_middle();
}

// A staircase: the pace halves wherever the force turns round.
double SeekingOperator::follow_force() noexcept {
    const double beyond = std::abs(mean_newton_) - settings_.threshold_newton;
    if (beyond <= 0) {
        rested_s_ += tick_s;
        return 0;
    }
    rested_s_ = 0;
    const double side = std::copysign(1.0, mean_newton_);
    if (side == -side_) pace_m_per_s_ = std::max(0.5 * pace_m_per_s_, last_pace_m_per_s);
    side_ = side;
    return side * std::min(pace_m_per_s_, follow_m_per_N_s * beyond + slowest_m_per_s);
}

double SeekingOperator::follow_picture(double distance) noexcept {
    constexpr double per_s = 2;
    const double off = distance - settings_.guess_angstrom;
    rested_s_ = std::abs(off) < there_angstrom ? rested_s_ + tick_s : 0;
    is_done_ = has_rested();
    if (std::abs(off) < stop_angstrom) return 0;
    const double wanted = std::abs(off) * settings_.handle_m_per_angstrom * per_s + slowest_m_per_s;
    return -std::copysign(std::min(settings_.approach_m_per_s, wanted), off);
}

double SeekingOperator::take_middle() noexcept {
    constexpr double per_s = 3, fastest_m_per_s = 0.01, there_m = 0.0003;
    const double off = 0.5 * (inner_m_ + outer_m_) - intended_m_;
    if (std::abs(off) < there_m) rested_s_ += tick_s;
    is_done_ = has_rested();
    return std::clamp(per_s * off, -fastest_m_per_s, fastest_m_per_s);
}

}  // namespace palpa
