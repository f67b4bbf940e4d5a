#include "forces/group_forces.h"

#include "field/select_tiles.h"

#include <algorithm>
#include <optional>

namespace palpa {
namespace {

using Groups = std::span<const std::uint32_t>;

// Collects the terms that reach across groups, and the atoms that they act on.
class TermSelector {
public:
    TermSelector(Groups groups, GroupForces& result)
        : groups_(groups), result_(result), is_used_(groups.size(), 0) {}

    template <class Term, class AtomsOf>
    void select(const std::vector<Term>& from, std::vector<Term>& to, const AtomsOf& atoms_of) {
        for (const Term& term : from) {
            const auto atoms = atoms_of(term);
            if (is_within_group(atoms)) continue;
            to.push_back(term);
            for (const std::uint32_t atom : atoms) use(atom);
        }
    }

    void use(std::uint32_t atom) { is_used_[atom] = 1; }

    void write_atoms() {
        for (std::uint32_t i = 0; i < is_used_.size(); ++i) {
            if (is_used_[i] != 0) result_.atoms.push_back(i);
        }
    }

private:
    template <class Atoms>
    bool is_within_group(const Atoms& atoms) const {
        return std::ranges::all_of(
            atoms, [&](std::uint32_t atom) { return groups_[atom] == groups_[atoms[0]]; });
    }

    Groups groups_;
    GroupForces& result_;
    std::vector<std::uint8_t> is_used_;
};

void select_terms(const Topology& topology, TermSelector& selector, Topology& terms) {
    using std::array;
    selector.select(topology.bonds, terms.bonds, [](const Bond& t) { return array{t.a, t.b}; });
    selector.select(topology.angles, terms.angles,
                    [](const Angle& t) { return array{t.a, t.b, t.c}; });
    selector.select(topology.urey_bradleys, terms.urey_bradleys,
                    [](const UreyBradley& t) { return array{t.a, t.c}; });
    selector.select(topology.dihedrals, terms.dihedrals,
                    [](const Dihedral& t) { return array{t.a, t.b, t.c, t.d}; });
    selector.select(topology.impropers, terms.impropers,
                    [](const Improper& t) { return array{t.a, t.b, t.c, t.d}; });
    selector.select(topology.cmap_terms, terms.cmap_terms, [](const CmapTerm& t) {
        return array{t.phi[0], t.phi[1], t.phi[2], t.phi[3],
                     t.psi[0], t.psi[1], t.psi[2], t.psi[3]};
    });
    selector.select(topology.exclusions.pairs14, terms.exclusions.pairs14,
                    [](const array<std::uint32_t, 2>& pair) { return pair; });
}

NonbondedEnergy add_plain(const Topology& topology, const NonbondedSettings& settings,
                          GroupForces& group_forces, std::span<const Vec3> positions,
                          std::span<Vec3> forces) {
    if (!group_forces.is_fast)
        return add_pair_forces(topology, settings, group_forces.pairs, positions, forces);
    const ClusterList& tiles = group_forces.tiles;
    const std::optional<NonbondedEnergy> energy =
        add_tile_forces(topology, settings, tiles, group_forces.workspace, group_forces.pairs,
                        positions, forces, PairResult::ForcesAndEnergies);
    group_forces.was_in_double = !energy;
    if (energy) return *energy;
    return add_pairs_in_double(topology, settings, tiles, group_forces.pairs, positions, forces);
}

const auto pair_itself = [](const std::array<std::uint32_t, 2>& pair) { return pair; };

}  // namespace

GroupForces build_fast_group_forces(const Topology& topology, const FastAtoms& atoms,
                                    const FastPairs& pairs, Groups groups,
                                    std::span<const Vec3> positions, double skin) {
    GroupForces result;
    TermSelector selector(groups, result);
    select_terms(topology, selector, result.terms);
    result.bonded = build_fast_bonded(result.terms);
    result.tiles = select_tiles(pairs.list, groups, positions, skin);
    result.workspace =
        build_pair_workspace(result.tiles, {topology.charge, atoms.sqrt_epsilon, atoms.half_rmin});
    result.workspace.origin = pairs.workspace.origin;
    for (const std::uint32_t atom : result.tiles.atoms) {
        if (atom != no_atom) selector.use(atom);
    }
    // Those that the kernel leaves out because their numbers are replaced.
    selector.select(pairs.replaced, result.pairs, pair_itself);
    result.is_fast = true;
    if (pairs.solvation.builds > 0) {
        result.solvation =
            select_solvation_tiles(atoms.solvation, pairs.solvation, groups, positions, skin);
        for (const std::uint32_t atom : result.solvation.tiles.atoms) {
            if (atom != no_atom) selector.use(atom);
        }
    }
    selector.write_atoms();
    return result;
}

GroupForces build_group_forces(const Topology& topology, const PairList* list, Groups groups) {
    GroupForces result;
    TermSelector selector(groups, result);
    select_terms(topology, selector, result.terms);
    result.bonded = build_fast_bonded(result.terms);
    std::vector<std::array<std::uint32_t, 2>> pairs;
    if (list != nullptr) {
        for (std::size_t row = 0; row < list->atoms.size(); ++row) {
            for (const std::uint32_t other : list->neighbours_of(row)) {
                pairs.push_back({list->atoms[row], other});
            }
        }
    } else {
        for (std::uint32_t a = 0; a < topology.size(); ++a) {
            const auto excluded = topology.exclusions.of(a);
            for (std::uint32_t b = a + 1; b < topology.size(); ++b) {
                if (groups[a] != groups[b] &&
                    !std::binary_search(excluded.begin(), excluded.end(), b))
                    pairs.push_back({a, b});
            }
        }
    }
    selector.select(pairs, result.pairs, pair_itself);
    selector.write_atoms();
    return result;
}

EnergyTerms add_group_forces(const Topology& topology, const NonbondedSettings& settings,
                             GroupForces& group_forces, std::span<const Vec3> positions,
                             std::span<Vec3> forces) {
    const bool has_tiles = group_forces.is_fast && settings.solvation != SolvationEnd::None;
    const NonbondedSettings pairwise = has_tiles ? without_solvation(settings) : settings;
    EnergyTerms energy = add_fast_terms(topology, group_forces.terms, group_forces.bonded, pairwise,
                                        positions, forces);
    const NonbondedEnergy plain = add_plain(topology, pairwise, group_forces, positions, forces);
    energy.lj = plain.van_der_waals;
    energy.coulomb = plain.electrostatic;
    energy.solvation += plain.solvation;
    if (has_tiles) {
        energy.solvation +=
            add_solvation_tiles(topology, group_forces.solvation, positions, forces);
    }
    return energy;
}

}  // namespace palpa
