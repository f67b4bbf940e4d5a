// Orients hydroxyls, thiols, ammonium groups and waters to low energy; heavy-atom coordinates do
// not determine them.
#pragma once
#include "charmm/topology.h"
#include "forces/nonbonded.h"
#include "math/vec.h"
#include "molecule/connectivity.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

struct OrientSettings {
    bool has_methyls = false;  // methyl groups turn too
    double switch_from = 8;    // start of the Lennard-Jones switch, Å
    double cutoff = 10;        // Å
    int sweep_limit = 12;
};

// The settings of the energy, for `add_forces`: CHARMM's FSHIFT and VSWITCH.
NonbondedSettings nonbonded_settings(const OrientSettings& settings) noexcept;

struct OrientedGroup {
    enum class Kind {
        Rotor,  // one heavy neighbour, otherwise hydrogens
        Water,  // no heavy neighbour, several hydrogens
    };
    Kind kind;
    std::uint32_t atom;  // the heavy atom whose hydrogens turn
    double dihedral_before =
        0;  // dihedral of a moved atom, rad; 0 for waters, and if there is none
    double dihedral_after = 0;
    double energy_before = 0;  // kcal/mol, of all terms that change with the group, in its
    double energy_after = 0;   // surroundings of the time
    std::vector<std::uint32_t> moved;
};

struct OrientReport {
    std::vector<OrientedGroup> groups;  // sorted by kind, then by atom
    double energy_change = 0;           // change of the total energy, kcal/mol; never above 0
    int sweeps = 0;
    bool is_settled = true;  // false: stopped at the limit of sweeps
};

// Only groups all of whose hydrogens are in `built` move. They are found by their bonds, not by
// names, and turned one after the other in a fixed order, until nothing changes: rotors over a grid
// of 10 degree and then finer, waters over a set of rotations and then finer, each to the least
// energy in the surroundings of the moment (Lennard-Jones, Coulomb, dihedrals, impropers). No
// lowest energy of all groups together is looked for. All positions must be finite. The same input
// gives the same bits.
OrientReport orient_groups(const Connectivity& connectivity, const Topology& topology,
                           std::span<const std::uint32_t> built, const OrientSettings& settings,
                           std::span<Vec3> positions);

}  // namespace palpa
