// A headless run of the water scene with settings, as `palpa run` does it.
#pragma once
#include "devices/emulated_omni.h"
#include "session/plan_hand.h"
#include "session/run_headless.h"
#include "simulation/simulation.h"
#include "tests/support/water_scene.h"
#include "tools/run.h"

#include <string>
#include <vector>

namespace palpa::test {

inline Summary run_water(const std::vector<std::string>& settings) {
    const SceneDescription scene = water_scene(settings);
    Simulation simulation = load_simulation(scene);
    EmulatedOmni device(build_emulated_omni(scene, simulation));
    return run_headless(scene, simulation, device, nullptr, {});
}

}  // namespace palpa::test
