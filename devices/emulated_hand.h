// Builds the emulated device that a scene describes, and the hand on its handle.
#pragma once
#include "devices/emulated_omni.h"
#include "devices/mouse_handle.h"
#include "scene/description.h"

#include <cstddef>

namespace palpa {

// Settings of the emulated device and of hand number `slot` (0: the first) of the scene. `script`:
// the movements of that hand.
EmulatedOmniSettings build_emulated_omni(const SceneDescription& scene, const HandScript& script,
                                         std::size_t slot = 0);

// Replaces the script by a person's mouse, and limits how far the target may be ahead of the
// handle.
void give_to_mouse(EmulatedOmniSettings& settings);
double mouse_reach_m(const EmulatedOmniSettings& settings);

// A mouse in the place of this device, in the same hand. `orders`: targets from a window, may be
// null.
MouseHandleSettings build_mouse(const EmulatedOmniSettings& omni, HandOrders* orders);

}  // namespace palpa
