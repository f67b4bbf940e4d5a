// The program: which commands it has, and what it does without one.
#include "tools/commands/program.h"
#include "tools/commands/scene_keys.h"
#include "tools/commands/start.h"
#include "tools/commands/window_actions.h"

namespace {

// In the order of the help.
void add_commands(CLI::App& program, palpa::ProgramCommand& chosen) {
    palpa::add_run(program, chosen);
    palpa::add_lessons(program, chosen);
    palpa::add_devices(program, chosen);
    palpa::add_prepare(program, chosen);
    palpa::add_relax(program, chosen);
    palpa::add_render(program, chosen);
    palpa::add_export(program, chosen);
    palpa::add_select(program, chosen);
    palpa::add_energy(program, chosen);
    palpa::add_replay(program, chosen);
    palpa::add_connect(program, chosen);
    palpa::add_engine(program, chosen);
    palpa::add_study(program, chosen);
    palpa::add_licences(program, chosen);
}

std::optional<int> run_without_command(const std::vector<std::string>& arguments) {
    if (arguments.empty()) return palpa::start_command();
    if (palpa::is_file_to_open(arguments[0])) return palpa::open_command(arguments);
    if (arguments[0] == "help") {  // of a command it is --help by now
        if (arguments.size() == 2 && arguments[1] == "actions") {
            palpa::print_actions();
            return 0;
        }
        if (palpa::print_scene_keys({arguments.begin() + 1, arguments.end()})) return 0;
    }
    return std::nullopt;
}

constexpr const char* usage =
    "  palpa               opens a window with all scenes; without a display, lists them\n"
    "  palpa FILE, CODE    opens a scene, or prepares a structure (.pdb, .cif) or a PDB entry "
    "(1hsg)\n"
    "  palpa COMMAND ...   does one of these:\n";

constexpr const char* footer =
    "palpa help COMMAND explains it with examples; palpa help KEY explains a key of scene files,\n"
    "palpa help keys all of them, palpa help actions what can be done in a window. palpa-lab, "
    "which tools/build makes, measures speed, errors and\n"
    "stability. Exit codes: 0 done, 1 a check failed or a command was refused, 2 wrong input or\n"
    "something is missing, 3 internal error, 4 no answer from an engine, 128+N ended by signal N.";

}  // namespace

int main(int argc, char** argv) {
    return palpa::run_program({.name = "palpa",
                               .title = "Palpa: feel molecules",
                               .usage = usage,
                               .footer = footer,
                               .add_commands = add_commands,
                               .run_without_command = run_without_command},
                              argc, argv);
}
