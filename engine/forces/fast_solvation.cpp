#include "forces/fast_solvation.h"

#include "core/assertion.h"
#include "field/select_tiles.h"
#include "forces/solvation.h"
#include "forces/solvation_law.h"

#include <algorithm>
#include <utility>

namespace palpa {
namespace {

constexpr double near_skin = 0.6;  // Å, as of other pairs

// The pairs of atoms that count, one by one and by the numbers of all atoms.
std::vector<std::array<std::uint32_t, 2>> renumbered_pairs(
    std::vector<std::array<std::uint32_t, 2>> pairs, std::span<const std::uint32_t> numbers) {
    for (auto& [a, b] : pairs) {
        a = numbers[a];
        b = numbers[b];
    }
    return pairs;
}

void renumber(std::span<const std::uint32_t> numbers, ClusterList& list) {
    for (std::uint32_t& atom : list.atoms) {
        if (atom != no_atom) atom = numbers[atom];
    }
}

bool have_moved_less(std::span<const Vec3> positions, std::span<const Vec3> places, double most) {
    if (positions.size() != places.size()) return false;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (!((positions[i] - places[i]).squaredNorm() <= most * most)) return false;
    }
    return true;
}

void update_solvation_list(const FastSolvationAtoms& atoms, double skin,
                           FastSolvationPairs& pairs) {
    if (pairs.builds > 0 && !is_outdated(pairs.list, pairs.positions)) return;
    pairs.selected.clear();
    if (pairs.builds == 0) {
        pairs.list = build_cluster_list(pairs.positions, atoms.left_out, smooth_solvation_end, skin,
                                        std::move(pairs.list));
    } else if (update_cluster_list(pairs.positions, atoms.left_out, pairs.list) !=
               ListChange::Clusters) {
        return;
    }
    pairs.workspace =
        build_solvation_workspace(pairs.list, atoms.parameters(), std::move(pairs.workspace));
    ++pairs.builds;
}

// Whether `pairs.near` has all pairs; as of other pairs (forces/fast_nonbonded.cpp).
bool update_near_solvation(const FastSolvationAtoms& atoms, double skin,
                           FastSolvationPairs& pairs) {
    if (skin <= near_skin) return false;
    const bool is_slow = have_moved_less(pairs.positions, pairs.summed, near_skin / 8);
    pairs.summed = pairs.positions;
    if (have_moved_less(pairs.positions, pairs.selected, 0.5 * near_skin)) return true;
    if (!is_slow) return false;
    pairs.near.tiles = select_tiles(pairs.list, {}, pairs.positions, near_skin);
    pairs.near.workspace = build_solvation_workspace(pairs.near.tiles, atoms.parameters(),
                                                     std::move(pairs.near.workspace));
    pairs.near.workspace.origin = pairs.workspace.origin;
    pairs.selected = pairs.positions;
    return true;
}

SolvationKernelSum sum_kernel(const ClusterList& list, SolvationWorkspace& workspace,
                              std::span<const Vec3> positions, std::span<Vec3> forces,
                              std::size_t threads) {
    return add_cluster_solvation_forces(list, smooth_solvation_begin, smooth_solvation_end,
                                        positions, workspace, forces, {threads});
}

}  // namespace

FastSolvationAtoms build_fast_solvation_atoms(const Topology& topology) {
    FastSolvationAtoms result;
    if (!topology.solvation) return result;
    result.number_of.assign(topology.size(), no_atom);
    for (std::uint32_t i = 0; i < topology.size(); ++i) {
        const SolvationAtom atom = solvation_atom(*topology.solvation, i);
        if (!atom.counts()) continue;
        result.number_of[i] = static_cast<std::uint32_t>(result.atoms.size());
        result.atoms.push_back(i);
        result.volume.push_back(atom.volume);
        result.strength.push_back(atom.strength);
        result.inverse_lambda.push_back(atom.inverse_lambda);
        result.radius.push_back(atom.radius);
    }
    const auto& pairs14 = topology.exclusions.pairs14;
    for (const std::uint32_t i : result.atoms) {
        for (const std::uint32_t j : topology.exclusions.of(i)) {
            if (result.number_of[j] == no_atom) continue;
            const std::array<std::uint32_t, 2> pair{i, j};
            if (!std::ranges::binary_search(pairs14, pair))
                result.left_out.push_back({result.number_of[i], result.number_of[j]});
        }
    }
    return result;
}

