// Molecules as torsion bodies on a force field: all that never changes while they move.
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

// What the base of a molecule may do.
enum class BaseFreedom : std::uint8_t {
    Held,     // only as it is set: a fixed molecule, or one guided in all six
    Turning,  // turn about its pivot, whose place is set: guided by the hand
    Free,     // all six
};

struct MoleculeBase {
    BaseFreedom freedom = BaseFreedom::Free;
    // The atom about which a base turns that is not free; of a base body. A free base turns about
    // its molecule's centre of mass.
    std::uint32_t pivot = 0;
};

// A coordinate is a number of radian or Å: first one of each joint, in the order of bodies, then
// of each base that moves, in the order of molecules, three turns about the axes of the world
// through the pivot, and if it is free three displacements.
using Coordinates = Eigen::VectorXd;

struct TorsionModel {
    AssemblyTree tree;
    std::vector<double> masses;           // amu
    std::vector<double> molecule_masses;  // amu
    std::vector<Vec3> reference;          // Å, where all joints have the angle 0
    std::vector<Vec3> axes;               // of each body's joint there, of length 1; 0 for bases
    std::vector<MoleculeBase> bases;      // of each molecule

    // Atoms that may move: all, until fix_bases.
    std::vector<std::uint32_t> mobile_atoms;

    // All atoms and exclusions. Of bonded terms and pairs three bonds apart only those that change:
    // a term whose atoms all stay in one body has a constant energy and no force on any joint.
    Topology topology;
    FastForceField fast;

    // Where the coordinates of bodies and bases begin.
    std::vector<Eigen::Index> coordinate_of_body;  // -1 for bases
    std::vector<Eigen::Index> coordinate_of_base;  // -1 where it is held
    Eigen::Index coordinates = 0;                  // in all: degrees of freedom
};

// One mass, position and force-field atom per atom of the bodies, one base per molecule. Throws
// LoadError as build_assembly_tree does.
TorsionModel build_torsion_model(const TorsionBodies& bodies, std::vector<double> masses,
                                 std::vector<Vec3> positions, const Topology& topology,
                                 std::vector<MoleculeBase> bases);

// Of bases that are held (one entry per molecule: which of them nothing moves, no hand either) the
// atoms stay at the reference, and what they do to each other is constant: it is left out.
void fix_bases(const std::vector<std::uint8_t>& is_fixed, TorsionModel& model);

}  // namespace palpa
