#include "forces/fast_nonbonded.h"

#include "core/assertion.h"
#include "field/select_tiles.h"
#include "field/solvation_law.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace palpa {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

// A large system has millions of pairs with replaced numbers, few of them near. A list leaves out
// those that are within `margin` of its reach, as long as no atom has gone half of that.
constexpr double margin = 6;  // Å

double reach_of(const NonbondedSettings& settings, double skin) {
    return has_end(settings) ? settings.cutoff + skin : infinity;
}

bool is_far(std::span<const Vec3> positions, const std::array<std::uint32_t, 2>& pair,
            double reach) {
    return (positions[pair[0]] - positions[pair[1]]).squaredNorm() >= reach * reach;
}

void update_left_out(const FastAtoms& atoms, double reach, std::span<const Vec3> positions,
                     FastPairs& pairs) {
    pairs.first_replaced = atoms.first_replaced;
    pairs.left_out.assign(
        atoms.left_out.begin(),
        atoms.left_out.begin() + static_cast<std::ptrdiff_t>(atoms.first_replaced));
    for (const auto& pair : atoms.replaced()) {
        if (!is_far(positions, pair, reach + margin)) pairs.left_out.push_back(pair);
    }
}

void update_replaced(double reach, std::span<const Vec3> positions, FastPairs& pairs) {
    pairs.replaced.clear();
    for (const auto& pair : std::span(pairs.left_out).subspan(pairs.first_replaced)) {
        if (!is_far(positions, pair, reach)) pairs.replaced.push_back(pair);
    }
}

bool are_within(std::span<const Vec3> positions, std::span<const Vec3> places, double most) {
    if (positions.size() != places.size()) return false;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!((positions[i] - places[i]).squaredNorm() <= most * most)) return false;
    }
    return true;
}

void build_list(const Topology& topology, const FastAtoms& atoms, const NonbondedSettings& settings,
                double skin, std::span<const Vec3> positions, FastPairs& pairs) {
    update_left_out(atoms, reach_of(settings, skin), positions, pairs);
    pairs.list = has_end(settings)
                     ? build_cluster_list(positions, pairs.left_out, settings.cutoff, skin,
                                          std::move(pairs.list))
                     : build_full_cluster_list(topology.size(), pairs.left_out, atoms.groups);
    pairs.positions.assign(positions.begin(), positions.end());
}

void update_list(const Topology& topology, const FastAtoms& atoms,
                 const NonbondedSettings& settings, double skin, std::span<const Vec3> positions,
                 FastPairs& pairs) {
    if (pairs.builds > 0 && !is_outdated(pairs.list, positions)) return;
    pairs.near.selected.clear();
    if (pairs.builds == 0 || !are_within(positions, pairs.positions, 0.5 * margin)) {
        build_list(topology, atoms, settings, skin, positions, pairs);
    } else if (update_cluster_list(positions, pairs.left_out, pairs.list) != ListChange::Clusters) {
        update_replaced(reach_of(settings, skin), positions, pairs);
        ++pairs.updates;
        return;
    }
    update_replaced(reach_of(settings, skin), positions, pairs);
    pairs.workspace =
        build_pair_workspace(pairs.list, {topology.charge, atoms.sqrt_epsilon, atoms.half_rmin},
                             std::move(pairs.workspace));
    ++pairs.builds;
}

// Whether `pairs.near` has all pairs, found anew where that pays: it takes as long as a sum of the
// whole list or two, and spares a quarter of each.
bool update_near(const Topology& topology, const FastAtoms& atoms,
                 const NonbondedSettings& settings, double skin, std::span<const Vec3> positions,
                 FastPairs& pairs) {
    constexpr double near_skin = 0.6;  // Å
    if (!has_end(settings) || skin <= near_skin) return false;
    const bool is_slow = are_within(positions, pairs.summed, near_skin / 8);
    pairs.summed.assign(positions.begin(), positions.end());
    FastPairs::NearTiles& near = pairs.near;
    if (are_within(positions, near.selected, 0.5 * near_skin)) return true;
    if (!is_slow) return false;
    near.tiles = select_tiles(pairs.list, {}, positions, near_skin);
    near.workspace =
        build_pair_workspace(near.tiles, {topology.charge, atoms.sqrt_epsilon, atoms.half_rmin},
                             std::move(near.workspace));
    near.workspace.origin = pairs.workspace.origin;
    near.selected.assign(positions.begin(), positions.end());
    return true;
}

