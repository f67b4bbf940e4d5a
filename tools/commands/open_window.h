// A scene in a window: with the device, the sound and the scene file that a person chooses.
#pragma once
#include "devices/emulated_omni.h"
#include "ecs/world.h"
#include "scene/description.h"
#include "tools/commands/run.h"

namespace palpa {

// What can be said of the options before anything is loaded. Throws LoadError.
void check_window_options(const RunOptions& options);

// Returns the exit code. Throws LoadError, PlatformError, GpuError.
int open_window(const SceneDescription& scene, const World& world, EmulatedOmniSettings settings,
                const RunOptions& options);

}  // namespace palpa
