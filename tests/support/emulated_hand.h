// The emulated device of a scene in the hand that plays its stroke.
#pragma once
#include "devices/emulated_hand.h"
#include "session/plan_hand.h"

namespace palpa::test {

inline EmulatedOmniSettings build_played_omni(const SceneDescription& scene, const World& world,
                                              std::size_t slot = 0) {
    return build_emulated_omni(scene, plan_hand(scene, world, omni_half_workspace_m.x(), slot),
                               slot);
}

}  // namespace palpa::test
