#include "prepare/atom_names.h"

#include "charmm/missing.h"
#include "core/text.h"
#include "forces/torsion.h"
#include "molecule/element.h"
#include "prepare/match_by_bonds.h"
#include "prepare/residues.h"
#include "prepare/wanted_atoms.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::string_view names_heading = "Atom names";
using std::numbers::pi;

// Heavy atoms that the PDB and other programs call otherwise; taken where the template has the
// second name and not the first.
constexpr auto aliases =
    std::to_array<std::pair<std::string_view, std::string_view>>({{"O", "OT1"},
                                                                  {"OXT", "OT2"},
                                                                  {"O1", "OT1"},
                                                                  {"O2", "OT2"},
                                                                  {"OT", "OT2"},
                                                                  {"CD1", "CD"},
                                                                  {"O", "OH2"},
                                                                  {"OW", "OH2"},
                                                                  {"OP1", "O1P"},
                                                                  {"OP2", "O2P"},
                                                                  {"CH3", "CAT"},
                                                                  {"CH3", "CAY"},
                                                                  {"C5M", "C7"}});

class AtomNamer {
public:
    AtomNamer(const ForceField& force_field, const Structure& structure,
              const GenerateSettings& settings, Report& report)
        : structure_(structure),
          report_(report),
          templates_(force_field, settings),
          residues_(find_residues(structure)),
          kept_(structure.names.size(), true) {}

    Structure name() {
        for (std::size_t i = 0; i < residues_.size(); ++i) name_residue(i);
        if (backbones_ > 0 && alpha_carbons_ == backbones_) {
            throw LoadError({structure_.file},
                            "no residue has N, CA and C: the structure seems to have alpha-carbons "
                            "only; expected a structure with all heavy atoms");
        }
        refuse_fragments();
        missing_.throw_if_any();
        tell();
        return keep_atoms(structure_, kept_);
    }

private:
    static constexpr std::size_t most_matched = 1000;  // atoms of a residue

    const std::string& segment(std::size_t index) const {
        return structure_.names[residues_[index].first].segment;
    }

    void name_residue(std::size_t index) {
        const ResidueRange& residue = residues_[index];
        const AtomName& name = structure_.names[residue.first];
        const bool is_first = index == 0 || segment(index - 1) != segment(index);
        const bool is_last = index + 1 == residues_.size() || segment(index + 1) != segment(index);
        const WantedAtoms wanted = templates_.find(name, is_first, is_last);
        correct_elements(residue, wanted);
        name_heavy_atoms(residue, wanted);
        check_heavy_atoms(residue, wanted);
        name_hydrogens(residue, wanted);
    }

