#include "tools/commands/command_line.h"

#include "core/load_error.h"
#include "core/text.h"
#include "scene/find_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>

namespace palpa {
namespace {

constexpr std::size_t page_width = 100, name_width = 26;
constexpr std::string_view example_indent = "  palpa ";

struct SettingOption {
    std::string_view option, key, value;
};
constexpr std::array setting_options = std::to_array<SettingOption>({
    {"--mode", "coupling.mode", "MODE"},
    {"--period-ms", "run.period_ms", "N"},
    {"--engage", "coupling.engage", "WAY"},
    {"--hand", "hand.grip", "GRIP"},
    {"--friction", "device.friction_N", "N"},
    {"--seconds", "run.seconds", "N"},
    {"--seed", "run.seed", "N"},
    {"--every", "run.every", "N"},
});

// What commands were called before.
struct RenamedCommand {
    std::string_view before, now;
};
constexpr std::array renamed_commands = std::to_array<RenamedCommand>(
    {{"feel", "accuracy"}, {"loops", "closed-paths"}, {"journey", "unbind"}});

constexpr const char* exit_codes =
    "Exit codes\n  0      done\n  1      a check failed (report, replay --verify, devices, ...), "
    "no film could be made\n         (render --film), or a command was refused (run --commands)\n  "
    "2      wrong arguments or input, or something is missing; nothing was changed\n  3      an "
    "internal error of Palpa\n  4      no remote engine answered, or its connection was lost "
    "(connect, run)\n  128+N  ended by signal N; a recording is complete up to that moment\n";

// Words of `text` in lines from `column` on; the first line continues one of `used` letters.
std::string wrap(std::string_view text, std::size_t used, std::size_t column) {
    std::string page;
    std::size_t at = used;
    const auto begin_line = [&] {
        page += '\n';
        page.append(column, ' ');
        at = column;
    };
    if (at + 1 < column) {
        page.append(column - at, ' ');
        at = column;
    } else {
        begin_line();
    }
    for (const std::string_view word : split_words(text)) {
        if (at > column && at + 1 + word.size() > page_width) begin_line();
        if (at > column) {
            page += ' ';
            ++at;
        }
        page += word;
        at += word.size();
    }
    return page + "\n";
}

std::string entry(const std::string& name, const std::string& text) {
    const std::string start = "  " + name;
    return start + wrap(text, start.size(), name_width);
}

// The library's names of types, as people write them; ranges are said with the description.
std::string value_name(const CLI::Option& option) {
    if (option.get_type_size() == 0) return {};
    const std::string type = option.get_type_name();
    const std::string base = type.substr(0, type.find(':'));
    const bool is_number = base == "FLOAT" || base == "INT" || base == "UINT";
    const std::string name = is_number ? "N" : base == "TEXT" ? "NAME" : base;
    return option.get_expected_max() > 1 ? name + " ..." : name;
}

std::string describe_option(const CLI::Option& option) {
    std::vector<std::string> notes;
    const std::string type = option.get_type_name();
    // The library's own lists of what is allowed are said in the description.
    const std::size_t colon = type.find(':');
    if (colon != std::string::npos && type[colon + 1] != '{') {
        notes.push_back(type.substr(colon + 1));
    }
    for (const CLI::Option* const other : option.get_needs()) {
        if (!other->get_positional()) notes.push_back("with " + other->get_name());
    }
    if (option.get_required() && !option.get_positional()) notes.emplace_back("required");
    const std::string& text = option.get_description();
    return notes.empty() ? text : fmt::format("{} ({})", text, fmt::join(notes, "; "));
}

std::string upper_name(const CLI::Option& positional) {
    const std::string name = upper_case(positional.get_name(true, false));
    return positional.get_expected_max() > 1 ? name + " ..." : name;
}

std::string option_names(const CLI::Option& option) {
    std::string names;
    for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
    for (const std::string& name : option.get_lnames()) names += "--" + name + ", ";
    if (names.size() > 2) names.resize(names.size() - 2);
    const std::string value = value_name(option);
    return value.empty() ? names : names + " " + value;
}

class HelpFormatter : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override {
        (void)name, (void)mode;
        return app->get_parent() ? help_of_command(*app) : help_of_program(*app);
    }

private:
    static std::string help_of_command(const CLI::App& command) {
        const std::vector<const CLI::Option*> positionals =
            command.get_options([](const CLI::Option* option) { return option->get_positional(); });
        std::string page = "palpa " + command.get_name();
        for (const CLI::Option* const positional : positionals) {
            const std::string name = upper_name(*positional);
            page += positional->get_required() ? " " + name : " [" + name + "]";
        }
        page += " [OPTION ...]\n\n" + command.get_description() + "\n";
        if (!positionals.empty()) page += "\n";
        for (const CLI::Option* const positional : positionals) {
            page += entry(upper_name(*positional), describe_option(*positional));
        }
        for (const std::string& group : command.get_groups()) {
            const auto options = command.get_options([&](const CLI::Option* option) {
                return option->get_group() == group && option->nonpositional();
            });
            if (group.empty() || options.empty()) continue;
            page += "\n" + group + "\n";
            for (const CLI::Option* const option : options) {
                page += entry(option_names(*option), describe_option(*option));
            }
        }
        if (!command.get_footer().empty()) page += "\n" + command.get_footer();
        return page;
    }

