// Turns a scene's stroke into a path for the emulated hand.
#pragma once
#include "ecs/world.h"
#include "haptics/hand.h"
#include "scene/description.h"

#include <cstddef>
#include <vector>

namespace palpa {

// For "in-out" the path is as long as the laws at rest say it must be to reach the scene's peak
// force: the integral of A_d over the molecule's way, and how far force bends the hand. Delays and
// strides add to that, so a run reaches the peak only about. Throws LoadError where no distance has
// that force. `half_width_m`: half of the device's workspace along x.
// `slot`: of the hand, 0 the first.
HandScript plan_hand(const SceneDescription& scene, const World& world, double half_width_m,
                     std::size_t slot = 0);

// What a hand leads, Å, as a script has it, m.
std::vector<HandWaypoint> plan_lead(const std::vector<PathPoint>& path);

}  // namespace palpa