    void correct_elements(const ResidueRange& residue, const WantedAtoms& wanted) {
        if (structure_.records.empty()) return;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            const auto found = wanted.elements.find(structure_.names[i].atom);
            std::string& element = structure_.records[i].element;
            if (found == wanted.elements.end() || found->second.empty()) continue;
            const std::string read = element == "D" ? "H" : element;
            if (!read.empty() && read != found->second) ++corrected_elements_;
            element = found->second;
        }
    }

    void name_heavy_atoms(const ResidueRange& residue, const WantedAtoms& wanted) {
        if (needs_bonds(residue, wanted)) name_by_bonds(residue, wanted);
        std::set<std::string> seen;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(structure_, i) == "H") continue;
            std::string& name = structure_.names[i].atom;
            if (!wanted.has(name)) rename_heavy_atom(residue, i, wanted);
            if (!seen.insert(name).second) {
                missing_.add(place(i), fmt::format("{} has two atoms '{}'",
                                                   residue_label(structure_, residue), name));
            }
        }
    }

    // A residue with a name that neither the template has nor the table of others; of molecules
    // that are no chain also one whose names say other bonds.
    bool needs_bonds(const ResidueRange& residue, const WantedAtoms& wanted) const {
        std::size_t heavy = 0, foreign = 0;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(structure_, i) == "H") continue;
            ++heavy;
            const std::string& name = structure_.names[i].atom;
            const auto found = wanted.elements.find(name);
            const bool is_other =
                found != wanted.elements.end() && found->second != element_of(structure_, i);
            if (is_other || (found == wanted.elements.end() && name != "OXT" &&
                             !find_alias(residue, name, wanted))) {
                ++foreign;
            }
        }
        if (heavy < 2) return false;
        return foreign > 0 || (!wanted.has("CA") && has_other_bonds(residue, wanted));
    }

    // Whether atoms are bonded whose names in the template are not.
    bool has_other_bonds(const ResidueRange& residue, const WantedAtoms& wanted) const {
        if (residue.count > most_matched) return false;
        const BondedAtoms given = find_bonded_atoms(structure_, residue);
        const BondedAtoms all = find_bonded_atoms(wanted);
        const auto index = [&](const std::string& name) {
            return std::find(all.names.begin(), all.names.end(), name) - all.names.begin();
        };
        for (std::uint32_t a = 0; a < given.names.size(); ++a) {
            const auto at = static_cast<std::size_t>(index(given.names[a]));
            if (at == all.names.size()) continue;
            for (const std::uint32_t b : given.neighbours[a]) {
                const auto to = static_cast<std::uint32_t>(index(given.names[b]));
                if (to == all.names.size()) continue;
                const auto& others = all.neighbours[at];
                if (std::find(others.begin(), others.end(), to) == others.end()) return true;
            }
        }
        return false;
    }

    void name_by_bonds(const ResidueRange& residue, const WantedAtoms& wanted) {
        if (residue.count > most_matched) return;
        const BondedAtoms given = find_bonded_atoms(structure_, residue);
        const BondedAtoms all = find_bonded_atoms(wanted);
        if (given.names.size() > all.names.size()) return;
        const auto match = match_by_bonds(given, all);
        if (!match) return;
        std::size_t atom = 0, renamed = 0;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(structure_, i) == "H") continue;
            std::string& name = structure_.names[i].atom;
            const std::string& charmm = all.names[(*match)[atom++]];
            if (name == charmm) continue;
            name = charmm;
            ++renamed;
        }
        by_bonds_[structure_.names[residue.first].residue] += renamed;
    }

    TextPlace place(std::size_t atom) const { return {structure_.file, structure_.lines[atom], 0}; }

    std::optional<std::string_view> find_alias(const ResidueRange& residue, std::string_view name,
                                               const WantedAtoms& wanted) const {
        for (const auto& [from, to] : aliases) {
            const bool fits = from == name && wanted.has(to) && !find_atom(structure_, residue, to);
            if (fits) return to;
        }
        return std::nullopt;
    }

    void rename_heavy_atom(const ResidueRange& residue, std::size_t atom,
                           const WantedAtoms& wanted) {
        std::string& name = structure_.names[atom].atom;
        if (residue.count == 1 && wanted.elements.size() == 1) {
            name = wanted.elements.begin()->first;
            return;
        }
        if (const auto to = find_alias(residue, name, wanted)) {
            ++renamed_[fmt::format("{} {} is CHARMM's {}", structure_.names[atom].residue, name,
                                   *to)];
            name = *to;
            return;
        }
        // The end of a chain that is closed in another way.
        if (name == "OXT") {
            kept_[atom] = false;
            report_.add(names_heading, fmt::format("{}: left out OXT, which its end does not have",
                                                   residue_label(structure_, residue)));
            return;
        }
        std::vector<std::string_view> names;
        for (const auto& entry : wanted.elements) names.emplace_back(entry.first);
        missing_.add(place(atom), fmt::format("{} has an atom '{}' that is not in its topology{}; "
                                              "expected atom names of CHARMM or the PDB",
                                              residue_label(structure_, residue), name,
                                              near_name_hint(name, names)));
    }

    // Side chains can be built; the backbone, and molecules that are no chain, cannot.
    void check_heavy_atoms(const ResidueRange& residue, const WantedAtoms& wanted) {
        std::vector<std::string> lacking;
        std::size_t heavy = 0;
        for (const auto& [name, element] : wanted.elements) {
            if (element == "H") continue;
            ++heavy;
            if (!find_atom(structure_, residue, name)) lacking.push_back(name);
        }
        const bool is_amino_acid = wanted.has("N") && wanted.has("CA") && wanted.has("C");
        if (is_amino_acid) ++backbones_;
        if (lacking.empty()) return;
        const std::string label = residue_label(structure_, residue);
        const bool is_nucleotide = wanted.has("C1'") && wanted.has("C3'") && wanted.has("C4'") &&
                                   find_atom(structure_, residue, "C1'") &&
                                   find_atom(structure_, residue, "C4'");
        // Ends of a molecule can be built: tails of lipids, the oxygen at a sugar's C1.
        const bool is_mostly_there = 3 * lacking.size() <= heavy;
        if (!is_amino_acid && (is_nucleotide || is_mostly_there)) {
            report_.add("Heavy atoms built", fmt::format("{}: {}", label, fmt::join(lacking, " ")));
            return;
        }
        if (!is_amino_acid) {
            const AtomName& name = structure_.names[residue.first];
            Fragment& fragment =
                fragments_[fmt::format("{} of its {} heavy atoms ({} missing)",
                                       heavy - lacking.size(), heavy, join_some(lacking, " "))];
            fragment.place = place(residue.first);
            fragment.residue = name.residue;
            fragment.where.push_back(
                fmt::format("{}:{}", chain_of(structure_, residue.first), name.number));
            return;
        }
        const auto lacks = [&](std::string_view name) {
            return std::find(lacking.begin(), lacking.end(), name) != lacking.end();
        };
        if (lacks("N") || lacks("CA") || lacks("C")) {
            if (lacks("N") && lacks("C") && !lacks("CA")) ++alpha_carbons_;
            missing_.add(
                place(residue.first),
                fmt::format("{}: the backbone atoms {} are missing; expected N, CA and C, "
                            "or --without {}:{}",
                            label, join_some(lacking, " "), chain_of(structure_, residue.first),
                            structure_.names[residue.first].number));
            return;
        }
        report_.add("Heavy atoms built", fmt::format("{}: {}", label, fmt::join(lacking, " ")));
    }

    void refuse_fragments() {
        for (const auto& [what, fragment] : fragments_) {
            const bool are_several = fragment.where.size() > 1;
            missing_.add(fragment.place,
                         fmt::format("{} {} {} {}, too few to build the rest{}; expected complete "
                                     "coordinates, or --without {}",
                                     fragment.residue, fmt::join(fragment.where, " and "),
                                     are_several ? "have each" : "has", what,
                                     are_several ? ", and halves on an axis of symmetry cannot be "
                                                   "joined"
                                                 : "",
                                     fragment.residue));
        }
    }

    void name_hydrogens(const ResidueRange& residue, const WantedAtoms& wanted) {
        std::set<std::size_t> placed;
        for (std::size_t heavy = residue.first; heavy < residue.end(); ++heavy) {
            if (element_of(structure_, heavy) == "H") continue;
            const std::vector<std::size_t> given = hydrogens_on(structure_, residue, heavy);
            placed.insert(given.begin(), given.end());
            if (!given.empty()) name_group(residue, heavy, given, wanted);
        }
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(structure_, i) != "H" || placed.contains(i)) continue;
            kept_[i] = false;
            report_.warn(fmt::format(
                "{} {} is more than 1.5 Å from every atom of its residue, so it was built anew",
                residue_label(structure_, residue), structure_.names[i].atom));
        }
    }

    // The hydrogens on one atom.
    void name_group(const ResidueRange& residue, std::size_t heavy,
                    const std::vector<std::size_t>& given, const WantedAtoms& wanted) {
        std::vector<std::string> names;
        const std::string& parent = structure_.names[heavy].atom;
        for (const auto& [a, b] : wanted.bonds) {
            const std::string& other = a == parent ? b : a;
            if (a != parent && b != parent) continue;
            const auto found = wanted.elements.find(other);
            if (found != wanted.elements.end() && found->second == "H") names.push_back(other);
        }
        std::sort(names.begin(), names.end());
        names.erase(std::unique(names.begin(), names.end()), names.end());
        const bool is_exact = std::all_of(given.begin(), given.end(), [&](std::size_t atom) {
            return std::binary_search(names.begin(), names.end(), structure_.names[atom].atom);
        });
        if (is_exact) return;
        std::vector<std::size_t> order = given;
        for (std::size_t i = names.size(); i < order.size(); ++i) {
            kept_[order[i]] = false;
            dropped_.push_back(fmt::format("{} {}", residue_label(structure_, residue),
                                           structure_.names[order[i]].atom));
        }
        order.resize(std::min(order.size(), names.size()));
        find_best_order(residue, wanted, names, order);
        renamed_hydrogens_ += order.size();
    }

    // Of all orders of the hydrogens, the one whose dihedral angles are the template's.
    void find_best_order(const ResidueRange& residue, const WantedAtoms& wanted,
                         const std::vector<std::string>& names, std::vector<std::size_t> order) {
        std::sort(order.begin(), order.end());
        std::vector<std::size_t> best = order;
        double least = std::numeric_limits<double>::infinity();
        do {
            for (std::size_t i = 0; i < order.size(); ++i) {
                structure_.names[order[i]].atom = names[i];
            }
            const double deviation = find_deviation(residue, wanted, names);
            if (deviation < least - 1e-9) {
                least = deviation;
                best = order;
            }
        } while (std::next_permutation(order.begin(), order.end()));
        for (std::size_t i = 0; i < best.size(); ++i) structure_.names[best[i]].atom = names[i];
    }

    // From the IC lines that name one of these hydrogens and are wholly there: the sum of the
    // squared differences, rad^2.
    double find_deviation(const ResidueRange& residue, const WantedAtoms& wanted,
                          const std::vector<std::string>& names) const {
        double sum = 0;
        for (std::size_t i = 0; i < wanted.dihedrals.size(); ++i) {
            const auto& atoms = wanted.dihedral_atoms[i];
            const bool concerns = std::any_of(atoms.begin(), atoms.end(), [&](const auto& atom) {
                return std::binary_search(names.begin(), names.end(), atom);
            });
            if (!concerns) continue;
            std::array<std::size_t, 4> at{};
            bool is_there = true;
            for (std::size_t j = 0; j < 4; ++j) {
                const auto found = find_atom(structure_, residue, atoms[j]);
                is_there = is_there && found.has_value();
                at[j] = found.value_or(0);
            }
            if (!is_there) continue;
            const auto& x = structure_.positions;
            const double angle = evaluate_torsion(x[at[0]], x[at[1]], x[at[2]], x[at[3]]).angle;
            const double difference = std::remainder(angle - wanted.dihedrals[i], 2 * pi);
            sum += difference * difference;
        }
        return sum;
    }

    void tell() {
        for (const auto& [what, count] : renamed_) {
            report_.add(names_heading,
                        fmt::format("{} ({} atom{})", what, count, count == 1 ? "" : "s"));
        }
        for (const auto& [residue, count] : by_bonds_) {
            if (count == 0) continue;
            report_.add(names_heading, fmt::format("{}: {} atom{} named by elements and bonds",
                                                   residue, count, count == 1 ? "" : "s"));
        }
        if (renamed_hydrogens_ > 0) {
            report_.add(names_heading,
                        fmt::format("{} hydrogens named after the atom that they are bonded to",
                                    renamed_hydrogens_));
        }
        if (!dropped_.empty()) {
            report_.warn(
                fmt::format("left out hydrogens that the chosen protonation does not have: {}",
                            join_some(dropped_, " ")));
        }
        if (corrected_elements_ > 0) {
            report_.warn(
                fmt::format("{} atoms have an element that contradicts their name; the name was "
                            "used. Check the element columns of the file",
                            corrected_elements_));
        }
    }

    Structure structure_;
    Report& report_;
    const WantedAtomsFinder templates_;
    const std::vector<ResidueRange> residues_;
    std::vector<bool> kept_;
    Missing missing_;
    // Molecules that are no chain and not whole, by what they lack.
    struct Fragment {
        TextPlace place;
        std::string residue;
        std::vector<std::string> where;
    };
    std::map<std::string, Fragment> fragments_;
    std::map<std::string, std::size_t> renamed_, by_bonds_;
    std::vector<std::string> dropped_;
    std::size_t renamed_hydrogens_ = 0, corrected_elements_ = 0;
    std::size_t backbones_ = 0, alpha_carbons_ = 0;
};

}  // namespace

Structure name_atoms(const ForceField& force_field, const Structure& structure,
                     const GenerateSettings& settings, Report& report) {
    return AtomNamer(force_field, structure, settings, report).name();
}

}  // namespace palpa