    static std::string help_of_program(const CLI::App& program) {
        std::string page =
            "Palpa: feel molecules\n\n"
            "  palpa                   opens a window with all scenes; without a display, lists "
            "them\n"
            "  palpa FILE              opens a scene, or prepares and opens a structure (.pdb, "
            ".cif)\n"
            "  palpa COMMAND [ARGUMENT ...]\n"
            "  palpa help COMMAND      explains one of these:\n";
        std::vector<std::string> groups;
        for (const CLI::App* const command : program.get_subcommands({})) {
            const std::string group = command->get_group();
            if (std::find(groups.begin(), groups.end(), group) == groups.end()) {
                groups.push_back(group);
            }
        }
        for (const std::string& group : groups) {
            page += "\n" + group + "\n";
            for (const CLI::App* const command : program.get_subcommands(
                     [&](const CLI::App* app) { return app->get_group() == group; })) {
                constexpr std::size_t column = 14;
                const std::string start = "  " + command->get_name();
                page += start + wrap(command->get_description(), start.size(), column);
                page += std::string(column, ' ') + first_example(*command) + "\n";
            }
        }
        return page + "\n" + exit_codes;
    }

    static std::string first_example(const CLI::App& command) {
        const std::string& footer = command.get_footer();
        const std::size_t begin = footer.find(example_indent);
        if (begin == std::string::npos) return "palpa " + command.get_name();
        return footer.substr(begin + 2, footer.find('\n', begin) - begin - 2);
    }
};

// Every option of a command, as it is typed.
std::vector<std::string> names_of_options(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* const option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::string hint_of(const std::string& name, const std::vector<std::string>& names) {
    return near_name_hint(name, std::vector<std::string_view>(names.begin(), names.end()));
}

// For who leaves out the command: what is typed may be a scene, or what a scene is made of.
std::string scene_hint(const std::string& typed) {
    std::error_code error;
    try {
        (void)find_scene_file(typed);
        return fmt::format("; did you mean 'palpa run {}'?", printable(typed));
    } catch (const LoadError& problem) {
        const bool is_there = !typed.empty() && std::filesystem::exists(typed, error);
        return is_there ? fmt::format("; {}", printable(problem.what())) : std::string();
    }
}

// The library's "Could not convert: --model = x".
std::string explain_conversion(const std::string& what) {
    const std::size_t colon = what.find(": "), equals = what.find(" = ");
    if (colon == std::string::npos || equals == std::string::npos || equals < colon) return what;
    const std::string value = what.substr(equals + 3);
    return fmt::format("{}: '{}' is not a {}number", what.substr(colon + 2, equals - colon - 2),
                       printable(value), find_real(value) ? "whole " : "");
}

std::string explain_extras(const CLI::App& program, const CLI::App& command) {
    std::vector<std::string> extras = program.remaining(true);
    const std::string extra =
        extras.empty() ? std::string() : extras.front().substr(0, extras.front().find('='));
    if (!extra.starts_with("-")) {
        return fmt::format("unexpected argument '{}'", printable(extra));
    }
    return fmt::format("unknown option '{}'{}", printable(extra),
                       hint_of(extra, names_of_options(command)));
}

// Keys of the scene that palpa connect makes, as its options.
std::string cite_connect(std::string message) {
    constexpr std::array<std::array<std::string_view, 2>, 3> keys{
        {{"engine.wait_s", "--wait"},
         {"engine.protocol", "--protocol"},
         {"engine.rate", "--rate"}}};
    if (message.starts_with("--set")) return message;
    for (const auto& [key, option] : keys) {
        if (const std::size_t at = message.find(key); at != std::string::npos)
            message.replace(at, key.size(), option);
    }
    return message;
}

}  // namespace

void describe(CLI::App& command, const std::string& group, const std::vector<std::string>& examples,
              const std::string& note) {
    command.group(group);
    std::string footer = examples.size() == 1 ? "Example\n" : "Examples\n";
    for (const std::string& example : examples) footer += "  " + example + "\n";
    if (!note.empty()) footer += "\n" + note + "\n";
    command.footer(footer);
}

std::shared_ptr<CLI::FormatterBase> build_help_formatter() {
    return std::make_shared<HelpFormatter>();
}

void add_setting(CLI::App& command, const std::string& option, const std::string& help,
                 std::vector<std::string>& settings) {
    const auto* const found =
        std::find_if(setting_options.begin(), setting_options.end(),
                     [&](const SettingOption& entry) { return entry.option == option; });
    const std::string key(found->key);
    command
        .add_option_function<std::string>(
            option,
            [&settings, key](const std::string& value) { settings.push_back(key + "=" + value); },
            fmt::format("{} ({})", help, key))
        ->trigger_on_parse()
        ->type_name(std::string(found->value));
}

std::string cite_as_typed(const std::string& message, const std::vector<std::string>& arguments) {
    if (!arguments.empty() && arguments.front() == "connect") return cite_connect(message);
    for (const auto& [option, key, value] : setting_options) {
        const std::string cited = fmt::format("--set {}=", key);
        if (!message.starts_with(cited)) continue;
        const bool was_typed = std::any_of(
            arguments.begin(), arguments.end(), [&, &name = option](const std::string& argument) {
                return argument.substr(0, argument.find('=')) == name;
            });
        if (was_typed) return fmt::format("{} {}", option, message.substr(cited.size()));
    }
    return message;
}

std::optional<std::string> explain_command(const CLI::App& program, const std::string& command) {
    const std::vector<const CLI::App*> commands = program.get_subcommands({});
    std::vector<std::string> names{"help"};
    for (const CLI::App* const known : commands) names.push_back(known->get_name());
    if (command.starts_with("-") || std::find(names.begin(), names.end(), command) != names.end()) {
        return std::nullopt;
    }
    for (const auto& [before, now] : renamed_commands) {
        if (command == before)
            return fmt::format("'palpa {}' has a new name: 'palpa {}'", before, now);
    }
    const std::string near = hint_of(command, names);
    return fmt::format("palpa: unknown command '{}'{}; see palpa --help", printable(command),
                       near.empty() ? scene_hint(command) : near);
}

std::string explain(const CLI::ParseError& error, const CLI::App& program,
                    const std::string& command) {
    if (command.starts_with("-")) {
        return fmt::format("palpa: unknown option '{}' without a command{}; see palpa --help",
                           printable(command), hint_of(command, names_of_options(program)));
    }
    std::string what = error.what();
    if (const std::size_t colon = what.find(": ");
        what.ends_with(" missing") && dynamic_cast<const CLI::ArgumentMismatch*>(&error)) {
        what = fmt::format("the option {} needs a value", what.substr(0, colon));
    }
    if (dynamic_cast<const CLI::ConversionError*>(&error)) what = explain_conversion(what);
    if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
        what = explain_extras(program, *program.get_subcommand(command));
    }
    if (what == "structure is required") {
        what =
            "a structure file is required; write it before options with several values "
            "(--without, --as)";
    }
    if (what == "scene is required") what = "a scene is required; 'palpa' alone lists the scenes";
    return fmt::format("palpa {}: {}; see palpa help {}", command, what, command);
}

