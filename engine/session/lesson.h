// Follows a person through the steps of a scene's lesson.
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
    // To the present step's question, counted from 0: the right answer does the step.
    void answer(std::size_t choice) noexcept;

    const std::vector<LessonStepDescription>& steps() const noexcept { return steps_; }
    // The step to be done now; the number of steps where all are done.
    std::size_t current() const noexcept { return current_; }
    bool is_done() const noexcept { return current_ == steps_.size(); }
    // The present step was done, and may be left.
    bool is_step_done() const noexcept { return step_done_; }
    std::size_t steps_done() const noexcept { return current_ + (step_done_ ? 1 : 0); }
    bool can_go_on() const noexcept { return step_done_ && shown_s_ > shortest_s; }
    // How much of the present step's time has passed, 0 to 1.
    double share() const noexcept;
    // Of the present step at the last tick; nothing of a question, and while it is not known.
    std::optional<double> value() const noexcept { return value_; }
    // The answer given last to the present step's question.
    std::optional<std::size_t> chosen() const noexcept { return chosen_; }

    // To the next step, where can_go_on(); returns whether it did.
    bool go_on() noexcept;
    void skip() noexcept;
    void restart() noexcept;

    static constexpr double shortest_s = 3;  // that a step is on screen
    static constexpr double ripple_s = 2;    // that a ripple is of

private:
    void begin_step() noexcept;
    void note_ripple(double hand_N) noexcept;

    std::vector<LessonStepDescription> steps_;
    std::size_t current_ = 0;
    bool step_done_ = false;
    double held_s_ = 0, shown_s_ = 0;
    std::optional<double> value_;
    std::optional<std::size_t> chosen_;
    std::vector<double> felt_N_;  // since the step began, at most twice ripple_s
    std::optional<double> ripple_N_;
};

}  // namespace palpa
