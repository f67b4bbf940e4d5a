// Cases of CHARMM's own files: the force field files of PALPA_DATA, and structures to type with
// them.
#pragma once
#include "charmm/force_field.h"
#include "molecule/atoms.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpa::test {

ForceField read_charmm(const std::filesystem::path& folder, const std::vector<std::string>& names);

struct TypedAtom {
    std::string type;
    double charge;
};

// The atoms of CASE.ff.json as CHARMM calls them, at the origin, and what they should become. Files
// from GROMACS number residues anew where a chain begins and call some atoms otherwise.
struct NativeAtoms {
    Structure structure;
    std::vector<TypedAtom> typed;
};

NativeAtoms read_native_atoms(const std::filesystem::path& path);

}  // namespace palpa::test