std::vector<std::string> expand_help(std::vector<std::string> arguments) {
    if (arguments.size() > 2 && arguments[0] == "scene" && arguments[1] == "--help") {
        arguments.erase(arguments.begin() + 1);
    } else if (arguments.size() > 2 && arguments[0] == "help" && arguments[1] == "scene") {
        arguments.erase(arguments.begin());
    } else if (arguments.size() > 1 && arguments[0] == "help" &&
               arguments[1].find('.') != std::string::npos) {
        arguments[0] = "scene";
    }
    if (arguments.empty() || arguments[0] != "help") return arguments;
    arguments.erase(arguments.begin());
    if (arguments.empty() || !arguments.back().starts_with("-")) arguments.emplace_back("--help");
    return arguments;
}

std::vector<std::string> move_structure_first(std::vector<std::string> arguments) {
    if (arguments.empty() || arguments[0] != "prepare") return arguments;
    const auto begin = arguments.begin() + 1, end = arguments.end();
    bool is_toppar = false;
    auto structure = end;
    for (auto word = begin; word != end; ++word) {
        if (word->starts_with("-")) {
            is_toppar = *word == "--toppar" || word->starts_with("--toppar=");
        } else if (is_toppar && is_structure(*word)) {
            structure = word;
        }
    }
    if (structure != end) std::rotate(begin, structure, structure + 1);
    return arguments;
}

}  // namespace palpa
