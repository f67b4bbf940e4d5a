// A run controlled by lines of text (scene/run_commands.h); each line is answered by one line of
// JSON.
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

// The input and output of a scripted run.
struct ScriptEnds {
    // The next line without its line end; nothing at the end of the input. A line that is too long
    // is cut after enough characters to detect that.
    std::function<std::optional<std::string>()> next_line;
    // Gets each answer: one line without its line end.
    std::function<void(const std::string& answer)> answer;
    // Sets the target of the handle (m, from the centre of the workspace). Throws LoadError if this
    // hand cannot be moved so.
    std::function<void(std::size_t hand, const Vec3& place_m)> lead;
    // Whether `save` may replace coordinates that Palpa wrote.
    bool overwrites = false;
};

// Answers are {"ok":true, ...} or {"ok":false,"error":"...","line":N}; a refused line changes
// nothing. Simulated time passes only in `step` and `run`, so the same lines give the same answers.
// The run starts in the middle of its first tick: the servo has run, and the step that belongs to
// it waits for the first line.
class ScriptedRun {
public:
    // `scene` must outlive this object.
    ScriptedRun(const SceneDescription& scene, ScriptEnds ends);

    // Called by run_headless: reads lines until one lets time pass, or the input ends.
    void before_step(World& world, const EditFunction& edit);
    void add(std::span<const ServoTick> ticks);
    bool is_over() const noexcept { return is_over_; }

    // True if a line was refused.
    bool has_refused() const noexcept { return has_refused_; }

private:
    // True if the next step has to be made before more lines are read.
    bool take_line(const std::string& line, World& world, const EditFunction& edit);
    bool apply(const RunCommand& command, World& world, const EditFunction& edit);
    void pass(std::uint64_t steps) noexcept;
    void answer_ok(const World& world);
    void answer_reading(const World& world, const std::string& atoms);
    void save(const World& world, const std::string& file) const;

    const SceneDescription& scene_;
    ScriptEnds ends_;
    TextPlace place_{"commands"};
    std::vector<ServoTick> ticks_;  // last tick of every hand
    std::uint64_t left_ = 0;        // steps to make before the next line
    bool is_passing_ = false;       // the answer is given after these steps
    bool is_over_ = false, has_refused_ = false;
};

}  // namespace palpa
