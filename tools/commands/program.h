// The frame of both programs: arguments in, one command called, errors as exit codes.
#pragma once
#include "tools/commands/command.h"

#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct Program {
    std::string name;   // as it is typed
    std::string title;  // of its help
    std::string usage;  // lines below it; then the commands, in the order in which they are added
    std::string footer;
    void (*add_commands)(CLI::App& program, ProgramCommand& chosen) = nullptr;
    // The exit code of arguments that begin with no command; nothing where one is to be done.
    // Unset: without arguments the help is printed.
    std::optional<int> (*run_without_command)(const std::vector<std::string>& arguments) = nullptr;
};

// Reads the arguments, runs the command and turns errors into an exit code, which it returns.
int run_program(const Program& program, int argc, char** argv);

}  // namespace palpa
