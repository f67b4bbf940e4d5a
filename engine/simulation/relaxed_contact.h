// Contact stiffness if everything follows the hands by second order.
#pragma once
#include "ecs/world.h"
#include "haptics/local_field.h"
#include "math/spatial.h"
#include "math/vec.h"
#include "simulation/second_order.h"

#include <cstdint>
#include <optional>
#include <span>

namespace palpa {

// The relaxed stiffness at a hand from the linearised model, which must exist, bounded as below.
// Nothing for a hand that the model does not have.
std::optional<RelaxedStiffness> find_relaxed_stiffness(const World& world,
                                                       const SecondOrder& second, Entity hand);

// -d(force on what the hand holds)/d(position of what the other hand holds), N/m, with everything
// else following.
Mat3 find_relaxed_coupling(const World& world, const SecondOrder& second, Entity hand,
                           Entity other);

// How the held atoms and the environment of `field` follow the hand's displacement; nothing if the
// handle turns what it holds.
std::optional<FollowingAtoms> find_following(const World& world, const SecondOrder& second,
                                             Entity hand, const LocalField& field,
                                             std::span<const std::uint32_t> environment);

// Bounds the relaxed stiffness that the servo gets. At a snap it would go to minus infinity, and no
// device can render such a change of force. All matrices are symmetric. The result exceeds the
// frozen one in no direction and is nowhere below -`softest` (> 0).
Mat6 bound_stiffness(const Mat6& relaxed, const Mat6& frozen, double softest);
// Limits the change from the last matrix to `most` in every direction.
Mat6 limit_change(const Mat6& last, const Mat6& now, double most);

// The same between the servo's last stiffness and the next, one period later.
void limit_change(const RelaxedStiffness& last, double period_s, RelaxedStiffness& now);

}  // namespace palpa
