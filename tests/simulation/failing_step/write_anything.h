#pragma once
#include "ecs/world.h"
#include "simulation/systems/step_input.h"

#include <random>
#include <vector>

namespace palpa {

// A component of entities of no molecule and no hand.
struct Tag {
    int number = 0;
    std::vector<double> values;
};

// A resource: does write_anything act, and does the step fail then?
struct Scribbler {
    std::mt19937 random;
    bool is_active = true;
};

// Writes components and resources at random, creates and destroys entities, and makes the step
// fail.
void write_anything(World& world, const StepInput& input);

}  // namespace palpa
