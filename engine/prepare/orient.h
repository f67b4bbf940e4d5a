// Turns what heavy-atom coordinates leave open to where its energy is lowest: hydroxyls, thiols,
// ammonium groups, waters, and, if asked, amides and imidazoles that a map cannot tell apart.
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
    bool may_flip = true;      // heavy atoms of amides and imidazoles
    double flip_gain = 2;      // kcal/mol, what a flip must bring at least
    bool has_methyls = false;  // XH3 of carbon turn as well
    double switch_from = 8;    // Å; of Lennard-Jones
    double cutoff = 10;        // Å
    int sweep_limit = 12;
};

// The energy that counts, as `add_forces` takes it: CHARMM's FSHIFT and VSWITCH.
NonbondedSettings nonbonded_settings(const OrientSettings& settings) noexcept;

struct OrientedGroup {
    enum class Kind {
        Rotor,      // one heavy neighbour; all else hydrogens
        Water,      // no heavy neighbour, several hydrogens
        Amide,      // -C(=O)-NH2, turned by half a turn about the bond to its carbon
        Imidazole,  // of one substituent, on a carbon beside a nitrogen; likewise
    };
    Kind kind;
    // The heavy atom whose hydrogens turn; of amides and imidazoles, the carbon on the axis.
    std::uint32_t atom;
    double dihedral_before = 0;  // rad, of a moved atom; 0 of waters, and where there is none
    double dihedral_after = 0;
    double energy_before = 0;  // kcal/mol, of all that changes as the group moves, in the
    double energy_after = 0;   // surroundings of the time
    bool is_flipped = false;   // the heavy atoms in `moved` are not where they were given
    // kcal/mol, what a flip brings, its surroundings turned to fit; 0 where it was not tried.
    double flip_gain = 0;
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
// energy in the surroundings of the moment (Lennard-Jones, Coulomb, dihedrals, impropers). Then
// flips are tried, each with the groups around it turned to fit, and kept where they gain enough.
// No lowest energy of all groups together is looked for, nor of two flips at once. All positions
// must be finite. The same input gives the same bits.
OrientReport orient_groups(const Connectivity& connectivity, const Topology& topology,
                           std::span<const std::uint32_t> built, const OrientSettings& settings,
                           std::span<Vec3> positions);

}  // namespace palpa
