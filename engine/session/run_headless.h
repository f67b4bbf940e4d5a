// A whole scene without a window: loaded, felt by a device in lockstep, summed up, recorded.
#pragma once
#include "haptics/device.h"
#include "haptics/servo.h"
#include "scene/description.h"
#include "session/recording.h"
#include "session/statistics.h"
#include "simulation/simulation.h"

#include <functional>

namespace palpa {

// Share of the run that is done, 0 to 1; called about ten times a simulated second.
using ProgressFunction = std::function<void(double share)>;

ServoSettings build_servo_settings(const SceneDescription& scene, const Simulation& simulation);

// In words, what about the scene's settings makes trouble: the stiffness felt where it is largest
// along the line, K = A_f k_e / A_d, against what damping allows, B/(1.5 T_s).
std::vector<std::string> find_warnings(const SceneDescription& scene, const Simulation& simulation);

// `recording` and `progress` may be null or empty. The simulation ends where the run leaves it.
Summary run_headless(const SceneDescription& scene, Simulation& simulation, Device& device,
                     Recording* recording, const ProgressFunction& progress);

}  // namespace palpa
