#include "field/pair_kernel.h"

#include "core/assertion.h"
#include "field/cluster_sums.h"
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

bool has_kernel(const PairScheme& scheme) noexcept {
    switch (scheme.electrostatics) {
        case ElectrostaticCutoff::None:
            return scheme.van_der_waals == VanDerWaalsCutoff::None;
        case ElectrostaticCutoff::ForceSwitch:
            return scheme.van_der_waals == VanDerWaalsCutoff::ForceSwitch &&
                   !scheme.distance_dielectric;
        case ElectrostaticCutoff::CubicShift:
            return scheme.van_der_waals == VanDerWaalsCutoff::SmoothSwitch;
        default:
            return false;
    }
}

PairWorkspace build_pair_workspace(const ClusterList& list, const PairParameters& parameters,
                                   PairWorkspace storage) {
    PairWorkspace workspace = std::move(storage);
    workspace.atoms.assign(list.clusters() + 1, {});
    workspace.origin = find_cluster_origin(list);
    for (std::size_t p = 0; p < list.atoms.size(); ++p) {
        ClusterAtoms& atoms = workspace.atoms[p / cluster_size];
        const std::size_t k = p % cluster_size;
        const std::uint32_t atom = list.atoms[p];
        if (atom == no_atom) {
            place_filler(p, atoms);  // without charge and well
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
    PALPA_ASSERT(has_kernel(scheme));
    PALPA_ASSERT(!is_outdated(list, positions) && forces.size() == positions.size());
    const bool fits = place_in_clusters(list, positions, workspace.origin, workspace.atoms);
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
    add_cluster_forces(list, workspace.forces, threads.count, forces);
    sum.is_sound = true;
    return sum;
}

}  // namespace palpa
