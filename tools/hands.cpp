#include "tools/hands.h"

#include "core/load_error.h"
#include "devices/open_device.h"
#include "haptics/hand.h"
#include "session/plan_hand.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {

EmulatedOmniSettings build_emulated_omni(const SceneDescription& scene,
                                         const Simulation& simulation) {
    return {
        .dynamics = {scene.device.inertia_kg, scene.device.viscosity_N_s_per_m},
        .friction_newton = scene.device.friction_N,
        .encoder_step_m = scene.device.encoder_step_mm * 1e-3,
        .hand = hand_model(static_cast<Grip>(scene.hand.grip)),
        .script = plan_hand(scene, simulation, omni_half_workspace_m.x()),
    };
}

void give_to_mouse(EmulatedOmniSettings& settings) {
    settings.driver = HandDriver::Mouse;
    settings.script = {};
    // A mouse has no workspace: half a metre either way stands for that.
    settings.half_workspace_m = Vec3::Constant(0.5);
    // A person who sees the molecule lag overcomes the handle's friction; a mouse has none.
    settings.friction_newton = 0;
}

double mouse_reach_m(const EmulatedOmniSettings& settings) {
    const double stiffness = settings.hand ? settings.hand->stiffness_N_per_m : 0;
    return live_hand_newton / std::max(stiffness, 1.0);
}

std::unique_ptr<Device> open_second(const std::optional<std::string>& name, bool headless,
                                    EmulatedOmniSettings emulated) {
    if (!name) return nullptr;
    const DeviceMaker& maker = device_maker_called(*name);
    if (maker.needs_window || (headless && !maker.is_emulated)) {
        throw LoadError({fmt::format("--second {}", *name)},
                        maker.is_emulated || !headless
                            ? "is led by the window; expected it as --device"
                            : "is held by a person and needs the window; this run has none "
                              "(headless)");
    }
    emulated.script = {};
    return open_device(*name, {.emulated = emulated}).device;
}

}  // namespace palpa
