#include "prepare/choose.h"

#include "core/load_error.h"
#include "core/text.h"
#include "prepare/assembly.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace palpa {
namespace {

constexpr std::string_view choice_heading = "Chosen atoms";

constexpr auto waters = std::to_array<std::string_view>(
    {"HOH", "WAT", "H2O", "DOD", "SOL", "TIP", "TIP3", "TIP4", "TP3M", "SPC", "OH2"});

Structure choose_model(const Structure& structure, const PrepareSettings& settings,
                       Report& report) {
    std::set<int> models;
    for (const AtomRecord& record : structure.records) models.insert(record.model);
    if (models.empty()) models.insert(1);
    const int model = settings.model.value_or(*models.begin());
    if (!models.contains(model)) {
        throw LoadError({structure.file},
                        fmt::format("no model {} (only {})", model, fmt::join(models, ", ")));
    }
    if (models.size() == 1) return structure;
    report.add(choice_heading,
               fmt::format("model {} of {} (--model N takes another)", model, models.size()));
    std::vector<bool> kept;
    for (const AtomRecord& record : structure.records) kept.push_back(record.model == model);
    return keep_atoms(structure, kept);
}

bool is_ion(const Structure& structure, const ResidueRange& residue) {
    if (residue.count != 1) return false;
    const std::string element = element_of(structure, residue.first);
    return element != "O" && element != "C" && element != "N" && element != "H";
}

// Which residues a user leaves out, by what they wrote. Each must mean something.
class LeftOut {
public:
    LeftOut(const Structure& structure, const PrepareSettings& settings)
        : structure_(structure), settings_(settings), used_(settings.without.size()) {}

    bool contains(const ResidueRange& residue) {
        const AtomName& name = structure_.names[residue.first];
        const std::string& chain = chain_of(structure_, residue.first);
        bool is_out = false;
        for (std::size_t i = 0; i < settings_.without.size(); ++i) {
            const std::string& word = settings_.without[i];
            const bool is_meant = word == name.residue || word == "chain:" + chain ||
                                  word == fmt::format("{}:{}", chain, name.number);
            if (is_meant) used_[i] = true;
            is_out = is_out || is_meant;
        }
        return is_out;
    }

    void check_all_used(const std::set<std::string>& names) const {
        for (std::size_t i = 0; i < used_.size(); ++i) {
            if (used_[i]) continue;
            const std::vector<std::string_view> known(names.begin(), names.end());
            throw LoadError(
                {structure_.file},
                fmt::format("nothing here is '{}'{}; expected a residue name, "
                            "chain:NAME or CHAIN:NUMBER",
                            settings_.without[i], near_name_hint(settings_.without[i], known)));
        }
    }

private:
    const Structure& structure_;
    const PrepareSettings& settings_;
    std::vector<bool> used_;
};

bool stands_at(const Structure& structure, const ResidueRange& residue,
               const ResidueChoice& choice) {
    return choice.chain == chain_of(structure, residue.first) &&
           choice.number == structure.names[residue.first].number;
}

// Waters that stay whatever becomes of others. Each choice must mean one.
bool is_structural_water(const Structure& structure, const ResidueRange& residue,
                         const PrepareSettings& settings) {
    return is_water(structure.names[residue.first].residue) &&
           std::ranges::any_of(settings.structural_waters, [&](const ResidueChoice& choice) {
               return stands_at(structure, residue, choice);
           });
}

void check_structural_waters(const Structure& structure, const PrepareSettings& settings) {
    for (const ResidueChoice& choice : settings.structural_waters) {
        const bool is_there =
            std::ranges::any_of(find_residues(structure), [&](const ResidueRange& residue) {
                return stands_at(structure, residue, choice) &&
                       is_water(structure.names[residue.first].residue);
            });
        if (is_there) continue;
        throw LoadError({structure.file},
                        fmt::format("--structural-water {}:{}: no water there; expected "
                                    "CHAIN:NUMBER of a water of the file",
                                    choice.chain, choice.number));
    }
}

Structure leave_out(const Structure& structure, const PrepareSettings& settings, Report& report) {
    check_structural_waters(structure, settings);
    std::vector<bool> kept(structure.names.size(), true);
    LeftOut left_out(structure, settings);
    std::set<std::string> names;
    std::map<std::string, std::size_t> dropped;
    std::size_t water_count = 0, ion_count = 0;
    for (const ResidueRange& residue : find_residues(structure)) {
        const std::string& name = structure.names[residue.first].residue;
        names.insert(name);
        const bool drops_water = is_water(name) && !settings.keeps_waters &&
                                 !is_structural_water(structure, residue, settings);
        const bool drops_ion = is_ion(structure, residue) && !settings.keeps_ions;
        const bool is_named = left_out.contains(residue);
        if (!drops_water && !drops_ion && !is_named) continue;
        std::fill_n(kept.begin() + static_cast<std::ptrdiff_t>(residue.first), residue.count,
                    false);
        if (is_named) {
            ++dropped[name];
        } else if (drops_water) {
            ++water_count;
        } else {
            ++ion_count;
        }
    }
    left_out.check_all_used(names);
    for (const auto& [name, count] : dropped) {
        report.add(choice_heading, fmt::format("left out as asked: {} ({} residue{})", name, count,
                                               count == 1 ? "" : "s"));
    }
    if (water_count > 0) {
        report.add(choice_heading,
                   fmt::format("left out {} waters (--keep-waters keeps them)", water_count));
    }
    if (ion_count > 0)
        report.add(choice_heading, fmt::format("left out {} ions as asked", ion_count));
    return keep_atoms(structure, kept);
}

char choose_location(const Structure& structure, const ResidueRange& residue,
                     const PrepareSettings& settings, Report& report) {
    std::map<char, std::pair<double, int>> locations;  // occupancies, atoms
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        const AtomRecord& record = structure.records[i];
        if (record.alternate == ' ') continue;
        auto& [occupancy, count] = locations[record.alternate];
        occupancy += record.occupancy;
        ++count;
    }
    if (locations.empty()) return ' ';
    const auto mean = [](const auto& entry) { return entry.second.first / entry.second.second; };
    char chosen = locations.begin()->first;
    for (const auto& entry : locations) {
        if (mean(entry) > mean(*locations.find(chosen)) + 1e-6) chosen = entry.first;
    }
    std::string reason = fmt::format("occupancy {:.2f}", mean(*locations.find(chosen)));
    for (const auto& [choice, location] : settings.alternates) {
        if (choice.chain != chain_of(structure, residue.first) ||
            choice.number != structure.names[residue.first].number) {
            continue;
        }
        if (!locations.contains(location)) {
            throw LoadError({structure.file, structure.lines[residue.first], 0},
                            fmt::format("{} has no alternate location '{}'",
                                        residue_label(structure, residue), location));
        }
        chosen = location;
        reason = "as asked";
    }
    std::string all;
    for (const auto& entry : locations) all += fmt::format(" {}", entry.first);
    report.add(choice_heading, fmt::format("{}: location {} of{} ({})",
                                           residue_label(structure, residue), chosen, all, reason));
    return chosen;
}