// Without solvation.
NonbondedEnergy add_fast_pairs(const Topology& topology, const FastAtoms& atoms,
                               const NonbondedSettings& settings, double skin,
                               std::span<const Vec3> positions, FastPairs& pairs,
                               std::span<Vec3> forces, PairResult result,
                               const PairThreads& threads) {
    update_list(topology, atoms, settings, skin, positions, pairs);
    const bool is_near = update_near(topology, atoms, settings, skin, positions, pairs);
    const std::optional<NonbondedEnergy> energy =
        add_tile_forces(topology, settings, is_near ? pairs.near.tiles : pairs.list,
                        is_near ? pairs.near.workspace : pairs.workspace, pairs.replaced, positions,
                        forces, result, threads);
    if (energy) return *energy;
    ++pairs.in_double;
    if (atoms.groups.empty()) return add_nonbonded_forces(topology, settings, positions, forces);
    return add_pairs_in_double(topology, settings, pairs.list, pairs.replaced, positions, forces);
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
    atoms.solvation = build_fast_solvation_atoms(topology);
    return atoms;
}

PairScheme pair_scheme(const NonbondedSettings& settings) noexcept {
    const bool is_solvated = settings.solvation == SolvationEnd::Smooth;
    return {settings.coulomb_constant / settings.dielectric,
            settings.distance_dielectric,
            settings.electrostatics,
            settings.van_der_waals,
            settings.switch_from,
            settings.cutoff,
            is_solvated ? smooth_solvation_begin : 0,
            is_solvated ? smooth_solvation_end : 0};
}

bool has_fast_form(const NonbondedSettings& settings) noexcept {
    return settings.solvation != SolvationEnd::Sharp && has_kernel(pair_scheme(settings));
}

NonbondedEnergy add_fast_nonbonded_forces(const Topology& topology, const FastAtoms& atoms,
                                          const NonbondedSettings& settings, double skin,
                                          std::span<const Vec3> positions, FastPairs& pairs,
                                          std::span<Vec3> forces, PairResult result,
                                          const PairThreads& threads) {
    PALPA_ASSERT(!find_problem(settings));
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    if (!has_fast_form(settings)) {
        if (threads.beside) threads.beside();
        ++pairs.in_double;
        return add_nonbonded_forces(topology, settings, positions, forces);
    }
    NonbondedEnergy energy = add_fast_pairs(topology, atoms, without_solvation(settings), skin,
                                            positions, pairs, forces, result, threads);
    if (settings.solvation == SolvationEnd::None) return energy;
    const double solvation = add_fast_solvation_forces(topology, atoms.solvation, skin, positions,
                                                       pairs.solvation, forces, threads.count);
    if (result == PairResult::ForcesAndEnergies) energy.solvation = solvation;
    return energy;
}

std::optional<NonbondedEnergy> add_tile_forces(const Topology& topology,
                                               const NonbondedSettings& settings,
                                               const ClusterList& list, PairWorkspace& workspace,
                                               std::span<const std::array<std::uint32_t, 2>> others,
                                               std::span<const Vec3> positions,
                                               std::span<Vec3> forces, PairResult result,
                                               const PairThreads& threads) {
    const PairKernelSum sum = add_cluster_pair_forces(list, pair_scheme(settings), positions,
                                                      workspace, forces, result, threads);
    if (!sum.is_sound) return std::nullopt;
    const NonbondedEnergy added =
        add_pair_forces(topology, without_solvation(settings), others, positions, forces);
    if (result == PairResult::Forces) return NonbondedEnergy{};
    return NonbondedEnergy{sum.van_der_waals + added.van_der_waals,
                           sum.electrostatic + added.electrostatic};
}

NonbondedEnergy add_pairs_in_double(const Topology& topology, const NonbondedSettings& settings,
                                    const ClusterList& list,
                                    std::span<const std::array<std::uint32_t, 2>> others,
                                    std::span<const Vec3> positions, std::span<Vec3> forces) {
    std::vector<std::array<std::uint32_t, 2>> pairs = list_pairs(list);
    pairs.insert(pairs.end(), others.begin(), others.end());
    return add_pair_forces(topology, settings, pairs, positions, forces);
}

}  // namespace palpa
