#include "tools/commands/command.h"

#include "core/load_error.h"
#include "core/text.h"
#include "download/pdb_code.h"
#include "scene/read_scene.h"
#include "tools/commands/render.h"

#include <fmt/format.h>
#include <optional>

namespace palpa {

void print_notes(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", printable(note));
}

void note_file_before_code(const std::string& file) {
    if (!is_pdb_code(file)) return;
    print_notes(
        {fmt::format("{} is a file or folder here and is used; the PDB entry of this code is "
                     "downloaded in other folders",
                     file)});
}

void add_set_option(CLI::App& command, std::vector<std::string>& settings) {
    command
        .add_option_function<std::string>(
            "--set", [&settings](const std::string& value) { settings.push_back(value); },
            "set a key of the scene file, by its full name or its last part ('palpa help keys' "
            "lists all)")
        ->type_name("KEY=VALUE")
        ->trigger_on_parse()
        ->take_last();
    command.add_flag_callback(
        std::string(allow_outside), [&settings] { settings.emplace_back(allow_outside); },
        "allow the scene to name files outside of its folder");
}

void add_negation(CLI::App& command, const std::string& flag, bool& value,
                  const std::string& help) {
    command.add_flag_callback(flag, [&value] { value = false; }, help);
}

CLI::Validator in_range(double lowest, double highest) {
    return CLI::Validator(
        [lowest, highest](const std::string& text) {
            const std::optional<double> value = find_real(text);
            if (value && *value >= lowest && *value <= highest) return std::string();
            return fmt::format("'{}' is not a number from {} to {}", text, lowest, highest);
        },
        fmt::format("{} to {}", lowest, highest));
}

// A whole number as the key run.seed takes it; CLI11 would wrap others round.
void add_seed_option(CLI::App& command, std::uint64_t& seed) {
    static constexpr std::int64_t highest = 1'000'000'000'000'000;
    command
        .add_option_function<std::string>(
            "--seed",
            [&seed](const std::string& text) {
                const std::optional<std::int64_t> value = find_integer(text);
                if (!value || *value < 0 || *value > highest) {
                    throw CLI::ValidationError(
                        "--seed",
                        fmt::format("'{}' is not a whole number from 0 to {}", text, highest));
                }
                seed = static_cast<std::uint64_t>(*value);
            },
            "random seed, 1 unless given")
        ->type_name("UINT");
}

void add_size_option(CLI::App& command, const std::string& option, std::uint32_t& width,
                     std::uint32_t& height) {
    command
        .add_option_function<std::string>(
            option,
            [option, &width, &height](const std::string& text) {
                const std::size_t by = text.find('x');
                const auto wide = find_integer(text.substr(0, by));
                const auto high = find_integer(by == std::string::npos ? "" : text.substr(by + 1));
                if (!wide || !high || *wide < 1 || *high < 1 || *wide > 1'000'000 ||
                    *high > 1'000'000) {
                    throw CLI::ValidationError(
                        option, "'" + text + "' is not a size; expected WIDTHxHEIGHT");
                }
                if (*wide * *high > most_pixels) {
                    throw CLI::ValidationError(
                        option, fmt::format("'{}' has more than {} pixels", text, most_pixels));
                }
                width = static_cast<std::uint32_t>(*wide);
                height = static_cast<std::uint32_t>(*high);
            },
            fmt::format("in pixels, {}x{} unless given", width, height))
        ->type_name("WIDTHxHEIGHT");
}

void add_overwrite_flag(CLI::App& command, bool& overwrites) {
    command.add_flag("--overwrite", overwrites,
                     "replace what this command wrote before; other files are never replaced");
}

void add_toppar_option(CLI::App& command, std::vector<std::filesystem::path>& toppar) {
    command
        .add_option("--toppar", toppar,
                    "CHARMM topology, parameter and stream files, in order, or a folder of them")
        ->type_name("FILE")
        ->required();
}

void refuse_remote_engine(const SceneDescription& scene) {
    if (!scene.engine) return;
    throw LoadError(scene.place_of("engine"),
                    "a remote engine moves all atoms here, and this command needs Palpa's own "
                    "mechanics; expected a scene without [engine], or palpa run");
}

}  // namespace palpa