double add_fast_solvation_forces(const Topology& topology, const FastSolvationAtoms& atoms,
                                 double skin, std::span<const Vec3> positions,
                                 FastSolvationPairs& pairs, std::span<Vec3> forces,
                                 std::size_t threads) {
    PALPA_ASSERT(atoms.number_of.size() == topology.size());
    pairs.positions.clear();
    for (const std::uint32_t atom : atoms.atoms) pairs.positions.push_back(positions[atom]);
    update_solvation_list(atoms, skin, pairs);
    const bool is_near = update_near_solvation(atoms, skin, pairs);
    pairs.forces.assign(atoms.atoms.size(), Vec3::Zero());
    const SolvationKernelSum sum = sum_kernel(is_near ? pairs.near.tiles : pairs.list,
                                              is_near ? pairs.near.workspace : pairs.workspace,
                                              pairs.positions, pairs.forces, threads);
    if (!sum.is_sound) {
        return add_solvation_forces(topology, SolvationEnd::Smooth,
                                    renumbered_pairs(list_pairs(pairs.list), atoms.atoms),
                                    positions, forces);
    }
    for (std::size_t k = 0; k < atoms.atoms.size(); ++k) forces[atoms.atoms[k]] += pairs.forces[k];
    return sum.energy;
}

double add_solvation_tiles(const Topology& topology, SolvationTiles& tiles,
                           std::span<const Vec3> positions, std::span<Vec3> forces,
                           std::size_t threads) {
    const SolvationKernelSum sum =
        sum_kernel(tiles.tiles, tiles.workspace, positions, forces, threads);
    if (sum.is_sound) return sum.energy;
    return add_solvation_forces(topology, SolvationEnd::Smooth, list_pairs(tiles.tiles), positions,
                                forces);
}

SolvationTiles select_solvation_tiles(const FastSolvationAtoms& atoms,
                                      const FastSolvationPairs& pairs,
                                      std::span<const std::uint32_t> groups,
                                      std::span<const Vec3> positions, double skin) {
    std::vector<std::uint32_t> own_groups;
    std::vector<Vec3> own_positions;
    for (const std::uint32_t atom : atoms.atoms) {
        own_groups.push_back(groups[atom]);
        own_positions.push_back(positions[atom]);
    }
    SolvationTiles result;
    result.tiles = select_tiles(pairs.list, own_groups, own_positions, skin);
    result.workspace = build_solvation_workspace(result.tiles, atoms.parameters());
    result.workspace.origin = pairs.workspace.origin;
    renumber(atoms.atoms, result.tiles);
    return result;
}

SolvationTiles build_solvation_tiles(const FastSolvationAtoms& atoms,
                                     std::span<const std::uint32_t> among,
                                     std::span<const std::uint32_t> groups,
                                     std::span<const std::array<std::uint32_t, 2>> left_out,
                                     const Vec3& origin) {
    PALPA_ASSERT(among.size() == groups.size());
    // Three numberings: of all atoms, of `atoms`, and of those that are here.
    std::vector<std::uint32_t> here, own_groups, counted, place_of(atoms.number_of.size(), no_atom);
    for (std::size_t k = 0; k < among.size(); ++k) {
        if (atoms.number_of[among[k]] == no_atom) continue;
        place_of[among[k]] = static_cast<std::uint32_t>(here.size());
        here.push_back(among[k]);
        counted.push_back(atoms.number_of[among[k]]);
        own_groups.push_back(groups[k]);
    }
    std::vector<std::array<std::uint32_t, 2>> own_left_out;
    for (const auto& [a, b] : left_out) {
        if (place_of[a] != no_atom && place_of[b] != no_atom)
            own_left_out.push_back({place_of[a], place_of[b]});
    }
    SolvationTiles result;
    result.tiles = build_full_cluster_list(here.size(), own_left_out, own_groups);
    ClusterList counted_tiles = result.tiles;
    renumber(counted, counted_tiles);
    result.workspace = build_solvation_workspace(counted_tiles, atoms.parameters());
    result.workspace.origin = origin;
    renumber(here, result.tiles);
    return result;
}

}  // namespace palpa
