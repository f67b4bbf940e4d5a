// The mechanics of mobile molecules: joints that turn, bases that are free, springs.
#pragma once
#include "ecs/world.h"
#include "scene/description.h"
#include "simulation/plan_mechanics.h"
#include "simulation/resources.h"
#include "statics/relax_joints.h"
#include "statics/torsion_model.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace palpa {

// True if anything is mobile: joints that may turn, a base that is free or turns, something on a
// spring.
bool needs_mechanics(const World& world);

// Rebuilds the mechanics, or removes them, from the mobility of the molecules and what hands hold,
// at the present positions. Throws LoadError for joints of the scene that do not exist, and for
// molecules that a hand cannot hold; the world is unusable then.
void rebuild_mechanics(World& world);

// True if an atom has moved so far that it could soon interact with atoms outside of the region's
// mechanics (simulation/region.h).
bool has_left_region(const World& world) noexcept;

// Rebuilds the mechanics for the region around what hands hold now. If that region is too large,
// nothing changes.
void renew_region(World& world) noexcept;

// Called during relaxation; if it returns false, relaxation stops.
using RelaxProgressFunction = std::function<bool(const RelaxProgress&)>;

// Relaxes everything in a newly loaded world, including what hands hold, and builds the mechanics;
// StartReport has the result.
void relax_and_build_mechanics(World& world, const RelaxProgressFunction& on_relax = {});

// Relaxes everything mobile as the scene's statics say, with what hands hold where it is; the
// mechanics must then be rebuilt.
JointRelaxReport relax_around_hands(World& world);

// A world for measurements: a model at rest at its reference positions, moved as the scene's
// statics say, and one hand that moves a base or pulls at a spring from there; nothing else.
World build_mechanics_world(const SceneDescription& scene, TorsionModel model,
                            const HeldPart& held);

// Returns what the first hand holds.
HeldPart held_part(const World& world);

// For measurements outside of a step: the first hand moves what it holds.
void move_held(World& world, const Vec3& by);

}  // namespace palpa
