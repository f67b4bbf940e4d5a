// What the best choice of joints could do: how stiff the hand finds a molecule at rest when all its
// joints come to rest, none, or the few that matter most.
#pragma once
#include "simulation/flexible.h"

#include <cstddef>
#include <span>
#include <vector>

namespace palpa {

// Of small moves of the hand in one direction, each followed by coming to rest.
struct HandResponse {
    // kcal/mol/Å^2: change of the force on the hand per Å that it went.
    Vec3 rigid, relaxed;  // nothing, everything came to rest
    // Of each count asked for: how far from `relaxed` that many coordinates leave it, relative.
    std::vector<double> errors;
};

// From second derivatives of the energy, differences of forces of a state at rest with all joints
// active. Coordinates are chosen one by one, each the one that lowers the energy most beside those
// before it, knowing all derivatives: nearly the best that any choice can do, and far too slow for
// one. `counts` rise; those beyond the coordinates there are leave no error.
HandResponse find_hand_response(Flexible& at_rest, const Vec3& direction,
                                std::span<const std::size_t> counts);

}  // namespace palpa
