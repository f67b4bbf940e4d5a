// A run that lines of text drive (scene/run_commands.h), each answered by one line of JSON.
#pragma once
#include "core/load_error.h"
#include "ecs/world.h"
#include "haptics/servo.h"
#include "math/vec.h"
#include "scene/description.h"
#include "scene/run_commands.h"
#include "session/run_headless.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

// What a scripted run talks to.
struct ScriptEnds {
    // The next line without its end, of one that is too long enough to see that; nothing at the end
    // of the input.
    std::function<std::optional<std::string>()> next_line;
    // Gets each answer, one line without its end.
    std::function<void(const std::string& answer)> answer;
    // From now on the hand wants its handle there (m, from the centre of the workspace). Throws
    // LoadError where this one cannot be led.
    std::function<void(std::size_t hand, const Vec3& place_m)> lead;
};

// Answers are {"ok":true, ...} or {"ok":false,"error":"...","line":N}; a line that is refused
// changes nothing. Simulated time passes in `step` and `run` alone, so the same lines give the same
// answers. The run begins in the middle of its first tick: the servo has done it, the step that
// begins with it waits for the first line.
class ScriptedRun {
public:
    // `scene` outlives it.
    ScriptedRun(const SceneDescription& scene, ScriptEnds ends);

    // Of run_headless: takes lines until one lets time pass, or the input ends.
    void before_step(World& world, const EditFunction& edit);
    void add(std::span<const ServoTick> ticks);
    bool is_over() const noexcept { return is_over_; }

    // Whether a line was refused.
    bool has_refused() const noexcept { return has_refused_; }

private:
    // Whether the next step is to be made before more lines are taken.
    bool take_line(const std::string& line, World& world, const EditFunction& edit);
    bool obey(const RunCommand& command, World& world, const EditFunction& edit);
    void pass(std::uint64_t steps) noexcept;
    void answer_ok(const World& world);
    void answer_reading(const World& world, const std::string& atoms);
    void save(const World& world, const std::string& file) const;

    const SceneDescription& scene_;
    ScriptEnds ends_;
    TextPlace place_{"commands"};
    std::vector<ServoTick> ticks_;  // the last of all hands
    std::uint64_t left_ = 0;        // steps that pass before the next line
    bool is_passing_ = false;       // the answer is due when they have
    bool is_over_ = false, has_refused_ = false;
};

}  // namespace palpa
