// Any line is a command, nothing or a LoadError at its place; blanks around it and a comment behind
// it change nothing of that.
#include "core/load_error.h"
#include "scene/read_scene.h"
#include "scene/run_commands.h"
#include "scene/write_scene.h"
#include "tests/fuzz/expect.h"
#include "tests/support/paths.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

using namespace palpa;

namespace {

SceneDescription two_handed() {
    return read_scene(test::in_project("scenes/water/two-hands.toml"));
}

struct Read {
    std::string text;  // empty: nothing but blanks and comments
};

std::string text_of(const RunCommand& command) {
    const auto visit = [&](const auto& action) -> std::string {
        using Action = std::decay_t<decltype(action)>;
        if constexpr (std::is_same_v<Action, EditAction>) {
            return format_edit({0, command.hand, action, {"commands", 3}});
        } else if constexpr (std::is_same_v<Action, StepCommand>) {
            PALPA_EXPECT(action.steps >= 1);
            return "step " + std::to_string(action.steps);
        } else if constexpr (std::is_same_v<Action, RunForCommand>) {
            PALPA_EXPECT(action.seconds >= 1e-3 && action.seconds <= 1e5);
            return "run " + std::to_string(action.seconds);
        } else if constexpr (std::is_same_v<Action, HandCommand>) {
            std::string text = "hand";
            for (const double mm : action.place_mm) {
                PALPA_EXPECT(std::abs(mm) <= 1e3);
                text += " " + std::to_string(mm);
            }
            return text;
        } else if constexpr (std::is_same_v<Action, ReadCommand>) {
            return "read " + action.atoms;
        } else if constexpr (std::is_same_v<Action, SaveCommand>) {
            PALPA_EXPECT(!action.file.empty());
            return "save " + action.file;
        } else {
            return std::is_same_v<Action, HelpCommand> ? "help" : "quit";
        }
    };
    PALPA_EXPECT(command.hand < edit_hand_names.size());
    return std::to_string(command.hand) + std::visit(visit, command.action);
}

std::optional<Read> read(std::string_view line) {
    static const SceneDescription scene = two_handed();
    try {
        const std::optional<RunCommand> command = parse_run_command(line, scene, {"commands", 3});
        return Read{command ? text_of(*command) : ""};
    } catch (const LoadError& error) {
        PALPA_EXPECT(std::string_view(error.what()).starts_with("commands:3: "));
        return std::nullopt;
    }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string line(reinterpret_cast<const char*>(data), size);
    const std::optional<Read> whole = read(line);
    if (!whole) return 0;
    const std::optional<Read> framed = read(" \t" + line + "\r");
    const std::optional<Read> commented = read(line + " # \"'[{");
    PALPA_EXPECT(framed && framed->text == whole->text);
    PALPA_EXPECT(commented && commented->text == whole->text);
    return 0;
}
