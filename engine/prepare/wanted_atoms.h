// The atoms and bonds that a residue with its patches should have.
#pragma once
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "molecule/atoms.h"
#include "prepare/match_by_bonds.h"

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpa {

// The required atoms of a residue with its patches.
struct WantedAtoms {
    std::map<std::string, std::string, std::less<>> elements;  // element of each atom
    std::vector<std::array<std::string, 2>> bonds;             // within the residue
    std::vector<std::array<std::string, 4>> dihedral_atoms;    // dihedrals of the IC table
    std::vector<double> dihedrals;                             // rad

    bool has(std::string_view name) const { return elements.contains(name); }
};

// Its heavy atoms, with the bonds among them.
BondedAtoms find_bonded_atoms(const WantedAtoms& wanted);

// Both must outlive it.
class WantedAtomsFinder {
public:
    WantedAtomsFinder(const ForceField& force_field, const GenerateSettings& settings);

    // `is_first`, `is_last`: of its segment, whose ends have patches.
    WantedAtoms find(const AtomName& name, bool is_first, bool is_last) const;

private:
    void apply(const std::string& patch, std::size_t place, WantedAtoms& wanted) const;
    void add(const Residue& residue, std::optional<std::size_t> place, WantedAtoms& wanted) const;

    const ForceField& force_field_;
    std::map<std::string, const SegmentSettings*> segments_;
    std::map<std::pair<std::string, std::string>, std::vector<std::pair<std::string, std::size_t>>>
        uses_;
};

}  // namespace palpa
