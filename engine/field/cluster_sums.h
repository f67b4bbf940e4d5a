// Helpers of the kernels that sum over a cluster list.
#pragma once
#include "field/cluster_list.h"
#include "field/grid.h"
#include "field/pair_kernel.h"
#include "math/vec.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace palpa {

// The centre of the atoms at the last build of the list; zero if it is not finite.
inline Vec3 find_cluster_origin(const ClusterList& list) noexcept {
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    for (std::size_t i = 0; i < list.positions.size(); ++i) {
        const Vec3& place = list.positions[i];
        low = i == 0 ? place : low.cwiseMin(place);
        high = i == 0 ? place : high.cwiseMax(place);
    }
    const Vec3 origin = 0.5 * (low + high);
    return origin.allFinite() ? origin : Vec3::Zero();
}

// Moves the empty place p of a list far from all atoms and from other empty places.
template <class Atoms>
void place_filler(std::size_t p, Atoms& atoms) noexcept {
    for (auto& column : atoms.high)
        column[p % cluster_size] = 4e4F + 16 * static_cast<float>(p % (2 * cluster_size));
}

// Whether all atoms are near enough to the origin.
template <class Atoms>
bool place_in_clusters(const ClusterList& list, std::span<const Vec3> positions, const Vec3& origin,
                       std::vector<Atoms>& clusters) noexcept {
    bool fits = true;
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        Atoms& atoms = clusters[c];
        for (std::size_t k = 0; k < cluster_size; ++k) {
            const std::uint32_t atom = list.atoms[c * cluster_size + k];
            if (atom == no_atom) continue;
            const Vec3 place = positions[atom] - origin;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double x = place(static_cast<Eigen::Index>(axis));
                fits = fits & (std::abs(x) < farthest_single_precision);
                const double high = rounded_to_grid(x);
                atoms.high[axis][k] = static_cast<float>(high);
                atoms.low[axis][k] = static_cast<float>(x - high);
            }
        }
    }
    return fits;
}

// The first cluster of a thread's share: all tiles and what the first thread does besides, in equal
// parts.
inline std::size_t first_cluster(const ClusterList& list, const PairThreads& threads,
                                 std::size_t thread) noexcept {
    if (thread == 0) return 0;
    if (thread == threads.count) return list.clusters();
    const auto tiles_before = [&](std::size_t c) {
        return list.first_plain[c] + list.first_masked[c];
    };
    const std::size_t besides = threads.beside_tiles;
    const std::size_t before = (tiles_before(list.clusters()) + besides) * thread / threads.count;
    const std::size_t wanted = before - std::min(before, besides);
    std::size_t low = 0, high = list.clusters();
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (tiles_before(middle) < wanted) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

inline void add_cluster_forces(const ClusterList& list,
                               std::span<const std::vector<ClusterForces>> of_threads,
                               std::size_t threads, std::span<Vec3> forces) noexcept {
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        for (std::size_t k = 0; k < cluster_size; ++k) {
            const std::uint32_t atom = list.atoms[c * cluster_size + k];
            if (atom == no_atom) continue;
            for (std::size_t t = 0; t < threads; ++t) {
                const auto& on = of_threads[t][c].on;
                forces[atom] += Vec3(on[0][k], on[1][k], on[2][k]);
            }
        }
    }
}

}  // namespace palpa
