// The program: reads the command line, calls one command, turns errors into exit codes.
#include "core/interrupt.h"
#include "core/load_error.h"
#include "gpu/device.h"
#include "simulation/remote_engine.h"
#include "tools/commands/command.h"
#include "tools/commands/command_line.h"
#include "tools/commands/kernels.h"
#include "tools/commands/run.h"
#include "tools/commands/start.h"
#include "tools/commands/version.h"
#include "window/window.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace {

constexpr int bad_input = 2, own_fault = 3;

// In the order of the help.
void add_commands(CLI::App& program, palpa::ProgramCommand& chosen) {
    palpa::add_run(program, chosen);
    palpa::add_lessons(program, chosen);
    palpa::add_connect(program, chosen);
    palpa::add_devices(program, chosen);
    palpa::add_prepare(program, chosen);
    palpa::add_force_field(program, chosen);
    palpa::add_relax(program, chosen);
    palpa::add_scene(program, chosen);
    palpa::add_render(program, chosen);
    palpa::add_export(program, chosen);
    palpa::add_select(program, chosen);
    palpa::add_energy(program, chosen);
    palpa::add_licences(program, chosen);
    palpa::add_engine(program, chosen);
    palpa::add_bench(program, chosen);
    palpa::add_report(program, chosen);
    palpa::add_study(program, chosen);
    palpa::add_replay(program, chosen);
    palpa::add_scenarios(program, chosen);
    palpa::add_closed_paths(program, chosen);
    palpa::add_accuracy(program, chosen);
    palpa::add_unbind(program, chosen);
    palpa::add_compare_ligands(program, chosen);
}

// The exit code where there is nothing left to run.
std::optional<int> parse(CLI::App& program, const std::vector<std::string>& arguments) {
    try {
        program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
        return std::nullopt;
    } catch (const CLI::CallForVersion&) {
        fmt::print("{}", palpa::describe_version());
        return 0;
    } catch (const CLI::Success& success) {  // --help
        return program.exit(success);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "{}\n", palpa::explain(error, program, arguments[0]));
        return bad_input;
    }
}

int run_program(const std::vector<std::string>& arguments) {
    CLI::App program("Palpa: feel molecules", "palpa");
    program.formatter(palpa::build_help_formatter());
    program.set_help_flag("-h,--help", "print this");
    program.set_version_flag("--version", "");  // describe_version() has the words
    palpa::ProgramCommand chosen;
    add_commands(program, chosen);
    if (arguments.empty()) return palpa::start_command();
    if (palpa::is_file_to_open(arguments[0])) return palpa::open_command(arguments);
    if (const auto unknown = palpa::explain_command(program, arguments[0])) {
        fmt::print(stderr, "{}\n", *unknown);
        return bad_input;
    }
    const std::optional<int> code = parse(program, arguments);
    return code ? *code : chosen();
}

void print_further(const palpa::LoadError& error) {
    constexpr std::size_t most = 20;
    const std::vector<std::string>& problems = error.further();
    for (std::size_t i = 0; i < std::min(problems.size(), most); ++i)
        fmt::print(stderr, "{}\n", problems[i]);
    if (problems.size() > most) fmt::print(stderr, "and {} more\n", problems.size() - most);
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> arguments =
        palpa::move_structure_first(palpa::expand_help({argv + 1, argv + argc}));
    try {
        palpa::choose_kernels();
        const int code = run_program(arguments);
        if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
        fmt::print(stderr, "palpa: the output cannot be written\n");
        return bad_input;
    } catch (const std::filesystem::filesystem_error& error) {
        fmt::print(stderr, "palpa: {}\n", error.what());
        return bad_input;
    } catch (const std::system_error&) {  // what fmt throws when it cannot print
        fmt::print(stderr, "palpa: the output cannot be written\n");
        return bad_input;
    } catch (const palpa::PlatformError& error) {
        fmt::print(stderr, "palpa: {}\n", error.what());
        return bad_input;
    } catch (const palpa::GpuError& error) {
        fmt::print(stderr, "palpa: {}\n", error.what());
        return bad_input;
    } catch (const palpa::EngineLost& error) {
        fmt::print(stderr, "{}\n", palpa::cite_as_typed(error.what(), arguments));
        return palpa::engine_lost;
    } catch (const palpa::LoadError& error) {
        fmt::print(stderr, "{}\n", palpa::cite_as_typed(error.what(), arguments));
        print_further(error);
        return bad_input;
    } catch (const palpa::Interrupted&) {
        return palpa::exit_code_after(bad_input);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr,
                   "palpa: not enough memory; expected a smaller file, molecule or picture\n");
        return bad_input;
    } catch (const std::exception& error) {
        fmt::print(stderr, "palpa: internal error: {}\n", error.what());
        return own_fault;
    }
}
