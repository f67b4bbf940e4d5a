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
// The problem where no such laws exist, and the remedy.
inline constexpr const char* why_no_laws =
    "eq. 2 with these F_h1_N, F_h2_N and F_0_nN cannot have the slopes A_f_max at 0 and A_f_min at "
    "F_0; expected other values, or force_law = \"printed\"";

// The component of a hand with this coupling; `is_own`: the scene gives this hand a coupling of its
// own.
Coupling build_coupling(const CouplingDescription& coupling, bool is_own);

// Gives each hand the coupling that the scene has for it, and renews all contact models.
void set_couplings(const SceneDescription& scene, World& world);
// Changes the coupling of a hand by settings (scene/read_scene.h): its own, or the scene's, which
// all hands without their own share. Renews all contact models. Throws LoadError for values that do
// not fit; then nothing has changed.
void change_coupling(const std::vector<std::string>& settings, Entity hand, World& world);
// Writes the couplings of the hands into the scene that they are from.
void keep_couplings(const World& world, SceneDescription& scene);

// The smallest error that a hand's coupling requires, pN; nothing if none does.
std::optional<double> find_tolerance(const World& world);

}  // namespace palpa
