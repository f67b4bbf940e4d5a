#include "field/pair_kernel.h"

#include "core/assertion.h"
#include "field/grid.h"
#include "field/pair_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <thread>
#include <utility>

namespace palpa {
namespace {

// Whether all are near enough to the origin.
bool place_atoms(const ClusterList& list, std::span<const Vec3> positions,
                 PairWorkspace& workspace) noexcept {
    bool fits = true;
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        ClusterAtoms& atoms = workspace.atoms[c];
        for (std::size_t k = 0; k < cluster_size; ++k) {
            const std::uint32_t atom = list.atoms[c * cluster_size + k];
            if (atom == no_atom) continue;
            const Vec3 place = positions[atom] - workspace.origin;
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
std::size_t first_cluster(const ClusterList& list, const PairThreads& threads,
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

void add_cluster_forces(const ClusterList& list, const PairWorkspace& workspace,
                        std::size_t threads, std::span<Vec3> forces) noexcept {
    for (std::size_t c = 0; c < list.clusters(); ++c) {
        for (std::size_t k = 0; k < cluster_size; ++k) {
            const std::uint32_t atom = list.atoms[c * cluster_size + k];
            if (atom == no_atom) continue;
            for (std::size_t t = 0; t < threads; ++t) {
                const auto& on = workspace.forces[t][c].on;
                forces[atom] += Vec3(on[0][k], on[1][k], on[2][k]);
            }
        }
    }
}

}  // namespace

PairWorkspace build_pair_workspace(const ClusterList& list, const PairParameters& parameters,
                                   PairWorkspace storage) {
    PairWorkspace workspace = std::move(storage);
    workspace.atoms.assign(list.clusters() + 1, {});
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    for (std::size_t i = 0; i < list.positions.size(); ++i) {
        const Vec3& place = list.positions[i];
        low = i == 0 ? place : low.cwiseMin(place);
        high = i == 0 ? place : high.cwiseMax(place);
    }
    workspace.origin = 0.5 * (low + high);
    if (!workspace.origin.allFinite()) workspace.origin = Vec3::Zero();
    for (std::size_t p = 0; p < list.atoms.size(); ++p) {
        ClusterAtoms& atoms = workspace.atoms[p / cluster_size];
        const std::size_t k = p % cluster_size;
        const std::uint32_t atom = list.atoms[p];
        if (atom == no_atom) {
            // Far from all atoms and from each other; without charge and well.
            for (auto& high_column : atoms.high)
                high_column[k] = 4e4F + 16 * static_cast<float>(p % (2 * cluster_size));
            continue;
        }
        atoms.charge[k] = static_cast<float>(parameters.charge[atom]);
        atoms.sqrt_epsilon[k] = static_cast<float>(parameters.sqrt_epsilon[atom]);
        atoms.half_rmin[k] = static_cast<float>(parameters.half_rmin[atom]);
    }
    return workspace;
}

PairKernelSum add_cluster_pair_forces(const ClusterList& list, const PairScheme& scheme,
                                      std::span<const Vec3> positions, PairWorkspace& workspace,
                                      std::span<Vec3> forces, PairResult result,
                                      const PairThreads& threads) {
    PALPA_ASSERT(threads.count > 0 && workspace.atoms.size() == list.clusters() + 1);
    PALPA_ASSERT(!scheme.distance_dielectric ||
                 (scheme.electrostatics != ElectrostaticCutoff::ForceShift &&
                  scheme.electrostatics != ElectrostaticCutoff::ForceSwitch));
    PALPA_ASSERT((scheme.electrostatics == ElectrostaticCutoff::CubicShift) ==
                 (scheme.van_der_waals == VanDerWaalsCutoff::SmoothSwitch));
    PALPA_ASSERT(!is_outdated(list, positions) && forces.size() == positions.size());
    const bool fits = place_atoms(list, positions, workspace);
    std::vector<JobSum> sums(threads.count);
    if (workspace.forces.size() < threads.count) workspace.forces.resize(threads.count);
    const auto run = [&](std::size_t t) {
        if (!fits) return;
        workspace.forces[t].assign(list.clusters() + 1, {});
        sums[t] =
            run_pair_job({&list, &scheme, workspace.atoms.data(), workspace.forces[t].data(),
                          first_cluster(list, threads, t), first_cluster(list, threads, t + 1),
                          result == PairResult::ForcesAndEnergies});
    };
    {
        std::vector<std::jthread> helpers;
        for (std::size_t t = 1; t < threads.count; ++t) helpers.emplace_back([&run, t] { run(t); });
        if (threads.beside) threads.beside();
        run(0);
    }
    PairKernelSum sum;
    float nearest2 = std::numeric_limits<float>::infinity();
    for (const JobSum& part : sums) {
        sum.van_der_waals += part.van_der_waals;
        sum.electrostatic += part.electrostatic;
        nearest2 = std::min(nearest2, part.nearest2);
    }
    constexpr double nearest = nearest_single_precision;
    if (!fits || !(nearest2 > nearest * nearest)) return {};
    add_cluster_forces(list, workspace, threads.count, forces);
    sum.is_sound = true;
    return sum;
}

}  // namespace palpa
