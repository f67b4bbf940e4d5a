#include "field/solvation_kernel.h"

#include "core/assertion.h"
#include "field/cluster_sums.h"
#include "field/solvation_job.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <thread>
#include <utility>

namespace palpa {

SolvationWorkspace build_solvation_workspace(const ClusterList& list,
                                             const SolvationParameters& parameters,
                                             SolvationWorkspace storage) {
    SolvationWorkspace workspace = std::move(storage);
    workspace.atoms.assign(list.clusters() + 1, {});
    workspace.origin = find_cluster_origin(list);
    const double root = std::sqrt(std::numbers::log2e);
    for (std::size_t p = 0; p < list.atoms.size(); ++p) {
        SolvationCluster& atoms = workspace.atoms[p / cluster_size];
        const std::size_t k = p % cluster_size;
        const std::uint32_t atom = list.atoms[p];
        if (atom == no_atom) {
            place_filler(p, atoms);  // without volume
            continue;
        }
        const double scale = root * parameters.inverse_lambda[atom];
        atoms.volume[k] = static_cast<float>(parameters.volume[atom]);
        atoms.strength[k] = static_cast<float>(parameters.strength[atom]);
        atoms.scale[k] = static_cast<float>(scale);
        atoms.offset[k] = static_cast<float>(scale * parameters.radius[atom]);
    }
    return workspace;
}

SolvationKernelSum add_cluster_solvation_forces(const ClusterList& list, double begin, double end,
                                                std::span<const Vec3> positions,
                                                SolvationWorkspace& workspace,
                                                std::span<Vec3> forces,
                                                const PairThreads& threads) {
    PALPA_ASSERT(threads.count > 0 && workspace.atoms.size() == list.clusters() + 1);
    PALPA_ASSERT(begin < end && end <= list.cutoff && forces.size() == positions.size());
    PALPA_ASSERT(!is_outdated(list, positions));
    const bool fits = place_in_clusters(list, positions, workspace.origin, workspace.atoms);
    std::vector<SolvationJobSum> sums(threads.count);
    if (workspace.forces.size() < threads.count) workspace.forces.resize(threads.count);
    const auto run = [&](std::size_t t) {
        if (!fits) return;
        workspace.forces[t].assign(list.clusters() + 1, {});
        sums[t] = run_solvation_job({&list, workspace.atoms.data(), workspace.forces[t].data(),
                                     first_cluster(list, threads, t),
                                     first_cluster(list, threads, t + 1), begin, end});
    };
    {
        std::vector<std::jthread> helpers;
        for (std::size_t t = 1; t < threads.count; ++t) helpers.emplace_back([&run, t] { run(t); });
        if (threads.beside) threads.beside();
        run(0);
    }
    SolvationKernelSum sum;
    float nearest2 = std::numeric_limits<float>::infinity();
    for (const SolvationJobSum& part : sums) {
        sum.energy += part.energy;
        nearest2 = std::min(nearest2, part.nearest2);
    }
    constexpr double nearest = nearest_single_precision;
    if (!fits || !(nearest2 > nearest * nearest)) return {};
    add_cluster_forces(list, workspace.forces, threads.count, forces);
    sum.is_sound = true;
    return sum;
}

}  // namespace palpa
