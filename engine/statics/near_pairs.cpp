#include "statics/near_pairs.h"

#include "forces/fast_nonbonded.h"
#include "forces/solvation.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace palpa {
namespace {

constexpr std::uint32_t not_near = std::numeric_limits<std::uint32_t>::max();

// The atoms that are held, then those near them.
std::vector<std::uint32_t> find_near(std::span<const Vec3> positions,
                                     std::span<const std::uint32_t> held, double reach) {
    std::vector<std::uint32_t> atoms(held.begin(), held.end());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const bool is_near = std::ranges::any_of(held, [&](std::uint32_t j) {
            return (positions[i] - positions[j]).squaredNorm() < reach * reach;
        });
        if (is_near && !std::ranges::binary_search(held, i)) atoms.push_back(i);
    }
    return atoms;
}

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

// Those with both atoms among the numbered ones, by these numbers.
Pairs renumbered(std::span<const std::array<std::uint32_t, 2>> pairs,
                 std::span<const std::uint32_t> number_of) {
    Pairs found;
    for (const auto& [a, b] : pairs) {
        if (number_of[a] != not_near && number_of[b] != not_near)
            found.push_back({number_of[a], number_of[b]});
    }
    return found;
}

}  // namespace

NearPairs build_near_pairs(const TorsionModel& model, std::span<const Vec3> positions,
                           std::span<const std::uint32_t> held, double reach) {
    const FastAtoms& fast = model.fast.atoms;
    const std::vector<std::uint32_t> atoms = find_near(positions, held, reach);
    std::vector<std::uint32_t> number_of(positions.size(), not_near), groups(atoms.size(), 1);
    for (std::uint32_t k = 0; k < atoms.size(); ++k) number_of[atoms[k]] = k;
    std::fill_n(groups.begin(), held.size(), 0U);

    NearPairs near;
    near.tiles =
        build_full_cluster_list(atoms.size(), renumbered(fast.left_out, number_of), groups);
    for (std::uint32_t& atom : near.tiles.atoms) {
        if (atom != no_atom) atom = atoms[atom];
    }
    near.workspace = build_pair_workspace(
        near.tiles, {model.topology.charge, fast.sqrt_epsilon, fast.half_rmin});
    if (!held.empty()) near.workspace.origin = positions[held.front()];
    for (const auto& [a, b] : fast.replaced()) {
        if (number_of[a] == not_near || number_of[b] == not_near) continue;
        if (groups[number_of[a]] != groups[number_of[b]]) near.others.push_back({a, b});
    }
    if (model.topology.solvation) {
        near.solvation = build_solvation_tiles(fast.solvation, atoms, groups, fast.excluded(),
                                               near.workspace.origin);
        near.solvated = list_pairs(near.solvation.tiles);
    }
    near.all = list_pairs(near.tiles);
    near.all.insert(near.all.end(), near.others.begin(), near.others.end());
    return near;
}

double add_near_forces(const TorsionModel& model, const ForceSettings& settings, NearPairs& near,
                       std::span<const Vec3> positions, std::span<Vec3> forces) {
    const Topology& topology = model.topology;
    const NonbondedSettings& nonbonded = settings.nonbonded;
    const bool has_solvation = nonbonded.solvation != SolvationEnd::None;
    if (is_fast(settings)) {
        const std::optional<NonbondedEnergy> sum =
            add_tile_forces(topology, nonbonded, near.tiles, near.workspace, near.others, positions,
                            forces, PairResult::ForcesAndEnergies);
        if (sum) {
            return sum->sum() +
                   (has_solvation ? add_solvation_tiles(topology, near.solvation, positions, forces)
                                  : 0);
        }
    }
    const double vacuum = add_pairs_in_double(topology, without_solvation(nonbonded), near.tiles,
                                              near.others, positions, forces)
                              .sum();
    if (!has_solvation) return vacuum;
    return vacuum +
           add_solvation_forces(topology, nonbonded.solvation, near.solvated, positions, forces);
}

}  // namespace palpa
