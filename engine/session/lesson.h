// Follows a person through the steps of a scene's lesson.
#pragma once
#include "scene/description.h"
#include "session/reading.h"

#include <cstddef>
#include <vector>

namespace palpa {

// Steps are done in their order; one that is done stays done.
class Lesson {
public:
    explicit Lesson(std::vector<LessonStepDescription> steps) : steps_(std::move(steps)) {}

    // One servo tick, and the mode that the coupling is in.
    void update(const Reading& reading, CouplingMode mode) noexcept;

    const std::vector<LessonStepDescription>& steps() const noexcept { return steps_; }
    // The step to be done now; the number of steps where all are done.
    std::size_t current() const noexcept { return current_; }
    bool is_done() const noexcept { return current_ == steps_.size(); }
    // How much of the present step's time has passed, 0 to 1.
    double share() const noexcept;

    void skip() noexcept;
    void restart() noexcept;

private:
    std::vector<LessonStepDescription> steps_;
    std::size_t current_ = 0;
    double held_s_ = 0;
};

}  // namespace palpa
