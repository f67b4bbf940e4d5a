#include "session/lesson.h"

#include "session/ripple.h"

#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

constexpr auto ripple_ticks = static_cast<std::size_t>(Lesson::ripple_s * servo_rate_hz);
constexpr std::size_t ticks_between_ripples = 250;

}  // namespace

void Lesson::note_ripple(double hand_N) noexcept {
    constexpr std::size_t let_go_ticks = 50;  // without any force
    ticks_of_zero_ = hand_N == 0 ? ticks_of_zero_ + 1 : 0;
    if (ticks_of_zero_ >= let_go_ticks) {
        felt_N_.clear();
        ripple_N_.reset();
        return;
    }
    if (felt_N_.size() >= 2 * ripple_ticks)
        felt_N_.erase(felt_N_.begin(), felt_N_.end() - static_cast<std::ptrdiff_t>(ripple_ticks));
    felt_N_.push_back(hand_N);
    if (felt_N_.size() < ripple_ticks || felt_N_.size() % ticks_between_ripples != 0) return;
    const auto ripple =
        measure_ripple(std::span<const double>(felt_N_).last(ripple_ticks), servo_tick_s);
    if (ripple) ripple_N_ = ripple->rms;
}

void Lesson::update(const Reading& reading, CouplingMode mode,
                    std::span<const double> measured) noexcept {
    if (is_done()) return;
    shown_s_ += servo_tick_s;
    const LessonStepDescription& step = steps_[current_];
    if (step.question) return;
    switch (step.quantity) {
        case LessonQuantity::Distance:
            value_ = reading.distance_angstrom;
            break;
        case LessonQuantity::Force:
            value_ = reading.molecular_nN;
            break;
        case LessonQuantity::FeltForce:
            value_ = reading.hand_N;
            break;
        case LessonQuantity::Mode:
            value_ = static_cast<double>(mode) + 1;  // modes are counted from 1
            break;
        case LessonQuantity::Energy:
            value_ = reading.potential_kcal_per_mol;
            break;
        case LessonQuantity::Ripple:
            note_ripple(reading.hand_N);
            value_ = ripple_N_;
            break;
        default:
            value_.reset();
            if (current_ < measured.size() && std::isfinite(measured[current_]))
                value_ = measured[current_];
    }
    if (!start_) start_ = value_;
    if (step_done_) return;
    const bool holds = value_ && (!step.at_least || *value_ >= *step.at_least) &&
                       (!step.at_most || *value_ <= *step.at_most);
    held_s_ = holds ? held_s_ + servo_tick_s : 0;
    // Half a tick keeps the count from hanging on rounding.
    step_done_ = holds && held_s_ > step.for_s - 0.5 * servo_tick_s;
}

void Lesson::answer(std::size_t choice) noexcept {
    if (is_done() || !steps_[current_].question || step_done_) return;
    chosen_ = choice;
    step_done_ = choice + 1 == static_cast<std::size_t>(steps_[current_].question->right);
}

double Lesson::share() const noexcept {
    if (is_done()) return 0;
    if (step_done_) return 1;
    if (steps_[current_].for_s <= 0) return 0;
    return std::min(held_s_ / steps_[current_].for_s, 1.0);
}

bool Lesson::go_on() noexcept {
    if (!can_go_on()) return false;
    skip();
    return true;
}

void Lesson::begin_step() noexcept {
    step_done_ = false;
    held_s_ = shown_s_ = 0;
    value_.reset();
    start_.reset();
    chosen_.reset();
    felt_N_.clear();
    ripple_N_.reset();
}

void Lesson::skip() noexcept {
    if (is_done()) return;
    ++current_;
    begin_step();
}

void Lesson::restart() noexcept {
    current_ = 0;
    begin_step();
}

}  // namespace palpa
