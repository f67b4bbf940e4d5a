#include "charmm/type_structure.h"

#include "charmm/generate.h"
#include "core/load_error.h"
#include "molecule/alternatives.h"
#include "molecule/element.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace palpa {
namespace {

bool is_hydrogen(std::string_view atom, std::string_view residue) {
    const std::string element = find_element_of_name(atom, residue);
    return element == "H" || element == "D";
}

// One line instead of all the atoms that a structure without hydrogens would lack.
void refuse_without_hydrogens(const ForceField& force_field, const Structure& structure) {
    const auto& names = structure.names;
    if (std::any_of(names.begin(), names.end(),
                    [](const AtomName& name) { return is_hydrogen(name.atom, name.residue); })) {
        return;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto residue = force_field.residues.find(names[i].residue);
        if (residue == force_field.residues.end()) continue;
        const auto& atoms = residue->second.atoms;
        if (std::none_of(atoms.begin(), atoms.end(), [&](const ResidueAtom& atom) {
                return is_hydrogen(atom.name, names[i].residue);
            })) {
            continue;
        }
        throw LoadError({structure.file, structure.lines[i], 0},
                        fmt::format("the structure has no hydrogens, but {} has some in {}; "
                                    "expected all atoms (palpa prepare adds them)",
                                    names[i].residue, residue->second.place.file));
    }
}

}  // namespace

Connectivity type_structure(const ForceField& force_field, const Structure& structure) {
    refuse_alternatives(structure);
    refuse_without_hydrogens(force_field, structure);
    return build_connectivity(force_field, structure);
}

}  // namespace palpa
