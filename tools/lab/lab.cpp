// The laboratory: what measures Palpa, beside the program that people use.
#include "tools/commands/program.h"
#include "tools/lab/commands/commands.h"

#include <fmt/format.h>

namespace {

void add_commands(CLI::App& program, palpa::ProgramCommand& chosen) {
    palpa::add_bench(program, chosen);
    palpa::add_report(program, chosen);
    palpa::add_operator_study(program, chosen);
    palpa::add_accuracy(program, chosen);
    palpa::add_unbind(program, chosen);
    palpa::add_scenarios(program, chosen);
    palpa::add_closed_paths(program, chosen);
    palpa::add_compare_ligands(program, chosen);
    palpa::add_force_field(program, chosen);
}

}  // namespace

int main(int argc, char** argv) {
    return palpa::run_program(
        {.name = "palpa-lab",
         .title = "Palpa's laboratory: speed, errors and stability, measured on this machine",
         .usage = "  palpa-lab COMMAND ...   does one of these:\n",
         .footer = "palpa-lab help COMMAND explains it with examples. Exit codes are palpa's; 1: a "
                   "limit is missed.",
         .add_commands = add_commands},
        argc, argv);
}
