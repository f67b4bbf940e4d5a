// Builds the coupling laws between hand and molecule from a scene.
#pragma once
#include "ecs/world.h"
#include "haptics/gains.h"
#include "scene/description.h"

#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct Coupling;

// The laws for the scene's mode.
CouplingLaws build_coupling_laws(const CouplingDescription& coupling);

// False if no such laws exist: eq. 2 cannot be calibrated to every combination of numbers.
bool can_build_laws(const CouplingDescription& coupling);

// The component of a hand with this coupling; `is_own`: the scene gives this hand a coupling of its
// own.
Coupling build_coupling(const CouplingDescription& coupling, bool is_own);

// Gives each hand the coupling that the scene has for it, and renews all contact models.
void set_couplings(const SceneDescription& scene, World& world);
// Changes the coupling of a hand by settings (scene/read_scene.h), with it that of all hands that
// share it, and renews all contact models. Throws LoadError for values that do not fit; then
// nothing has changed.
void change_coupling(const std::vector<std::string>& settings, Entity hand, World& world);
// Writes the couplings of the hands into the scene that they are from.
void keep_couplings(const World& world, SceneDescription& scene);

// The smallest error that a hand's coupling requires, pN; nothing if none does.
std::optional<double> find_tolerance(const World& world);

}  // namespace palpa
