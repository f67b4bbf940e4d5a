// Maps a small workspace onto a large scene: travel in addition to that of the handle. SI units.
#pragma once
#include "math/vec.h"

#include <variant>

namespace palpa {

// No additional travel: the hand uses the clutch.
struct ClutchMap {};

// Place inside a box around the centre, rate outside (L. Dominjon, A. Lécuyer et al., World Haptics
// 2005, there a sphere): the molecule goes on along the way from the box to the handle, with the
// square of its length. The box is not felt.
struct BubbleMap {
    double fraction = 0.6;           // share of the half workspace, from 0 to below 1
    double fastest_m_per_s = 0.100;  // handle travel at the edge of the workspace
};

// Drift to the centre (F. Conti, O. Khatib, World Haptics 2005): while the hand moves, the molecule
// goes outward by a share of the way. A hand that guides it by sight comes back to the centre
// unaware, by e^-1 over `half workspace/share` of its way; a hand at rest is left alone.
struct DriftMap {
    double share = 0.15;  // share of the travel at the edge of the workspace; below 1/sqrt(3)
};

using WorkspaceMap = std::variant<ClutchMap, BubbleMap, DriftMap>;

// Handle travel (m) to add in a tick of `dt_s` to the `moved_m` that the handle moved in it, before
// A_d divides them. `handle_m` counts from the centre of the workspace. An axis without a workspace
// takes no part, a handle beyond the edge counts as at the edge, and what is not finite moves
// nothing. Encoder steps to and fro are way too: drift wants a filtered handle.
Vec3 extra_travel(const WorkspaceMap& map, const Vec3& handle_m, const Vec3& moved_m,
                  const Vec3& half_workspace_m, double dt_s) noexcept;

}  // namespace palpa
