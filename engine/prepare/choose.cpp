#include "prepare/choose.h"

#include "core/load_error.h"
#include "core/text.h"
#include "molecule/components.h"
#include "molecule/residue_kinds.h"
#include "prepare/assembly.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::string_view choice_heading = "Selected atoms";

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

// Which residues a user means, by what they wrote. Each word must mean something.
class MeantResidues {
public:
    MeantResidues(const Structure& structure, const std::vector<std::string>& words)
        : structure_(structure), words_(words), used_(words.size()) {}

    bool contains(const ResidueRange& residue) {
        const AtomName& name = structure_.names[residue.first];
        const std::string& chain = chain_of(structure_, residue.first);
        bool is_meant = false;
        for (std::size_t i = 0; i < words_.size(); ++i) {
            const std::string& word = words_[i];
            if (word != name.residue && word != "chain:" + chain &&
                word != fmt::format("{}:{}", chain, name.number)) {
                continue;
            }
            used_[i] = is_meant = true;
        }
        return is_meant;
    }

    void check_all_used(const std::set<std::string>& names) const {
        for (std::size_t i = 0; i < used_.size(); ++i) {
            if (used_[i]) continue;
            const std::vector<std::string_view> known(names.begin(), names.end());
            throw LoadError({structure_.file},
                            fmt::format("the structure has no '{}'{}; expected a residue name, "
                                        "chain:NAME or CHAIN:NUMBER",
                                        words_[i], near_name_hint(words_[i], known)));
        }
    }

private:
    const Structure& structure_;
    const std::vector<std::string>& words_;
    std::vector<bool> used_;
};

// Residues that a stated bond holds to another one that is no ion: a phosphate on a serine.
std::set<std::pair<std::string, std::string>> find_bonded(const Structure& structure) {
    std::set<std::pair<std::string, std::string>> ions, bonded;
    for (const ResidueRange& residue : find_residues(structure)) {
        if (!is_ion(structure, residue)) continue;
        ions.emplace(chain_of(structure, residue.first), structure.names[residue.first].number);
    }
    for (const StructureLink& link : structure.links) {
        const std::pair a(link.a.chain, link.a.number), b(link.b.chain, link.b.number);
        if (ions.contains(a) || ions.contains(b)) continue;
        bonded.insert(a);
        bonded.insert(b);
    }
    return bonded;
}

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

// Why a residue is left out.
enum class Reason { None, Asked, Water, Ion, Crystal };

// Counts omitted residues by reason and name, and reports them.
class LeftOut {
public:
    void add(Reason reason, const std::string& name) {
        if (reason == Reason::Water) {
            ++waters_;
        } else if (reason == Reason::Ion) {
            ++ions_;
        } else {
            ++(reason == Reason::Asked ? asked_ : crystal_)[name];
        }
    }

    void report(Report& report) const {
        const auto count_of = [](std::size_t count) {
            return fmt::format("{} residue{}", count, count == 1 ? "" : "s");
        };
        for (const auto& [name, count] : asked_) {
            report.add(choice_heading,
                       fmt::format("left out, as requested: {} ({})", name, count_of(count)));
        }
        for (const auto& [name, count] : crystal_) {
            report.add(
                choice_heading,
                fmt::format(
                    "left out because only the crystal needed it: {}, {} ({}; --keep {} keeps it)",
                    name, crystal_only(name), count_of(count), name));
        }
        if (waters_ > 0) {
            report.add(choice_heading,
                       fmt::format("left out {} waters (--keep-waters keeps them)", waters_));
        }
        if (ions_ > 0)
            report.add(choice_heading, fmt::format("left out {} ions, as requested", ions_));
    }

private:
    std::map<std::string, std::size_t> asked_, crystal_;
    std::size_t waters_ = 0, ions_ = 0;
};

Structure leave_out(const Structure& structure, const PrepareSettings& settings, Report& report) {
    check_structural_waters(structure, settings);
    std::vector<bool> kept(structure.names.size(), true);
    MeantResidues unwanted(structure, settings.without), wanted(structure, settings.kept);
    const std::set<std::pair<std::string, std::string>> bonded = find_bonded(structure);
    std::set<std::string> names;
    LeftOut left_out;
    for (const ResidueRange& residue : find_residues(structure)) {
        const std::string& name = structure.names[residue.first].residue;
        names.insert(name);
        const bool is_unwanted = unwanted.contains(residue), is_wanted = wanted.contains(residue);
        const auto reason = [&] {
            if (is_unwanted) return Reason::Asked;
            if (is_wanted) return Reason::None;
            if (is_water(name)) {
                const bool stays =
                    settings.keeps_waters || is_structural_water(structure, residue, settings);
                return stays ? Reason::None : Reason::Water;
            }
            const bool is_bonded = bonded.contains(
                {chain_of(structure, residue.first), structure.names[residue.first].number});
            if (!crystal_only(name).empty() && !is_bonded) return Reason::Crystal;
            return is_ion(structure, residue) && !settings.keeps_ions ? Reason::Ion : Reason::None;
        }();
        if (reason == Reason::None) continue;
        std::fill_n(kept.begin() + static_cast<std::ptrdiff_t>(residue.first), residue.count,
                    false);
        left_out.add(reason, name);
    }
    unwanted.check_all_used(names);
    wanted.check_all_used(names);
    left_out.report(report);
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
        reason = "as requested";
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

Structure choose_atoms(const Structure& structure, const PrepareSettings& settings,
                       Report& report) {
    const Structure model = choose_model(structure, settings, report);
    if (settings.assembly == 0) warn_of_assembly(model, report);
    const Structure whole =
        settings.assembly > 0 ? build_assembly(model, settings.assembly, report) : model;
    const Structure wanted = leave_out(whole, settings, report);
    if (wanted.names.empty()) {
        throw LoadError({structure.file},
                        "no atom remains after leaving out waters (--keep-waters), ions "
                        "(--no-ions), molecules of the crystal (--keep) and what --without names");
    }
    return choose_locations(wanted, settings, report);
}

}  // namespace palpa
