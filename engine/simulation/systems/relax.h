// Mobile joints and bases go towards rest on CHARMM forces.
#pragma once
#include "ecs/world.h"
#include "simulation/resources.h"
#include "simulation/systems/step_input.h"

#include <vector>

namespace palpa {

// As many steps as the solver says, of the joints and bases that are active.
void relax(World& world, const StepInput& input);

// The same for measurements outside of a step.
RelaxStepReport relax_mobile(World& world, const StepInput& input);

// Where mechanics and springs are: what a step that fails goes back to.
struct MobileCoordinates {
    std::vector<double> angles;
    std::vector<Quat> turns;
    std::vector<Vec3> shifts;
    std::vector<Spring> springs;
};

MobileCoordinates save_mobile(const World& world);
// Positions and forces too.
void restore_mobile(const MobileCoordinates& saved, World& world);

}  // namespace palpa
