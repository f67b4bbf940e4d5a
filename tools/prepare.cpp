#include "tools/prepare.h"

#include "charmm/force_field.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "formats/structure.h"
#include "prepare/prepare.h"

#include <fmt/format.h>
#include <unistd.h>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

// "LEFT=RIGHT"; `form`: what would be right.
std::pair<std::string, std::string> split(const std::string& text, const char* option,
                                          std::string_view form, char at = '=') {
    const std::size_t by = text.find(at);
    if (by == std::string::npos || by == 0 || by + 1 == text.size()) {
        throw LoadError({fmt::format("{} {}", option, text)}, fmt::format("expected {}", form));
    }
    return {text.substr(0, by), text.substr(by + 1)};
}

// "CHAIN:NUMBER", or ":NUMBER" of a file without chains.
ResidueChoice read_choice(const std::string& text, const char* option, std::string_view form) {
    const std::size_t by = text.rfind(':');
    if (by == std::string::npos || by + 1 == text.size()) {
        throw LoadError({fmt::format("{} {}", option, text)}, fmt::format("expected {}", form));
    }
    return {text.substr(0, by), text.substr(by + 1)};
}

PrepareSettings build_settings(const PrepareOptions& options) {
    PrepareSettings settings = options.settings;
    for (const std::string& text : options.as) {
        const auto [from, to] = split(text, "--as", "NAME=NAME, as in CSO=CYS");
        settings.residue_names.emplace_back(upper_case(from), upper_case(to));
    }
    for (const std::string& text : options.protonation) {
        constexpr std::string_view form = "CHAIN:NUMBER=STATE, as in A:25=ASPP";
        const auto [where, state] = split(text, "--protonation", form);
        settings.protonation.emplace_back(read_choice(where, "--protonation", form),
                                          upper_case(state));
    }
    for (const std::string& text : options.alternates) {
        constexpr std::string_view form = "CHAIN:NUMBER=LETTER, as in A:53=B";
        const auto [where, letter] = split(text, "--altloc", form);
        if (letter.size() != 1) {
            throw LoadError({fmt::format("--altloc {}", text)}, fmt::format("expected {}", form));
        }
        settings.alternates.emplace_back(read_choice(where, "--altloc", form), letter[0]);
    }
    for (const std::string& text : options.first) {
        auto [chain, patch] = split(text, "--first", "CHAIN=PATCH, as in A=NNEU");
        settings.first.emplace_back(chain, upper_case(patch));
    }
    for (const std::string& text : options.last) {
        auto [chain, patch] = split(text, "--last", "CHAIN=PATCH, as in A=CNEU");
        settings.last.emplace_back(chain, upper_case(patch));
    }
    for (const std::string& text : options.disulphides) {
        constexpr std::string_view form = "CHAIN:NUMBER-CHAIN:NUMBER, as in A:3-A:40";
        const auto [one, other] = split(text, "--disulphide", form, '-');
        settings.disulphides.emplace_back(read_choice(one, "--disulphide", form),
                                          read_choice(other, "--disulphide", form));
    }
    if (!options.x_along.empty()) {
        settings.align = AlignSettings{options.x_along, {}};
        if (!options.y_towards.empty()) {
            constexpr std::string_view form = "CHAIN:NUMBER-CHAIN:NUMBER, as in A:25-A:50";
            const auto [one, other] = split(options.y_towards, "--y-towards", form, '-');
            settings.align->up = {read_choice(one, "--y-towards", form),
                                  read_choice(other, "--y-towards", form)};
        }
    }
    return settings;
}

void check_outputs(const PrepareOptions& options) {
    std::error_code error;
    if (!std::filesystem::exists(options.folder, error)) return;
    for (const char* const name :
         {"system.psf", "system.pdb", "system.crd", "system.prm", "report.txt", "scene.toml"}) {
        (void)check_output(options.folder / name, prepared_mark, options.overwrites);
    }
}

}  // namespace

int prepare_command(const PrepareOptions& options) {
    const PrepareSettings settings = build_settings(options);
    check_outputs(options);
    const ForceField force_field = read_force_field(options.toppar);
    const Structure structure = read_structure(options.structure);
    const bool shows_progress = !options.json && isatty(fileno(stderr)) != 0;
    const auto progress = [&](std::string_view stage, double share) {
        if (shows_progress) fmt::print(stderr, "\r{:<40}{:3.0f} %", stage, 100 * share);
    };
    const PreparedSystem system = prepare_system(force_field, structure, settings, progress);
    if (shows_progress) fmt::print(stderr, "\r{:46}\r", "");
    const std::string origin = fmt::format("Prepared from {} by palpa prepare; see report.txt.",
                                           options.structure.filename().string());
    const std::string in_hand = options.grab.empty() ? find_smallest_segment(system) : options.grab;
    const std::string scene =
        in_hand.empty() ? in_hand
                        : format_scene_of(system, in_hand, options.structure.stem().string());
    write_prepared(system, options.folder,
                   options.title.empty() ? origin : fmt::format("{}\n{}", options.title, origin),
                   scene, options.overwrites ? Existing::Replace : Existing::Refuse);
    if (options.json) {
        nlohmann::ordered_json json;
        json["atoms"] = system.structure.names.size();
        json["bonds"] = system.connectivity.bonds.size();
        json["angles"] = system.connectivity.angles.size();
        json["dihedrals"] = system.connectivity.dihedrals.size();
        json["impropers"] = system.connectivity.impropers.size();
        json["cmaps"] = system.connectivity.cmaps.size();
        json["warnings"] = system.report.warnings();
        fmt::print("{}\n", json.dump(2));
        return 0;
    }
    fmt::print("{}written: {}\n", system.report.to_text(), options.folder.string());
    if (!scene.empty()) {
        fmt::print("feel it: palpa run {}   ({} is in the hand; --grab takes another)\n",
                   options.folder.string(), in_hand);
    }
    return 0;
}

}  // namespace palpa
