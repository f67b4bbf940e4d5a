// Plays a scene's lesson by an emulated operator, or by hands that ignore it.
#pragma once
#include "scene/description.h"
#include "session/statistics.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace palpa {

// Operator: does what the steps require (scene/description.h). Idle: a hand that holds still.
// Random: a hand that moves smoothly between random places of the workspace. Idle and Random change
// nothing and answer nothing.
enum class LessonPlayer { Operator, Idle, Random };

// The device that the operator works: an emulated Omni; the same with a workspace of 5 cm, in which
// it must clutch more often; or a mouse, worked by a MousePerson.
enum class LessonDevice { Omni, Small, Mouse };
inline constexpr std::array<std::string_view, 3> lesson_device_names{"omni", "small", "mouse"};

struct LessonStepResult {
    bool was_reached = false;  // the previous steps are done
    bool is_done = false;
    double at_s = 0;              // time when it was done, or of the end, s
    std::optional<double> value;  // value then, or the nearest to the required one
};

struct LessonResult {
    std::vector<LessonStepResult> steps;
    double seconds = 0;  // simulated s
    HandTravel travel;
    bool is_done() const noexcept;
};

// Simulated seconds that any of them has: the operator's paths and a quarter more, the times that
// steps ask for, and 4 s for each step.
double lesson_seconds(const SceneDescription& scene) noexcept;

// In lockstep, so the same call gives the same result. Throws LoadError.
// `progress`: share of the steps that are done.
LessonResult play_lesson(SceneDescription scene, LessonPlayer player,
                         LessonDevice device = LessonDevice::Omni, std::uint64_t seed = 1,
                         const std::function<void(double share)>& progress = {});

}  // namespace palpa
