// A scene in a window: with the device, the sound and the scene file that a person chooses.
#pragma once
#include "devices/emulated_omni.h"
#include "scene/description.h"
#include "simulation/simulation.h"
#include "tools/run.h"

namespace palpa {

// What can be said of the options before anything is loaded. Throws LoadError.
void check_window_options(const RunOptions& options);

// `as_read`: the scene before `scene` was fitted to the hands, for saving. Returns the exit code.
// Throws LoadError, PlatformError, GpuError.
int open_window(const SceneDescription& scene, const SceneDescription& as_read,
                const Simulation& simulation, EmulatedOmniSettings settings,
                const RunOptions& options);

}  // namespace palpa
