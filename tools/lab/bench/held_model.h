// A model of molecules in which only joints move.
#pragma once
#include "assembly/joints.h"
#include "molecule/connectivity.h"
#include "statics/torsion_model.h"

#include <span>

namespace palpa {

// All molecules connected by the bonds, each fixed at the base that build_bodies gives it.
// Positions in Å. Throws LoadError as build_joints and build_assembly_tree do.
TorsionModel build_held_model(const Connectivity& connectivity, const Topology& topology,
                              std::span<const Vec3> positions, const JointRules& rules = {});

}  // namespace palpa
