// A headless run of a scene, or of water with settings, as `palpa run` does it.
#pragma once
#include "devices/emulated_omni.h"
#include "loading/load.h"
#include "session/plan_hand.h"
#include "session/run_headless.h"
#include "tests/support/emulated_hand.h"
#include "tests/support/water_scene.h"

#include <string>
#include <vector>

namespace palpa::test {

inline Summary run_scene(const SceneDescription& scene) {
    World world = load_world(scene);
    const EmulatedOmniSettings device_settings = build_played_omni(scene, world);
    EmulatedOmni device(device_settings);
    return run_headless(scene, world, device, list_warnings(scene, world, device_settings.script),
                        nullptr, {});
}

inline Summary run_water(const std::vector<std::string>& settings) {
    return run_scene(water_scene(settings));
}

}  // namespace palpa::test
