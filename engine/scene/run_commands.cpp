#include "scene/run_commands.h"

#include "scene/edit_fields.h"

#include <algorithm>

namespace palpa {
namespace {

constexpr std::size_t edit_count = edit_names.size();
constexpr std::array<std::string_view, 7> driving_names{"step", "run",  "hand_mm", "read",
                                                        "save", "help", "quit"};

constexpr auto names = [] {
    std::array<std::string_view, edit_count + driving_names.size()> all{};
    std::ranges::copy(driving_names, std::ranges::copy(edit_names, all.begin()).out);
    return all;
}();

std::size_t index_of(const RunAction& action) {
    if (const auto* const edit = std::get_if<EditAction>(&action)) return edit->index();
    return edit_count + action.index() - 1;
}

// The one with that place among the driving names.
void visit_driving(FieldVisitor& v, std::size_t index, RunAction& action) {
    switch (index) {
        case 0:
            return v.integer({.key = "step",
                              .meaning = "runs this many simulation steps, then answers",
                              .lowest = 1,
                              .highest = 1e9},
                             action.emplace<StepCommand>().steps);
        case 1:
            return v.real({.key = "run",
                           .meaning = "runs this many simulated seconds, in whole steps",
                           .lowest = 1e-3,
                           .highest = 1e5},
                          action.emplace<RunForCommand>().seconds);
        case 2:
            return v.triple({.key = "hand_mm",
                             .meaning = "new target of the emulated hand, mm",
                             .lowest = -1e3,
                             .highest = 1e3},
                            action.emplace<HandCommand>().place_mm);
        case 3:
            return v.text(
                {.key = "read",
                 .meaning = "answers with time, energy, marks, the forces of every hand and what "
                            "it holds; and with the positions of the named atoms"},
                action.emplace<ReadCommand>().atoms);
        case 4:
            return v.text(
                {.key = "save",
                 .meaning = "writes coordinates to a new file: .pdb, .cif, .gro, .crd, .psf",
                 .required = true},
                action.emplace<SaveCommand>().file);
        case 5:
            action = HelpCommand{};
            return v.mark({.key = "help", .meaning = "lists the commands"});
        default:
            action = QuitCommand{};
            return v.mark({.key = "quit", .meaning = "ends the run, as the end of the input does"});
    }
}

}  // namespace

void visit_run_command(FieldVisitor& v, RunCommand& command) {
    v.choice({.key = "hand", .meaning = "hand of the edit or target"}, edit_hand_names,
             command.hand);
    for (const std::size_t index : v.one_of(names, index_of(command.action))) {
        if (index >= edit_count) {
            visit_driving(v, index - edit_count, command.action);
        } else {
            visit_edit_action(v, index, command.action.emplace<EditAction>());
        }
    }
}

}  // namespace palpa
