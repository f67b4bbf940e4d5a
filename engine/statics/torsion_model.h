// Molecules as torsion bodies with a force field: everything that is constant while they move.
#pragma once
#include "assembly/tree.h"
#include "charmm/topology.h"
#include "forces/force_field.h"
#include "math/vec.h"

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpa {

// The freedom of the base of a molecule.
enum class BaseFreedom : std::uint8_t {
    Held,     // no freedom: a fixed molecule, or one guided in all six
    Turning,  // turns about its pivot, whose position the hand sets
    Free,     // all six degrees of freedom
};

struct MoleculeBase {
    BaseFreedom freedom = BaseFreedom::Free;
    // The atom of the base body about which a base turns that is not free. A free base turns about
    // its molecule's centre of mass.
    std::uint32_t pivot = 0;
};

// Coordinates in rad or Å: first one for each joint, in the order of bodies; then for each base
// that moves, in the order of molecules, three rotations about the axes of the world through the
// pivot, and, if it is free, three displacements.
using Coordinates = Eigen::VectorXd;

struct TorsionModel {
    AssemblyTree tree;
    std::vector<double> masses;           // amu
    std::vector<double> molecule_masses;  // amu
    std::vector<Vec3> reference;          // Å, positions with all joint angles 0
    std::vector<Vec3> axes;               // unit axis of each body's joint there; 0 for bases
    std::vector<MoleculeBase> bases;      // of each molecule

    // Atoms that may move: all of them until fix_bases is called.
    std::vector<std::uint32_t> mobile_atoms;

    // All atoms and exclusions, but only those bonded terms and 1-4 pairs that can change: a term
    // whose atoms all lie in one body has a constant energy and exerts no force on any joint.
    Topology topology;
    FastForceField fast;

    // Index of the first coordinate of bodies and bases.
    std::vector<Eigen::Index> coordinate_of_body;  // -1 for bases
    std::vector<Eigen::Index> coordinate_of_base;  // -1 if it is held
    Eigen::Index coordinates = 0;                  // total number: degrees of freedom
};

// One mass, position and force-field atom per atom of the bodies, one base per molecule. Throws
// LoadError as build_assembly_tree does.
TorsionModel build_torsion_model(const TorsionBodies& bodies, std::vector<double> masses,
                                 std::vector<Vec3> positions, const Topology& topology,
                                 std::vector<MoleculeBase> bases);

// Fixes bases for good (one entry per molecule: true if nothing, not even a hand, moves the base).
// Their atoms stay at the reference, and their constant interactions with each other are left out.
void fix_bases(const std::vector<std::uint8_t>& is_fixed, TorsionModel& model);

}  // namespace palpa
