// Commands of a scripted run (tools/scripting.md): edits as in [[edits]], and commands that drive
// the run.
#pragma once
#include "core/load_error.h"
#include "scene/description.h"
#include "scene/edits.h"
#include "scene/fields.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace palpa {

struct StepCommand {
    std::int64_t steps = 1;  // simulation steps
};
// Runs the steps that begin within this time.
struct RunForCommand {
    double seconds = 0;  // simulated s
};
// New target of the hand, mm from the centre of the workspace.
struct HandCommand {
    std::array<double, 3> place_mm{};
};
// Requests the present state; with `atoms` also the positions of these: an address or a selection.
struct ReadCommand {
    std::string atoms;
};
// The coordinates of all that is shown, in a format by the ending of the file, as `palpa export`
// writes them. It is not there yet.
struct SaveCommand {
    std::string file;
};
struct HelpCommand {};
struct QuitCommand {};

using RunAction = std::variant<EditAction, StepCommand, RunForCommand, HandCommand, ReadCommand,
                               SaveCommand, HelpCommand, QuitCommand>;

struct RunCommand {
    std::size_t hand = 0;  // hand, as in EditDescription
    RunAction action;
};

// Largest number of bytes of a line.
inline constexpr std::size_t most_command_bytes = std::size_t{64} << 10;

// The fields of a line.
void visit_run_command(FieldVisitor& visitor, RunCommand& command);

// These fields with their documentation.
std::vector<FieldNote> list_run_commands();

// A line as the keys of one TOML table, without braces: `take = "moved", hand = "second"`. A word
// without the sign = is short: `step 10` for `step = 10`, `undo` for `undo = true`, `read` for
// `read = ""`, `step` for `step = 1`. What follows # outside of quotes is a comment. Nothing where
// there is nothing else. Files that it names are taken from the scene's folder, as those of the
// scene. Throws LoadError at `place` for whatever [[edits]] of the scene would not take, and for a
// line that is too long.
std::optional<RunCommand> parse_run_command(std::string_view line, const SceneDescription& scene,
                                            const TextPlace& place);

}  // namespace palpa
