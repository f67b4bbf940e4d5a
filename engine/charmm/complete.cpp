#include "charmm/complete.h"

#include "charmm/missing.h"
#include "charmm/residue_checks.h"
#include "charmm/residue_instances.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

struct LackingAtom {
    std::string_view name, element;
    std::uint32_t like;  // an atom of its residue, the first
};

// What each residue lacks, by the last of its atoms that are there.
std::map<std::uint32_t, std::vector<LackingAtom>> find_lacking(const ForceField& force_field,
                                                               const ResidueInstances& residues) {
    struct Residue {
        std::set<std::string_view> known;
        std::uint32_t first, last;
    };
    std::vector<Residue> all;
    for (const ResidueInstance& instance : residues.instances) {
        Residue& residue = all.emplace_back(Residue{{}, instance.present.begin()->second, 0});
        for (const auto& [name, atom] : instance.present) {
            residue.known.insert(name);
            residue.first = std::min(residue.first, atom);
            residue.last = std::max(residue.last, atom);
        }
    }
    std::map<std::uint32_t, std::vector<LackingAtom>> lacking;
    // Templates, then patches: the order in which they are used.
    for (const TemplateUse& use : residues.uses) {
        for (const ResidueAtom& atom : use.residue->atoms) {
            // Only a patch's names can mean another residue.
            const AtomReference meant = use.patch.empty()
                                            ? AtomReference{use.instances[0], atom.name}
                                            : find_reference(residues, use, atom.name);
            const ResidueInstance& instance = residues.instances[meant.residue];
            const auto wanted = instance.wanted.find(meant.atom);
            if (wanted == instance.wanted.end()) continue;
            Residue& residue = all[meant.residue];
            if (!residue.known.insert(wanted->first).second) continue;
            const auto type = find_type(force_field, wanted->second->type);
            lacking[residue.last].push_back({wanted->first, type->second.element, residue.first});
        }
    }
    return lacking;
}

void add_given(const Structure& from, std::uint32_t atom, Structure& to) {
    to.names.push_back(from.names[atom]);
    to.positions.push_back(from.positions[atom]);
    to.lines.push_back(from.lines[atom]);
    if (!from.records.empty()) to.records.push_back(from.records[atom]);
}

void add_lacking(const Structure& from, const LackingAtom& atom, Structure& to) {
    add_given(from, atom.like, to);
    to.names.back().atom = atom.name;
    to.positions.back().setConstant(std::numeric_limits<double>::quiet_NaN());
    if (to.records.empty()) return;
    to.records.back().element = atom.element;
    to.records.back().element_guessed = false;
}

// All residues of a structure that is right, but for atoms that it may lack.
ResidueInstances build_residues(const ForceField& force_field, const Structure& structure,
                                const GenerateSettings& settings, bool may_lack) {
    Missing missing;
    ResidueInstances residues = build_residue_instances(force_field, structure, settings, missing);
    check_residues(force_field, structure, residues, may_lack, missing);
    missing.throw_if_any();
    return residues;
}

}  // namespace

CompletedStructure add_missing_atoms(const ForceField& force_field, const Structure& structure,
                                     const GenerateSettings& settings) {
    const ResidueInstances residues = build_residues(force_field, structure, settings, true);
    const auto lacking = find_lacking(force_field, residues);
    CompletedStructure result;
    result.structure.file = structure.file;
    result.structure.notes = structure.notes;
    auto end = structure.chain_ends.begin();
    for (std::uint32_t atom = 0; atom < structure.names.size(); ++atom) {
        add_given(structure, atom, result.structure);
        const auto behind = lacking.find(atom);
        if (behind != lacking.end()) {
            for (const LackingAtom& added : behind->second) {
                result.added.push_back(static_cast<std::uint32_t>(result.structure.names.size()));
                add_lacking(structure, added, result.structure);
            }
        }
        for (; end != structure.chain_ends.end() && *end <= atom + 1; ++end) {
            result.structure.chain_ends.push_back(result.structure.names.size());
        }
    }
    return result;
}

std::vector<AtomCoordinate> find_internal_coordinates(const ForceField& force_field,
                                                      const Structure& structure,
                                                      const GenerateSettings& settings) {
    constexpr double radian_per_degree = std::numbers::pi / 180;
    const ResidueInstances residues = build_residues(force_field, structure, settings, false);
    std::vector<AtomCoordinate> found;
    for (const bool is_patch : {true, false}) {
        for (const TemplateUse& use : residues.uses) {
            if (use.patch.empty() == is_patch) continue;
            for (const InternalCoordinate& line : use.residue->internal_coordinates) {
                const auto atoms = find_atoms(residues, use, line.atoms);
                if (!atoms) continue;
                found.push_back({*atoms, line.is_improper, line.first_bond,
                                 line.first_angle_deg * radian_per_degree,
                                 line.dihedral_deg * radian_per_degree,
                                 line.last_angle_deg * radian_per_degree, line.last_bond});
            }
        }
    }
    return found;
}

}  // namespace palpa
