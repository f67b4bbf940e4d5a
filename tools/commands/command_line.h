// How the command line explains itself, over CLI11: help, and what is wrong with what was typed.
#pragma once
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// Examples of a command, and what else its help ends with.
void describe(CLI::App& command, const std::vector<std::string>& examples,
              const std::string& note = "");

// Help as CLI11 prints it. `usage`: lines above the list of the program's commands.
std::shared_ptr<CLI::FormatterBase> build_help_formatter(const std::string& usage);

// An option that is short for a scene key: "--mode 2" is "--set coupling.mode=2".
void add_setting(CLI::App& command, const std::string& option, const std::string& help,
                 std::vector<std::string>& settings);

// A message about such a setting, citing the option where that is what was typed.
std::string cite_as_typed(const std::string& message, const std::vector<std::string>& arguments);

// One line about what is no command, with the nearest name; nothing where it is one, or an option.
std::optional<std::string> explain_command(const CLI::App& program, const std::string& command);

// One line about arguments that a command cannot take, with the nearest name.
std::string explain(const CLI::ParseError& error, const CLI::App& program,
                    const std::string& command);

// "palpa help run" as "palpa run --help"; help of what is no command stays as it is.
std::vector<std::string> expand_help(const CLI::App& program, std::vector<std::string> arguments);

// "palpa prepare --toppar A B x.pdb" as "palpa prepare x.pdb --toppar A B": an option that takes
// several files would take the structure too.
std::vector<std::string> move_structure_first(std::vector<std::string> arguments);

}  // namespace palpa
