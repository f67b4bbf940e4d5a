// Relaxes mobile joints and bases on CHARMM forces.
#pragma once
#include "ecs/world.h"
#include "simulation/resources.h"
#include "simulation/systems/step_input.h"

#include <vector>

namespace palpa {

// Makes the solver's number of steps with the active joints and bases.
void relax(World& world, const StepInput& input);

// The same, for measurements outside of a step.
RelaxStepReport relax_mobile(World& world, const StepInput& input);

// Coordinates of mechanics and springs, which a failed step returns to.
struct MobileCoordinates {
    std::vector<double> angles;
    std::vector<Quat> turns;
    std::vector<Vec3> shifts;
    std::vector<ModelSpring> springs;
};

MobileCoordinates save_mobile(const World& world);
// Restores positions and forces as well.
void restore_mobile(const MobileCoordinates& saved, World& world);

}  // namespace palpa
