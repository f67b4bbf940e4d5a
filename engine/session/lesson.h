// Follows a person through the steps of a lesson.
#pragma once
#include "scene/description.h"
#include "session/reading.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// Steps are done in their order. One that is done stays on screen until the person goes on, which
// is not before there was time to read it.
class Lesson {
public:
    explicit Lesson(std::vector<LessonStepDescription> steps) : steps_(std::move(steps)) {}

    // One servo tick, the mode that the coupling is in, and what the world says of each step
    // (session/lesson_meter.h).
    void update(const Reading& reading, CouplingMode mode,
                std::span<const double> measured = {}) noexcept;
    // Answers the present step's question, counted from 0: the right answer completes the step.
    void answer(std::size_t choice) noexcept;

    const std::vector<LessonStepDescription>& steps() const noexcept { return steps_; }
    // The present step; the number of steps if all are done.
    std::size_t current() const noexcept { return current_; }
    bool is_done() const noexcept { return current_ == steps_.size(); }
    // Whether the present step is done and may be left.
    bool is_step_done() const noexcept { return step_done_; }
    std::size_t steps_done() const noexcept { return current_ + (step_done_ ? 1 : 0); }
    bool can_go_on() const noexcept { return step_done_ && shown_s_ > shortest_s; }
    // Progress of the present step's time, 0 to 1.
    double share() const noexcept;
    // Value of the present step at the last tick; unset for a question, and while unknown.
    std::optional<double> value() const noexcept { return value_; }
    // Its first value since the step began; unset while unknown.
    std::optional<double> start() const noexcept { return start_; }
    // The last answer to the present step's question.
    std::optional<std::size_t> chosen() const noexcept { return chosen_; }

    // Goes to the next step if can_go_on(); returns whether it did.
    bool go_on() noexcept;
    void skip() noexcept;
    void restart() noexcept;

    static constexpr double shortest_s = 3;  // shortest time of a step on screen
    static constexpr double ripple_s = 2;    // time window of a ripple

private:
    void begin_step() noexcept;
    void note_ripple(double hand_N) noexcept;

    std::vector<LessonStepDescription> steps_;
    std::size_t current_ = 0;
    bool step_done_ = false;
    double held_s_ = 0, shown_s_ = 0;
    std::optional<double> value_, start_;
    std::optional<std::size_t> chosen_;
    std::vector<double> felt_N_;     // forces since the step began, at most twice ripple_s
    std::size_t ticks_of_zero_ = 0;  // the last ones
    std::optional<double> ripple_N_;
};

}  // namespace palpa
