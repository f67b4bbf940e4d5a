#include "haptics/workspace.h"

#include <algorithm>

namespace palpa {
namespace {

// From 0 in the inner box to ±1 at the edge, axis by axis.
Vec3 relative_excess(const Vec3& handle_m, const Vec3& half_workspace_m, double inner) noexcept {
    Vec3 excess = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
        const double half = half_workspace_m(i);
        if (!(half > 0)) continue;
        const double place = std::clamp(handle_m(i) / half, -1.0, 1.0);
        excess(i) = (place - std::clamp(place, -inner, inner)) / (1 - inner);
    }
    return excess;
}

struct Travel {
    const Vec3 &handle_m, &moved_m, &half_workspace_m;
    double dt_s;

    Vec3 operator()(const ClutchMap& /*map*/) const noexcept { return Vec3::Zero(); }

    Vec3 operator()(const BubbleMap& map) const noexcept {
        const Vec3 excess = relative_excess(handle_m, half_workspace_m, map.fraction);
        const Vec3 outward = excess.cwiseProduct(half_workspace_m).normalized();
        const double share = std::min(excess.norm(), 1.0);  // a corner is no faster than a side
        return map.fastest_m_per_s * share * share * dt_s * outward;
    }

    Vec3 operator()(const DriftMap& map) const noexcept {
        return map.share * moved_m.norm() * relative_excess(handle_m, half_workspace_m, 0);
    }
};

}  // namespace

Vec3 extra_travel(const WorkspaceMap& map, const Vec3& handle_m, const Vec3& moved_m,
                  const Vec3& half_workspace_m, double dt_s) noexcept {
    Vec3 travel = std::visit(Travel{handle_m, moved_m, half_workspace_m, dt_s}, map);
    if (!handle_m.allFinite() || !travel.allFinite()) return Vec3::Zero();
    return travel;
}

}  // namespace palpa
