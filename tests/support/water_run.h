// A headless run of the water scene with settings, as `palpa run` does it.
#pragma once
#include "devices/emulated_omni.h"
#include "session/plan_hand.h"
#include "session/run_headless.h"
#include "simulation/simulation.h"
#include "tests/support/water_scene.h"
#include "tools/hands.h"

#include <string>
#include <vector>

namespace palpa::test {

inline Summary run_water(const std::vector<std::string>& settings) {
    const SceneDescription scene = water_scene(settings);
    Simulation simulation = load_simulation(scene);
    const EmulatedOmniSettings device_settings = build_emulated_omni(scene, simulation);
    EmulatedOmni device(device_settings);
    return run_headless(scene, simulation, device,
                        list_warnings(scene, simulation, device_settings.script), nullptr, {});
}

}  // namespace palpa::test
