// What hands feel where everything follows them by second order.
#pragma once
#include "ecs/world.h"
#include "haptics/local_field.h"
#include "math/spatial.h"
#include "math/vec.h"

#include <cstdint>
#include <optional>
#include <span>

namespace palpa {

// Of a hand, as the newest linearised model has it, within the bounds below. Nothing where
// something else moves what is mobile.
std::optional<RelaxedStiffness> find_relaxed_stiffness(const World& world, Entity hand);

// -d(force on what the hand holds)/d(place of what the other hand holds) if everything else
// follows, N/m.
Mat3 find_relaxed_coupling(const World& world, Entity hand, Entity other);

// How the atoms that the hand holds and these others, the environment of `field`, follow its way;
// nothing where the handle turns what it holds, or as above.
std::optional<FollowingAtoms> find_following(const World& world, Entity hand,
                                             const LocalField& field,
                                             std::span<const std::uint32_t> environment);

// What the servo gets of a relaxed stiffness. Across a snap it runs to minus infinity, and no
// device plays a force that changes so. All symmetric.
//
// In no direction above the frozen one, and nowhere below -`softest` (> 0).
Mat6 bound_stiffness(const Mat6& relaxed, const Mat6& frozen, double softest);
// No farther than `most` from the last in any direction.
Mat6 limit_change(const Mat6& last, const Mat6& now, double most);

// The same of what the servo got last and is to get now, a period later.
void limit_change(const RelaxedStiffness& last, double period_s, RelaxedStiffness& now);

}  // namespace palpa
