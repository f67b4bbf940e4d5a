// Plays a scene's lesson by an emulated operator, or by hands that ignore it.
#pragma once
#include "scene/description.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace palpa {

// Operator: does what the steps require (scene/description.h). Idle: a hand that holds still.
// Random: a hand that moves smoothly between random places of the workspace. Idle and Random change
// nothing and answer nothing.
enum class LessonPlayer { Operator, Idle, Random };

struct LessonStepResult {
    bool was_reached = false;  // the previous steps are done
    bool is_done = false;
    double at_s = 0;              // time when it was done, or of the end, s
    std::optional<double> value;  // value then, or the nearest to the required one
};

struct LessonResult {
    std::vector<LessonStepResult> steps;
    double seconds = 0;  // simulated s
    bool is_done() const noexcept;
};

// Simulated seconds that any of them has: the operator's paths and a quarter more, the times that
// steps ask for, and 4 s for each step.
double lesson_seconds(const SceneDescription& scene) noexcept;

// In lockstep, so the same call gives the same result. Throws LoadError.
// `progress`: share of the steps that are done.
LessonResult play_lesson(SceneDescription scene, LessonPlayer player, std::uint64_t seed = 1,
                         const std::function<void(double share)>& progress = {});

}  // namespace palpa
