// A scene's lesson, done by an emulated operator, or by hands that know nothing of it.
#pragma once
#include "scene/description.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace palpa {

// The operator does what the steps say (scene/description.h). Idle: a hand that holds still.
// Random: one that goes smoothly from place to place of the workspace, drawn by a seed. These two
// change nothing and answer nothing.
enum class LessonPlayer { Operator, Idle, Random };

struct LessonStepResult {
    bool was_reached = false;  // the steps before it are done
    bool is_done = false;
    double at_s = 0;              // when it was done, or the end
    std::optional<double> value;  // when it was done, or the nearest to what is wanted
};

struct LessonResult {
    std::vector<LessonStepResult> steps;
    double seconds = 0;  // simulated
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
