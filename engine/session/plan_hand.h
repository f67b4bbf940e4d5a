// Turns a scene's stroke into a path for the emulated hand.
#pragma once
#include "haptics/hand.h"
#include "scene/description.h"
#include "simulation/simulation.h"

namespace palpa {

// For "in-out" the path is as long as the laws at rest say it must be to reach the scene's peak
// force: the integral of A_d over the molecule's way, and how far force bends the hand. Delays and
// strides add to that, so a run reaches the peak only about. Throws LoadError where no distance has
// that force. `half_width_m`: half of the device's workspace along x.
HandScript plan_hand(const SceneDescription& scene, const Simulation& simulation,
                     double half_width_m);

}  // namespace palpa
