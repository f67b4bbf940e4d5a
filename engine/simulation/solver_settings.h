// How the mechanics of a world are solved, from the settings of its scene (MechanicsSettings).
#pragma once
#include "ecs/world.h"
#include "scene/description.h"
#include "simulation/plan_mechanics.h"
#include "simulation/resources.h"

#include <Eigen/Core>
#include <span>

namespace palpa {

RelaxSettings build_settings(const World& world);

// The method for so many coordinates; matrices of more than most_second_order_coordinates are too
// large. Throws LoadError where the scene asks for one that is impossible.
RelaxMethod find_method(const World& world, Eigen::Index coordinates);

// State of the paper's step with few active joints.
AdaptiveState build_adaptive(const RelaxSettings& settings, const TorsionModel& model,
                             std::span<const HeldPart> held, const World& world);

// The following functions need the world's model and its springs.

SecondOrder build_second_order(const StaticsDescription& statics, const RelaxSettings& settings,
                               const World& world);

// Compares with all pairs, whatever cutoff the steps have; the ends that go with a solvent are part
// of its energy.
ErrorEstimate build_error_estimate(const RelaxSettings& settings, Solvent solvent,
                                   const World& world);

}  // namespace palpa
