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

constexpr std::size_t page_width = 100, name_width = 30;

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

// Commands that went elsewhere.
struct MovedCommand {
    std::string_view before, now;
};
constexpr std::array moved_commands = std::to_array<MovedCommand>({
    {"accuracy", "palpa-lab accuracy"},
    {"bench", "palpa-lab bench"},
    {"closed-paths", "palpa-lab closed-paths"},
    {"compare-ligands", "palpa-lab compare-ligands"},
    {"force-field", "palpa-lab force-field"},
    {"report", "palpa-lab report"},
    {"scenarios", "palpa-lab scenarios"},
    {"unbind", "palpa-lab unbind"},
    {"scene", "palpa help"},
});

// Breaks a description into lines beside the column of names.
std::string wrap(std::string_view text) {
    std::string page;
    std::size_t at = name_width;
    for (const std::string_view word : split_words(text)) {
        if (at > name_width) {
            const bool fits = at + 1 + word.size() <= page_width;
            page += fits ? ' ' : '\n';
            at = fits ? at + 1 : name_width;
        }
        page += word;
        at += word.size();
    }
    return page;
}

// CLI11's own page, with values as people write them and lines that fit.
class HelpFormatter : public CLI::Formatter {
public:
    explicit HelpFormatter(std::string usage) : usage_(std::move(usage)) {
        column_width(name_width);
        label("Positionals", "Arguments");
    }

    std::string make_usage(const CLI::App* app, std::string name) const override {
        if (!app->get_parent()) return "\n" + usage_;
        // Arguments come first: an option of several values would take them too.
        std::string usage = "Usage: " + name;
        for (const CLI::Option* const positional :
             app->get_options([](const CLI::Option* option) { return option->get_positional(); })) {
            const std::string one = make_option_name(positional, true) +
                                    (positional->get_expected_max() > 1 ? " ..." : "");
            usage += positional->get_required() ? " " + one : " [" + one + "]";
        }
        return usage + " [OPTION ...]\n";
    }

    // Lists all commands of a program, in their order.
    std::string make_subcommands(const CLI::App* app, CLI::AppFormatMode) const override {
        std::string lines;
        for (const CLI::App* const command : app->get_subcommands({})) {
            lines +=
                fmt::format("    {:<15} {}\n", command->get_name(), command->get_description());
        }
        return lines;
    }

    std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
        const std::string name = CLI::Formatter::make_option_name(option, is_positional);
        return is_positional ? upper_case(name) : name;
    }

    std::string make_option_opts(const CLI::Option* option) const override {
        if (option->get_positional() || option->get_type_size() == 0) return {};
        const std::string type = option->get_type_name();
        const std::string base = type.substr(0, type.find(':'));
        const bool is_number = base == "FLOAT" || base == "INT" || base == "UINT";
        return fmt::format(" {}{}",
                           is_number        ? "N"
                           : base == "TEXT" ? "NAME"
                                            : base,
                           option->get_expected_max() > 1 && !base.ends_with("...") ? " ..." : "");
    }

    // Ranges and needed options are said with the description; CLI11's lists of what is allowed
    // stand in it.
    std::string make_option_desc(const CLI::Option* option) const override {
        std::vector<std::string> notes;
        const std::string type = option->get_type_name();
        const std::size_t colon = type.find(':');
        if (colon != std::string::npos && type[colon + 1] != '{') {
            notes.push_back(type.substr(colon + 1));
        }
        for (const CLI::Option* const other : option->get_needs()) {
            if (!other->get_positional()) notes.push_back("with " + other->get_name());
        }
        if (option->get_required() && !option->get_positional()) notes.emplace_back("required");
        const std::string& text = option->get_description();
        return wrap(notes.empty() ? text : fmt::format("{} ({})", text, fmt::join(notes, "; ")));
    }

private:
    std::string usage_;
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

void describe(CLI::App& command, const std::vector<std::string>& examples,
              const std::string& note) {
    std::string footer = examples.size() == 1 ? "Example\n" : "Examples\n";
    for (const std::string& example : examples) footer += "  " + example + "\n";
    if (!note.empty()) footer += "\n" + note + "\n";
    footer.pop_back();  // CLI11 ends the line
    command.footer(footer);
}

std::shared_ptr<CLI::FormatterBase> build_help_formatter(const std::string& usage) {
    return std::make_shared<HelpFormatter>(usage);
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
    for (const auto& [before, now] : moved_commands) {
        if (command != before) continue;
        const bool is_lab = now.starts_with("palpa-lab");
        return fmt::format("'palpa {}' is '{}' now{}", before, now,
                           is_lab ? ", which tools/build makes" : "");
    }
    const std::string near = hint_of(command, names);
    return fmt::format("{0}: unknown command '{1}'{2}; see {0} --help", program.get_name(),
                       printable(command), near.empty() ? scene_hint(command) : near);
}

std::string explain(const CLI::ParseError& error, const CLI::App& program,
                    const std::string& command) {
    if (command.starts_with("-")) {
        return fmt::format("{0}: unknown option '{1}' without a command{2}; see {0} --help",
                           program.get_name(), printable(command),
                           hint_of(command, names_of_options(program)));
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
    return fmt::format("{0} {1}: {2}; see {0} help {1}", program.get_name(), command, what);
}

std::vector<std::string> expand_help(const CLI::App& program, std::vector<std::string> arguments) {
    if (arguments.empty() || arguments[0] != "help") return arguments;
    if (arguments.size() == 1 || arguments[1] == "help") return {"--help"};
    const bool is_command = !program
                                 .get_subcommands([&](const CLI::App* command) {
                                     return command->get_name() == arguments[1];
                                 })
                                 .empty();
    return is_command ? std::vector{arguments[1], std::string("--help")} : arguments;
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
