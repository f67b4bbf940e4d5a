// Builds the coupling laws between hand and molecule from a scene.
#pragma once
#include "ecs/world.h"
#include "haptics/gains.h"
#include "scene/description.h"

namespace palpa {

struct Coupling;

// The laws for the scene's mode.
CouplingLaws build_coupling_laws(const CouplingDescription& coupling);

// False if no such laws exist: eq. 2 cannot be calibrated to every combination of numbers.
bool can_build_laws(const CouplingDescription& coupling);

// The resource of a world with this coupling.
Coupling build_coupling(const CouplingDescription& coupling);

// Sets the coupling of a world and renews all contact models.
void set_coupling(const CouplingDescription& coupling, World& world);

}  // namespace palpa
