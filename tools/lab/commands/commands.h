// The commands of palpa-lab.
#pragma once
#include "tools/commands/command.h"

namespace palpa {

void add_bench(CLI::App& program, ProgramCommand& chosen);
void add_report(CLI::App& program, ProgramCommand& chosen);
void add_operator_study(CLI::App& program, ProgramCommand& chosen);
void add_accuracy(CLI::App& program, ProgramCommand& chosen);
void add_unbind(CLI::App& program, ProgramCommand& chosen);
void add_scenarios(CLI::App& program, ProgramCommand& chosen);
void add_closed_paths(CLI::App& program, ProgramCommand& chosen);
void add_compare_ligands(CLI::App& program, ProgramCommand& chosen);
void add_force_field(CLI::App& program, ProgramCommand& chosen);

}  // namespace palpa
