// Turns what heavy-atom coordinates leave open to where its energy is lowest: hydroxyls, thiols,
// ammonium groups, waters.
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
    bool has_methyls = false;  // XH3 of carbon turn as well
    double switch_from = 8;    // Å; of Lennard-Jones
    double cutoff = 10;        // Å
    int sweep_limit = 12;
};

// The energy that counts, as `add_forces` takes it: CHARMM's FSHIFT and VSWITCH.
NonbondedSettings nonbonded_settings(const OrientSettings& settings) noexcept;

struct OrientedGroup {
    enum class Kind {
        Rotor,  // one heavy neighbour; all else hydrogens
        Water,  // no heavy neighbour, several hydrogens
    };
    Kind kind;
    std::uint32_t atom;          // the heavy atom whose hydrogens turn
    double dihedral_before = 0;  // rad, of a moved atom; 0 of waters, and where there is none
    double dihedral_after = 0;
    double energy_before = 0;  // kcal/mol, of all that changes as the group moves, in the
    double energy_after = 0;   // surroundings of the time
    std::vector<std::uint32_t> moved;
};

struct OrientReport {
    std::vector<OrientedGroup> groups;  // by kind, then by atom
    double energy_change = 0;           // kcal/mol, of the whole structure; never above 0
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
