// Turns a scene's stroke into a path of the emulated hand.
#pragma once
#include "ecs/world.h"
#include "haptics/hand.h"
#include "scene/description.h"

#include <cstddef>
#include <vector>

namespace palpa {

// For "in-out" the length of the path follows from statics, so that the scene's peak force is
// reached at rest: the integral of A_d over the molecule's way, plus the way by which the force
// bends the hand. Delays add to that, so that a run reaches the peak only approximately.
// `half_width_m`: half of the device's workspace along x. `slot`: index of the hand from 0.
// Throws LoadError if the force is reached at no distance.
HandScript plan_hand(const SceneDescription& scene, const World& world, double half_width_m,
                     std::size_t slot = 0);

// Converts a path of a molecule (Å) to the waypoints of a script (m).
std::vector<HandWaypoint> plan_lead(const std::vector<PathPoint>& path);

}  // namespace palpa
