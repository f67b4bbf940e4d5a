// Who holds the handle: the emulated hand of a scene, a mouse, a second hand.
#pragma once
#include "devices/emulated_omni.h"
#include "scene/description.h"
#include "simulation/simulation.h"

#include <memory>
#include <optional>
#include <string>

namespace palpa {

// The emulated device and hand that a scene describes.
EmulatedOmniSettings build_emulated_omni(const SceneDescription& scene,
                                         const Simulation& simulation);

// Puts a person's mouse in place of the script, and how far ahead of the handle it may be.
void give_to_mouse(EmulatedOmniSettings& settings);
double mouse_reach_m(const EmulatedOmniSettings& settings);

// Of the hand that holds the other molecule; null where nobody does. An emulated one stands still.
// Throws LoadError where the device cannot be opened, or not in such a run.
std::unique_ptr<Device> open_second(const std::optional<std::string>& name, bool headless,
                                    EmulatedOmniSettings emulated);

}  // namespace palpa
