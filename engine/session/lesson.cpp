#include "session/lesson.h"

#include <algorithm>

namespace palpa {
namespace {

double value_of(LessonQuantity quantity, const Reading& reading, CouplingMode mode) noexcept {
    switch (quantity) {
        case LessonQuantity::Distance:
            return reading.distance_angstrom;
        case LessonQuantity::Force:
            return reading.molecular_nN;
        case LessonQuantity::FeltForce:
            return reading.hand_N;
        case LessonQuantity::Mode:
            break;
    }
    return static_cast<double>(mode) + 1;  // modes are counted from 1
}

}  // namespace

void Lesson::update(const Reading& reading, CouplingMode mode) noexcept {
    if (is_done()) return;
    shown_s_ += servo_tick_s;
    if (step_done_) return;
    const LessonStepDescription& step = steps_[current_];
    const double value = value_of(step.quantity, reading, mode);
    const bool holds =
        (!step.at_least || value >= *step.at_least) && (!step.at_most || value <= *step.at_most);
    held_s_ = holds ? held_s_ + servo_tick_s : 0;
    // Half a tick keeps the count from hanging on rounding.
    step_done_ = holds && held_s_ > step.for_s - 0.5 * servo_tick_s;
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

void Lesson::skip() noexcept {
    if (is_done()) return;
    ++current_;
    step_done_ = false;
    held_s_ = shown_s_ = 0;
}

void Lesson::restart() noexcept {
    current_ = 0;
    step_done_ = false;
    held_s_ = shown_s_ = 0;
}

}  // namespace palpa
