#include "forces/fast_nonbonded.h"

#include "core/assertion.h"

#include <cmath>

namespace palpa {
namespace {

bool is_combined(const LennardJonesTable& table, std::uint32_t a, std::uint32_t b) noexcept {
    const LennardJonesPair& own_a = table.row(a)[a];
    const LennardJonesPair& own_b = table.row(b)[b];
    const LennardJonesPair& pair = table.row(a)[b];
    constexpr double rounding = 1e-12;
    const double epsilon = std::sqrt(own_a.epsilon * own_b.epsilon);
    const double rmin = 0.5 * (own_a.rmin + own_b.rmin);
    return std::abs(pair.epsilon - epsilon) <= rounding * epsilon &&
           (epsilon == 0 || std::abs(pair.rmin - rmin) <= rounding * rmin);
}

// The pairs of atoms of types that do not combine, without the excluded ones.
void add_replaced_pairs(const Topology& topology, FastAtoms& atoms) {
    const LennardJonesTable& table = topology.lennard_jones;
    std::vector<std::vector<std::uint32_t>> atoms_of_type(table.types);
    for (std::uint32_t i = 0; i < topology.size(); ++i)
        atoms_of_type[topology.type[i]].push_back(i);
    const auto add = [&](std::uint32_t a, std::uint32_t b) {
        const auto excluded = topology.exclusions.of(std::min(a, b));
        if (!std::binary_search(excluded.begin(), excluded.end(), std::max(a, b)))
            atoms.left_out.push_back({std::min(a, b), std::max(a, b)});
    };
    for (std::uint32_t s = 0; s < table.types; ++s) {
        if (atoms_of_type[s].empty()) continue;
        for (std::uint32_t t = s; t < table.types; ++t) {
            if (is_combined(table, s, t)) continue;
            for (const std::uint32_t a : atoms_of_type[s]) {
                for (const std::uint32_t b : atoms_of_type[t]) {
                    if (s != t || a < b) add(a, b);
                }
            }
        }
    }
}

void update_list(const Topology& topology, const FastAtoms& atoms,
                 const NonbondedSettings& settings, double skin, std::span<const Vec3> positions,
                 FastPairs& pairs) {
    const bool ends = has_end(settings);
    if (pairs.builds > 0 && !is_outdated(pairs.list, positions)) return;
    pairs.list = ends ? build_cluster_list(positions, atoms.left_out, settings.cutoff, skin,
                                           std::move(pairs.list))
                      : build_full_cluster_list(topology.size(), atoms.left_out, atoms.groups);
    pairs.workspace =
        build_pair_workspace(pairs.list, {topology.charge, atoms.sqrt_epsilon, atoms.half_rmin},
                             std::move(pairs.workspace));
    ++pairs.builds;
}

}  // namespace

FastAtoms build_fast_atoms(const Topology& topology) {
    FastAtoms atoms;
    for (const std::uint32_t type : topology.type) {
        const LennardJonesPair& own = topology.lennard_jones.row(type)[type];
        atoms.sqrt_epsilon.push_back(std::sqrt(own.epsilon));
        atoms.half_rmin.push_back(0.5 * own.rmin);
    }
    for (std::uint32_t i = 0; i < topology.size(); ++i) {
        for (const std::uint32_t j : topology.exclusions.of(i)) atoms.left_out.push_back({i, j});
    }
    atoms.first_replaced = atoms.left_out.size();
    add_replaced_pairs(topology, atoms);
    return atoms;
}

NonbondedEnergy add_fast_nonbonded_forces(const Topology& topology, const FastAtoms& atoms,
                                          const NonbondedSettings& settings, double skin,
                                          std::span<const Vec3> positions, FastPairs& pairs,
                                          std::span<Vec3> forces, PairResult result,
                                          const PairThreads& threads) {
    PALPA_ASSERT(!find_problem(settings));
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    // In single precision too little would be left of its energy between m and c.
    if (settings.distance_dielectric &&
        settings.electrostatics == ElectrostaticCutoff::ForceSwitch) {
        if (threads.beside) threads.beside();
        return add_nonbonded_forces(topology, settings, positions, forces);
    }
    update_list(topology, atoms, settings, skin, positions, pairs);
    const PairScheme scheme{settings.coulomb_constant / settings.dielectric,
                            settings.distance_dielectric,
                            settings.electrostatics,
                            settings.van_der_waals,
                            settings.switch_from,
                            settings.cutoff};
    const PairKernelSum sum = add_cluster_pair_forces(pairs.list, scheme, positions,
                                                      pairs.workspace, forces, result, threads);
    if (!sum.is_sound) {
        // The same pairs, so that energies can be compared with those of other positions.
        if (atoms.groups.empty())
            return add_nonbonded_forces(topology, settings, positions, forces);
        std::vector<std::array<std::uint32_t, 2>> all = list_pairs(pairs.list);
        all.insert(all.end(), atoms.replaced().begin(), atoms.replaced().end());
        return add_pair_forces(topology, settings, all, positions, forces);
    }
    const NonbondedEnergy replaced =
        add_pair_forces(topology, settings, atoms.replaced(), positions, forces);
    if (result == PairResult::Forces) return {};
    return {sum.van_der_waals + replaced.van_der_waals, sum.electrostatic + replaced.electrostatic};
}

}  // namespace palpa
