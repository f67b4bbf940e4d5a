// Builds the emulated device of a scene with the hand that plays its stroke.
#pragma once
#include "devices/emulated_hand.h"
#include "ecs/world.h"

namespace palpa {

// Device and hand as the scene describes them, with the path of the hand planned
// (session/plan_hand.h). `slot` 0 is the first hand. Throws LoadError.
EmulatedOmniSettings build_emulated_omni(const SceneDescription& scene, const World& world,
                                         std::size_t slot = 0);

}  // namespace palpa
