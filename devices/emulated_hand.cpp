#include "devices/emulated_hand.h"

#include "devices/open_device.h"
#include "haptics/hand.h"

#include <algorithm>

namespace palpa {

EmulatedOmniSettings build_emulated_omni(const SceneDescription& scene, const HandScript& script,
                                         std::size_t slot) {
    const DeviceDescription& device = device_of(scene, slot);
    return {
        .dynamics = {device.inertia_kg, device.viscosity_N_s_per_m},
        .friction_newton = device.friction_N,
        .encoder_step_m = device.encoder_step_mm * 1e-3,
        .hand = hand_model(scene.hands.at(slot).grip),
        .script = script,
        .servo_delay_ticks = static_cast<int>(device.servo_delay_ticks),
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

MouseHandleSettings build_mouse(const EmulatedOmniSettings& omni, HandOrders* orders) {
    MouseHandleSettings settings = mouse_handle_of(omni.hand);
    settings.delay_ticks = omni.servo_delay_ticks;
    settings.orders = orders;
    return settings;
}

double mouse_reach_m(const EmulatedOmniSettings& settings) {
    const double stiffness = settings.hand ? settings.hand->stiffness_N_per_m : 0;
    return live_hand_newton / std::max(stiffness, 1.0);
}

}  // namespace palpa
