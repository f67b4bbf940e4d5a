// The emulated device as a scene describes it, and who holds its handle: a script, a mouse.
#pragma once
#include "devices/emulated_omni.h"
#include "scene/description.h"

#include <cstddef>

namespace palpa {

// The emulated device and hand that a scene describes; `slot` 0 is the first. `script`: of that
// hand.
EmulatedOmniSettings build_emulated_omni(const SceneDescription& scene, const HandScript& script,
                                         std::size_t slot = 0);

// Puts a person's mouse in place of the script, and how far ahead of the handle it may be.
void give_to_mouse(EmulatedOmniSettings& settings);
double mouse_reach_m(const EmulatedOmniSettings& settings);

}  // namespace palpa
