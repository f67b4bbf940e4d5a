// The state of a running scene, and how it is made.
#pragma once
#include "ecs/entity.h"
#include "ecs/world.h"
#include "field/pair_field.h"
#include "haptics/gains.h"
#include "math/vec.h"
#include "molecule/atoms.h"
#include "scene/description.h"

#include <vector>

namespace palpa {

// Owned by one thread. The grabbed molecule's atoms stand first in the table, all others, its
// environment, behind them.
struct Simulation {
    explicit Simulation(CouplingLaws coupling_laws) : laws(coupling_laws) {}

    // written on loading
    CouplingLaws laws;
    double coulomb_constant = 0;      // kcal Å/mol/e^2
    double period_s = 0;              // declared
    std::vector<Vec3> grabbed_shape;  // Å, the grabbed molecule's atoms from its reference atom
    Entity hand;                      // has a Grab

    // written by every step
    World world;
    AtomTable atoms;  // positions only
};

// The laws that a scene's mode asks for.
CouplingLaws build_coupling_laws(const CouplingDescription& coupling);

// Reads everything the scene names and puts the grabbed molecule at its start. Throws LoadError
// with the place of what is wrong.
Simulation load_simulation(const SceneDescription& scene);

// The grabbed molecule and all other atoms, as the pair kernel wants them.
FieldPoints grabbed_points(const Simulation& simulation) noexcept;
FieldPoints environment_points(const Simulation& simulation) noexcept;

}  // namespace palpa
