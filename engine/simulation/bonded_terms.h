// Bonded terms of all molecules of a world.
#pragma once
#include "ecs/world.h"
#include "simulation/resources.h"

namespace palpa {

// Reads or generates those not needed before. Throws LoadError, also if molecules are bonded to
// each other or share atoms.
const BondedTerms& bonded_terms(World& world);

}  // namespace palpa
