// What a scene says of the coupling between hand and molecule, as laws.
#pragma once
#include "ecs/world.h"
#include "haptics/gains.h"
#include "scene/description.h"

namespace palpa {

// The laws that a scene's mode asks for.
CouplingLaws build_coupling_laws(const CouplingDescription& coupling);

// Whether there are such laws: eq. 2 cannot be calibrated to any numbers.
bool can_build_laws(const CouplingDescription& coupling);

// Makes the scene's coupling that of a world, and all contact models anew.
void set_coupling(const CouplingDescription& coupling, World& world);

}  // namespace palpa
