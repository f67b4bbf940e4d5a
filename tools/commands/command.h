// What the commands of the program have in common: how each comes into it, and options of several.
#pragma once
#include "scene/description.h"
#include "tools/commands/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace palpa {

// Does what the command line asked for, and returns the exit code.
using ProgramCommand = std::function<int()>;

// Each adds a command to the program. Where the command line asks for it, `chosen` is what does it;
// it must live as long as the program.
void add_run(CLI::App& program, ProgramCommand& chosen);
void add_lessons(CLI::App& program, ProgramCommand& chosen);
void add_connect(CLI::App& program, ProgramCommand& chosen);
void add_devices(CLI::App& program, ProgramCommand& chosen);
void add_prepare(CLI::App& program, ProgramCommand& chosen);
void add_relax(CLI::App& program, ProgramCommand& chosen);
void add_render(CLI::App& program, ProgramCommand& chosen);
void add_export(CLI::App& program, ProgramCommand& chosen);
void add_select(CLI::App& program, ProgramCommand& chosen);
void add_energy(CLI::App& program, ProgramCommand& chosen);
void add_licences(CLI::App& program, ProgramCommand& chosen);
void add_engine(CLI::App& program, ProgramCommand& chosen);
void add_study(CLI::App& program, ProgramCommand& chosen);
void add_replay(CLI::App& program, ProgramCommand& chosen);

// What the options of a command are read into; `function` gets it once the command was asked for.
template <class Options, class Function>
Options& own_options(CLI::App& command, ProgramCommand& chosen, Function function) {
    const auto options = std::make_shared<Options>();
    command.final_callback([options, &chosen, function] {
        chosen = [options, function] { return function(*options); };
    });
    return *options;
}

// Throws LoadError where a remote engine moves the scene's atoms.
void refuse_remote_engine(const SceneDescription& scene);

// What a user should know of files that were read, on stderr.
void print_notes(const std::vector<std::string>& notes);

// Says of a file or folder whose name is a PDB code that no entry is downloaded.
void note_file_before_code(const std::string& file);

// --set, and what lets a scene name files outside of its folder.
void add_set_option(CLI::App& command, std::vector<std::string>& settings);

// A flag that switches something off.
void add_negation(CLI::App& command, const std::string& flag, bool& value, const std::string& help);

// A number between two, which a NaN is not.
CLI::Validator in_range(double lowest, double highest);

// A whole number as the key run.seed takes it.
void add_seed_option(CLI::App& command, std::uint64_t& seed);

// WIDTHxHEIGHT.
void add_size_option(CLI::App& command, const std::string& option, std::uint32_t& width,
                     std::uint32_t& height);

// Of every command that writes files.
void add_overwrite_flag(CLI::App& command, bool& overwrites);

// Of commands that know no force field without it.
void add_toppar_option(CLI::App& command, std::vector<std::filesystem::path>& toppar);

}  // namespace palpa
