#include "tools/commands/program.h"

#include "core/interrupt.h"
#include "core/load_error.h"
#include "gpu/device.h"
#include "simulation/remote_engine.h"
#include "tools/commands/command_line.h"
#include "tools/commands/kernels.h"
#include "tools/commands/run.h"
#include "tools/commands/version.h"
#include "window/window.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

namespace palpa {
namespace {

constexpr int bad_input = 2, own_fault = 3;

// The exit code where there is nothing left to run.
std::optional<int> parse(CLI::App& program, const std::vector<std::string>& arguments) {
    try {
        program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
        return std::nullopt;
    } catch (const CLI::CallForVersion&) {
        fmt::print("{}", describe_version());
        return 0;
    } catch (const CLI::Success& success) {  // --help
        return program.exit(success);
    } catch (const CLI::ParseError& error) {
        fmt::print(stderr, "{}\n", explain(error, program, arguments[0]));
        return bad_input;
    }
}

int run_command_line(const Program& program, const std::vector<std::string>& typed) {
    CLI::App parser(program.title, program.name);
    parser.formatter(build_help_formatter(program.usage));
    parser.footer(program.footer);
    parser.set_help_flag("-h,--help", "print this");
    parser.set_version_flag("--version", "");  // describe_version() has the words
    ProgramCommand chosen;
    program.add_commands(parser, chosen);
    // Hides them from the help. CLI11 hands hidden flags to no command, so this comes last.
    for (CLI::Option* const option : parser.get_options()) option->group("");
    std::vector<std::string> arguments = move_structure_first(expand_help(parser, typed));
    if (program.run_without_command) {
        if (const auto code = program.run_without_command(arguments)) return *code;
    } else if (arguments.empty()) {
        arguments.emplace_back("--help");
    }
    if (const auto unknown = explain_command(parser, arguments[arguments[0] == "help" ? 1 : 0])) {
        fmt::print(stderr, "{}\n", *unknown);
        return bad_input;
    }
    const std::optional<int> code = parse(parser, arguments);
    return code ? *code : chosen();
}

void print_further(const LoadError& error) {
    constexpr std::size_t most = 20;
    const std::vector<std::string>& problems = error.further();
    for (std::size_t i = 0; i < std::min(problems.size(), most); ++i)
        fmt::print(stderr, "{}\n", problems[i]);
    if (problems.size() > most) fmt::print(stderr, "and {} more\n", problems.size() - most);
}

}  // namespace

int run_program(const Program& program, int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const auto refuse = [&](const std::string& what) {
        fmt::print(stderr, "{}: {}\n", program.name, what);
        return bad_input;
    };
    try {
        choose_kernels();
        const int code = run_command_line(program, arguments);
        if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
        return refuse("the output cannot be written");
    } catch (const std::filesystem::filesystem_error& error) {
        return refuse(error.what());
    } catch (const std::system_error&) {  // what fmt throws when it cannot print
        return refuse("the output cannot be written");
    } catch (const PlatformError& error) {
        return refuse(error.what());
    } catch (const GpuError& error) {
        return refuse(error.what());
    } catch (const EngineLost& error) {
        fmt::print(stderr, "{}\n", cite_as_typed(error.what(), arguments));
        return engine_lost;
    } catch (const LoadError& error) {
        fmt::print(stderr, "{}\n", cite_as_typed(error.what(), arguments));
        print_further(error);
        return bad_input;
    } catch (const Interrupted&) {
        return exit_code_after(bad_input);
    } catch (const std::bad_alloc&) {
        return refuse("not enough memory; expected a smaller file, molecule or picture");
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: internal error: {}\n", program.name, error.what());
        return own_fault;
    }
}

}  // namespace palpa
