#include "charmm/used_parameters.h"

#include "charmm/find_parameters.h"

#include <set>
#include <string>

namespace palpa {
namespace {

// The types of some atoms, by name.
template <std::size_t Size>
Types<Size> types_of(const std::vector<std::string>& names,
                     const std::array<std::uint32_t, Size>& atoms) {
    Types<Size> types;
    for (std::size_t i = 0; i < Size; ++i) types[i] = names[atoms[i]];
    return types;
}

// The entries that some tuples of atoms find.
template <class Value, class Tuples, class Find>
std::set<const Value*> find_used(const ForceField& force_field,
                                 const std::vector<std::string>& names, const Tuples& tuples,
                                 const Find& find) {
    std::set<decltype(types_of(names, tuples.front()))> seen;
    std::set<const Value*> used;
    for (const auto& atoms : tuples) {
        const auto types = types_of(names, atoms);
        if (seen.insert(types).second) used.insert(find(force_field, types));
    }
    return used;
}

template <class Map, class Value>
Map keep(const Map& map, const std::set<const Value*>& used) {
    Map kept;
    for (const auto& entry : map) {
        if (used.contains(&entry.second)) kept.insert(entry);
    }
    return kept;
}

}  // namespace

ForceField keep_used_parameters(const ForceField& force_field, const Connectivity& connectivity) {
    ForceField kept;
    kept.files = force_field.files;
    std::vector<std::string> names;  // types of atoms, which files may call by number
    for (const std::string& called : connectivity.type) {
        const auto type = find_type(force_field, called);
        names.push_back(type == force_field.types.end() ? called : type->first);
        if (type == force_field.types.end()) continue;
        kept.types.insert(*type);
        const auto nonbonded = force_field.nonbonded.find(type->first);
        if (nonbonded != force_field.nonbonded.end()) kept.nonbonded.insert(*nonbonded);
    }
    using Terms = std::vector<DihedralTerm>;
    kept.bonds = keep(force_field.bonds, find_used<HarmonicParameter>(
                                             force_field, names, connectivity.bonds, find_bond));
    kept.angles =
        keep(force_field.angles,
             find_used<AngleParameter>(force_field, names, connectivity.angles, find_angle));
    kept.dihedrals =
        keep(force_field.dihedrals,
             find_used<Terms>(force_field, names, connectivity.dihedrals, find_dihedral));
    kept.impropers =
        keep(force_field.impropers,
             find_used<Terms>(force_field, names, connectivity.impropers, find_improper));
    kept.cmaps = keep(force_field.cmaps,
                      find_used<CmapParameter>(force_field, names, connectivity.cmaps, find_cmap));
    for (const auto& [types, pair] : force_field.nbfix) {
        if (kept.types.contains(types.first) && kept.types.contains(types.second)) {
            kept.nbfix.emplace(types, pair);
        }
    }
    return kept;
}

ForceField keep_named_residues(const ForceField& force_field, std::span<const AtomName> names) {
    ForceField kept;
    kept.files = force_field.files;
    kept.types = force_field.types;
    for (const AtomName& name : names) {
        const auto found = force_field.residues.find(name.residue);
        if (found != force_field.residues.end()) kept.residues.insert(*found);
    }
    kept.patches = force_field.patches;
    kept.generates_angles = force_field.generates_angles;
    kept.generates_dihedrals = force_field.generates_dihedrals;
    kept.nonbonded = force_field.nonbonded;
    kept.bonds = force_field.bonds;
    kept.angles = force_field.angles;
    kept.dihedrals = force_field.dihedrals;
    kept.impropers = force_field.impropers;
    kept.cmaps = force_field.cmaps;
    kept.nbfix = force_field.nbfix;
    kept.about = force_field.about;
    return kept;
}

}  // namespace palpa
