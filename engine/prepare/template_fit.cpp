#include "prepare/template_fit.h"

#include "prepare/match_by_bonds.h"

#include <algorithm>
#include <cstddef>

namespace palpa {
namespace {

bool is_of_chain(const Residue& residue) {
    return std::ranges::any_of(
        residue.bonds, [](const auto& bond) { return bond[0][0] == '+' || bond[1][0] == '+'; });
}

// The template has an atom of that name and element.
bool has_named(const ForceField& force_field, const Residue& wanted, const std::string& name,
               const std::string& element) {
    const auto found = std::ranges::find(wanted.atoms, name, &ResidueAtom::name);
    return found != wanted.atoms.end() && element_of(force_field, *found, name) == element;
}

}  // namespace

bool is_template_of(const ForceField& force_field, const std::string& name,
                    const Structure& structure, const ResidueRange& residue, bool is_vouched) {
    const Residue& wanted = force_field.residues.at(name);
    constexpr std::size_t largest_water = 3;  // atoms
    if (is_of_chain(wanted) || wanted.atoms.size() <= largest_water) return true;
    if (residue.count == 1) return false;
    std::size_t heavy = 0, named = 0;
    for (std::size_t i = residue.first; i < residue.end(); ++i) {
        const std::string element = element_of(structure, i);
        if (element == "H") continue;
        ++heavy;
        if (has_named(force_field, wanted, structure.names[i].atom, element)) ++named;
    }
    const BondedAtoms all = find_bonded_atoms(force_field, wanted);
    if (heavy > all.names.size()) return false;
    if (heavy == named && (is_vouched || heavy == all.names.size())) return true;
    return match_by_bonds(find_bonded_atoms(structure, residue), all).has_value();
}

bool has_elements_of(const ForceField& force_field, const std::string& name,
                     const Structure& structure, const ResidueRange& residue) {
    const auto& atoms = force_field.residues.at(name).atoms;
    return std::ranges::all_of(atoms, [&](const ResidueAtom& atom) {
        const std::string element = element_of(force_field, atom, atom.name);
        if (element == "H") return true;
        for (std::size_t i = residue.first; i < residue.end(); ++i) {
            if (element_of(structure, i) == element) return true;
        }
        return false;
    });
}

}  // namespace palpa