// Atoms that the chosen location does not have (a backbone in two places, its side chain in three):
// of each the most occupied place, in the residue that was chosen.
void keep_others(const Structure& structure, const ResidueRange& residue, std::vector<bool>& kept) {
    std::set<std::string_view> there;
    std::string_view name;
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        if (!kept[i]) continue;
        there.insert(structure.names[i].atom);
        name = structure.names[i].residue;
    }
    std::map<std::string_view, std::size_t> best;
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        const AtomName& atom = structure.names[i];
        if (there.contains(atom.atom) || atom.residue != name) continue;
        const auto [found, is_new] = best.try_emplace(atom.atom, i);
        if (structure.records[i].occupancy > structure.records[found->second].occupancy) {
            found->second = i;
        }
    }
    for (const auto& [atom, index] : best) kept[index] = true;
}

bool has_locations(const Structure& structure, const ResidueChoice& choice) {
    for (std::size_t i = 0; i < structure.names.size(); ++i) {
        if (structure.records[i].alternate != ' ' && structure.names[i].number == choice.number &&
            chain_of(structure, i) == choice.chain) {
            return true;
        }
    }
    return false;
}

Structure choose_locations(const Structure& structure, const PrepareSettings& settings,
                           Report& report) {
    if (structure.records.empty()) return structure;
    std::vector<bool> kept(structure.names.size(), true);
    for (const ResidueRange& residue : find_residues(structure)) {
        const char chosen = choose_location(structure, residue, settings, report);
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            const char location = structure.records[i].alternate;
            kept[i] = location == ' ' || location == chosen;
        }
        keep_others(structure, residue, kept);
    }
    for (const auto& [choice, location] : settings.alternates) {
        if (!has_locations(structure, choice)) {
            throw LoadError({structure.file},
                            fmt::format("--altloc {}:{}={}: no residue of that number has "
                                        "alternate locations",
                                        choice.chain, choice.number, location));
        }
    }
    Structure result = keep_atoms(structure, kept);
    for (AtomRecord& record : result.records) record.alternate = ' ';
    return result;
}

}  // namespace

bool is_water(std::string_view residue_name) noexcept {
    return std::find(waters.begin(), waters.end(), residue_name) != waters.end();
}

Structure choose_atoms(const Structure& structure, const PrepareSettings& settings,
                       Report& report) {
    const Structure model = choose_model(structure, settings, report);
    if (settings.assembly == 0) warn_of_assembly(model, report);
    const Structure whole =
        settings.assembly > 0 ? build_assembly(model, settings.assembly, report) : model;
    const Structure wanted = leave_out(whole, settings, report);
    if (wanted.names.empty()) {
        throw LoadError({structure.file},
                        "no atom is left once waters, ions and what was asked "
                        "for are left out");
    }
    return choose_locations(wanted, settings, report);
}

}  // namespace palpa
