// Finds the molecules of a system, and which of them are equal.
#pragma once
#include "charmm/topology.h"
#include "inputs/run_system.h"
#include "molecule/atoms.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// The molecule of each atom: atoms with bonds or other terms between them belong together.
// Molecules are numbered by their first atoms.
std::vector<std::uint32_t> find_molecules(const Topology& topology);

// The molecules of a system in the order of `in_run_order`.
std::vector<AtomRange> list_molecules(const Topology& topology);

// The terms of one molecule; atoms are numbered from its first.
struct MoleculeTerms {
    AtomRange atoms;
    std::vector<Bond> bonds;
    std::vector<Angle> angles;
    std::vector<UreyBradley> urey_bradleys;
    std::vector<Dihedral> dihedrals;
    std::vector<Improper> impropers;
    std::vector<CmapTerm> cmap_terms;
    std::vector<std::array<std::uint32_t, 2>> pairs14;
};
std::vector<MoleculeTerms> split_molecules(const Topology& topology);

// Whether an atom is hydrogen, by its mass.
bool is_hydrogen(double mass) noexcept;

// A water: an oxygen, then two hydrogens bonded to it.
struct RigidWater {
    double oh, hh;  // equilibrium distances, Å
};
std::optional<RigidWater> find_rigid_water(const RunSystem& system, const MoleculeTerms& molecule);

// A name for each atom type of the topology, as it stands in the connectivity, in letters that
// engines read as a name.
std::vector<std::string> name_types(const RunSystem& system);

// The five atoms of a cross-term that engines know: both dihedrals share three bonds. Throws
// LoadError of one that does not.
std::array<std::uint32_t, 5> five_atoms(const RunSystem& system, const CmapTerm& term,
                                        std::uint32_t first = 0);

// The pairs of atom types whose numbers are not those that CHARMM's rules combine, a <= b.
std::vector<std::array<std::uint32_t, 2>> find_uncombined(const LennardJonesTable& table);

}  // namespace palpa
