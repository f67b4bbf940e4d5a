#include "experiments/emulated_hand.h"

#include "session/plan_hand.h"

namespace palpa {

EmulatedOmniSettings build_emulated_omni(const SceneDescription& scene, const World& world,
                                         std::size_t slot) {
    return build_emulated_omni(scene, plan_hand(scene, world, omni_half_workspace_m.x(), slot),
                               slot);
}

}  // namespace palpa
