// palpa select: which atoms of a scene an expression means.
#include "molecule/select.h"
#include "core/text.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/components.h"
#include "tools/commands/command.h"
#include "tools/commands/progress.h"
#include "view/selected_atoms.h"

#include <fmt/format.h>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

struct SelectOptions {
    std::filesystem::path scene;
    std::string expression;
    std::vector<std::string> settings;
    bool json = false;
};

// The selected atoms of a residue, by number.
struct SelectedResidue {
    std::string molecule;
    const AtomName* name;
    std::vector<std::uint32_t> atoms;
};

std::vector<SelectedResidue> list_selected(const World& world, const std::vector<bool>& selected) {
    const AtomTable& atoms = world.resource<AtomTable>();
    std::vector<SelectedResidue> residues;
    world.each<Molecule>([&](Entity, const Molecule& molecule) {
        const std::vector<AtomRange> ranges{molecule.atoms};
        for (const AtomRange& range : list_residues(atoms, ranges)) {
            SelectedResidue residue{molecule.name, &atoms.names[range.first], {}};
            for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
                if (selected[i]) residue.atoms.push_back(i);
            if (!residue.atoms.empty()) residues.push_back(std::move(residue));
        }
    });
    return residues;
}

std::size_t count_atoms(const std::vector<SelectedResidue>& residues) {
    std::size_t count = 0;
    for (const SelectedResidue& residue : residues) count += residue.atoms.size();
    return count;
}

constexpr std::size_t select_line_width = 100;

std::string plural(std::size_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// Of one molecule, in lines that end before the width. Of many residues the first are listed.
std::string format_residues(const std::string& molecule, const std::vector<std::string>& words) {
    constexpr std::size_t most_listed = 60;
    std::string text = fmt::format("  {} ({})\n", molecule, plural(words.size(), "residue"));
    std::string line = "   ";
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i == most_listed) {
            text += fmt::format("{}\n    and {} more (--json lists all)\n", line,
                                words.size() - most_listed);
            return text;
        }
        if (line.size() + 1 + words[i].size() + 1 > select_line_width) {
            text += line + "\n";
            line = "   ";
        }
        line += " " + words[i] + (i + 1 < words.size() ? "," : "");
    }
    return text + line + "\n";
}

void print_selected(const std::vector<SelectedResidue>& residues) {
    fmt::print("{} of {}\n", plural(count_atoms(residues), "atom"),
               plural(residues.size(), "residue"));
    for (std::size_t first = 0; first < residues.size();) {
        const std::string& molecule = residues[first].molecule;
        std::vector<std::string> words;
        while (first < residues.size() && residues[first].molecule == molecule) {
            const AtomName& name = *residues[first].name;
            words.push_back(printable(name.residue + " " + name.number));
            ++first;
        }
        fmt::print("{}", format_residues(molecule, words));
    }
}

void print_selected_json(const std::string& expression,
                         const std::vector<SelectedResidue>& residues) {
    nlohmann::ordered_json json{{"expression", expression},
                                {"atoms", count_atoms(residues)},
                                {"indices", nlohmann::ordered_json::array()},
                                {"residues", nlohmann::ordered_json::array()}};
    for (const SelectedResidue& residue : residues) {
        for (const std::uint32_t atom : residue.atoms) json["indices"].push_back(atom);
        json["residues"].push_back({{"molecule", residue.molecule},
                                    {"segment", residue.name->segment},
                                    {"residue", residue.name->residue},
                                    {"number", residue.name->number},
                                    {"atoms", residue.atoms.size()}});
    }
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

int select_command(const SelectOptions& options) {
    (void)parse_selection(options.expression);  // before the scene is loaded
    const SceneDescription scene = read_scene(options.scene, options.settings);
    print_notes(scene.notes);
    refuse_remote_engine(scene);
    ProgressLine progress;
    const World world = load_world(scene, progress.stages());
    progress.wipe();
    const std::vector<SelectedResidue> residues =
        list_selected(world, select_as_seen(world, options.expression));
    options.json ? print_selected_json(options.expression, residues) : print_selected(residues);
    return 0;
}

}  // namespace

void add_select(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& command =
        *program.add_subcommand("select", "List the atoms of a scene that an expression selects");
    SelectOptions& options = own_options<SelectOptions>(command, chosen, select_command);
    describe(command,
             {"palpa select hiv \"protein and within 5 of molecule inhibitor\"",
              "palpa select scenes/hiv \"byres (heavy and within 4 of hand) and not hand\" --json",
              "palpa select scenes/hairpin \"name CA and resid 2:5\""},
             "Words: all none protein nucleic water ion ligand lipid glycan backbone sidechain\n"
             "hydrogen, polar hydrogen, heavy, hand; chain segment resname name element molecule\n"
             "NAME ...; resid index serial N ... or FROM:TO; charge mass x y z < <= > >= = != N;\n"
             "within N of ..., same residue as ..., byres ..., not, and, or, parentheses.\n"
             "tools/selections.md explains them.");
    command.add_option("scene", options.scene, "scene folder or file")->required();
    command.add_option("expression", options.expression, "selection expression, in quotes")
        ->required();
    command.add_flag("--json", options.json,
                     "print JSON; indices count all atoms of the scene from 0");
    add_set_option(command, options.settings);
}

}  // namespace palpa
