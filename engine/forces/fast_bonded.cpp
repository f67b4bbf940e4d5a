#include "forces/fast_bonded.h"

#include "core/assertion.h"
#include "core/repeatable.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace palpa {
namespace {

// Calls `set(numbers, t, term)` with the block and the place in it of each term.
template <std::size_t Atoms, class Numbers, class Term, class AtomsOf, class Set>
TermBlocks<Atoms, Numbers> build_blocks(std::span<const Term> terms, const AtomsOf& atoms_of,
                                        const Set& set) {
    TermBlocks<Atoms, Numbers> result;
    for (const Term& term : terms) {
        const std::size_t t = result.atoms.size() % block_size;
        if (t == 0) result.blocks.emplace_back();
        set(result.blocks.back(), t, term);
        result.atoms.push_back(atoms_of(term));
    }
    return result;
}

using Four = std::array<std::uint32_t, 4>;

// All dihedrals of four atoms: the angle is the same from either end.
using DihedralsOfAtoms = std::map<Four, std::vector<Dihedral>>;
DihedralsOfAtoms gather_dihedrals(const Topology& topology) {
    DihedralsOfAtoms result;
    for (const Dihedral& term : topology.dihedrals) {
        PALPA_ASSERT(term.multiplicity >= 1);
        const Four forwards{term.a, term.b, term.c, term.d};
        const Four backwards{term.d, term.c, term.b, term.a};
        result[std::min(forwards, backwards)].push_back(term);
    }
    return result;
}

void build_dihedrals(const Topology& topology, FastBonded& bonded) {
    const DihedralsOfAtoms dihedrals = gather_dihedrals(topology);
    struct Entry {
        const Four* atoms;
        const std::vector<Dihedral>* terms;
        std::size_t order;
    };
    std::vector<Entry> entries;
    for (const auto& [atoms, terms] : dihedrals) {
        int order = 0;
        for (const Dihedral& term : terms) order = std::max(order, term.multiplicity);
        entries.push_back({&atoms, &terms, static_cast<std::size_t>(order)});
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.order < b.order; });
    bonded.dihedrals = build_blocks<4, FastBonded::Series>(
        std::span<const Entry>(entries), [](const Entry& entry) { return *entry.atoms; },
        [&](FastBonded::Series& series, std::size_t t, const Entry& entry) {
            series.cosine.resize(entry.order);
            series.sine.resize(entry.order);
            for (const Dihedral& term : *entry.terms) {
                const auto n = static_cast<std::size_t>(term.multiplicity);
                series.cosine[n - 1].at[t] += term.k * repeatable::cos(term.phase);
                series.sine[n - 1].at[t] += term.k * repeatable::sin(term.phase);
                bonded.dihedral_constant += term.k;
            }
        });
}

void set(const Vec3& v, std::size_t t, Columns3& columns) noexcept {
    columns.x.at[t] = v.x();
    columns.y.at[t] = v.y();
    columns.z.at[t] = v.z();
}

Vec3 get(const Columns3& columns, std::size_t t) noexcept {
    return {columns.x.at[t], columns.y.at[t], columns.z.at[t]};
}

// Calls `sum(atoms, numbers)` with each block's terms and returns the sum of the energies.
template <std::size_t Atoms, class Numbers, class Sum>
double sum_blocks(const TermBlocks<Atoms, Numbers>& terms, const Sum& sum) noexcept {
    double energy = 0;
    for (std::size_t block = 0; block < terms.blocks.size(); ++block) {
        const std::span atoms = std::span(terms.atoms).subspan(block * block_size);
        energy += sum(atoms.first(std::min(atoms.size(), block_size)), terms.blocks[block]);
    }
    return energy;
}

double add_springs(const TermBlocks<2, SpringNumbers>& springs, std::span<const Vec3> positions,
                   std::span<Vec3> forces) noexcept {
    Columns3 d, on_a;
    return sum_blocks(springs, [&](auto atoms, const SpringNumbers& numbers) {
        for (std::size_t t = 0; t < atoms.size(); ++t)
            set(positions[atoms[t][0]] - positions[atoms[t][1]], t, d);
        const double energy = evaluate_springs(numbers, d, on_a);
        for (std::size_t t = 0; t < atoms.size(); ++t) {
            const Vec3 force = get(on_a, t);
            forces[atoms[t][0]] += force;
            forces[atoms[t][1]] -= force;
        }
        return energy;
    });
}

double add_angles(const TermBlocks<3, AngleNumbers>& angles, std::span<const Vec3> positions,
                  std::span<Vec3> forces) noexcept {
    Columns3 u, v, on_a, on_c;
    return sum_blocks(angles, [&](auto atoms, const AngleNumbers& numbers) {
        for (std::size_t t = 0; t < atoms.size(); ++t) {
            const auto& [a, b, c] = atoms[t];
            set(positions[a] - positions[b], t, u);
            set(positions[c] - positions[b], t, v);
        }
        const double energy = evaluate_angles(numbers, u, v, on_a, on_c);
        for (std::size_t t = 0; t < atoms.size(); ++t) {
            const auto& [a, b, c] = atoms[t];
            const Vec3 a_force = get(on_a, t), c_force = get(on_c, t);
            forces[a] += a_force;
            forces[b] -= a_force + c_force;
            forces[c] += c_force;
        }
        return energy;
    });
}

template <class Numbers, class Evaluate>
double add_torsions(const TermBlocks<4, Numbers>& torsions, std::span<const Vec3> positions,
                    std::span<Vec3> forces, const Evaluate& evaluate) noexcept {
    TorsionBlock block;
    return sum_blocks(torsions, [&](auto atoms, const Numbers& numbers) {
        for (std::size_t t = 0; t < atoms.size(); ++t) {
            const auto& [a, b, c, d] = atoms[t];
            set(positions[a] - positions[b], t, block.F);
            set(positions[b] - positions[c], t, block.G);
            set(positions[d] - positions[c], t, block.H);
        }
        const double energy = evaluate(numbers, block);
        for (std::size_t t = 0; t < atoms.size(); ++t) {
            const auto& [a, b, c, d] = atoms[t];
            const Vec3 F = get(block.on_F, t), G = get(block.on_G, t), H = get(block.on_H, t);
            forces[a] += F;
            forces[b] += G - F;
            forces[c] -= G + H;
            forces[d] += H;
        }
        return energy;
    });
}

}  // namespace

FastBonded build_fast_bonded(const Topology& topology) {
    FastBonded bonded;
    bonded.bonds = build_blocks<2, SpringNumbers>(
        std::span<const Bond>(topology.bonds),
        [](const Bond& term) { return std::array{term.a, term.b}; },
        [](SpringNumbers& numbers, std::size_t t, const Bond& term) {
            numbers.k.at[t] = term.k;
            numbers.r0.at[t] = term.r0;
        });
    bonded.urey_bradleys = build_blocks<2, SpringNumbers>(
        std::span<const UreyBradley>(topology.urey_bradleys),
        [](const UreyBradley& term) { return std::array{term.a, term.c}; },
        [](SpringNumbers& numbers, std::size_t t, const UreyBradley& term) {
            numbers.k.at[t] = term.k;
            numbers.r0.at[t] = term.s0;
        });
    bonded.angles = build_blocks<3, AngleNumbers>(
        std::span<const Angle>(topology.angles),
        [](const Angle& term) { return std::array{term.a, term.b, term.c}; },
        [](AngleNumbers& numbers, std::size_t t, const Angle& term) {
            numbers.k.at[t] = term.k;
            numbers.cos_theta0.at[t] = repeatable::cos(term.theta0);
            numbers.sin_theta0.at[t] = repeatable::sin(term.theta0);
        });
    bonded.impropers = build_blocks<4, ImproperNumbers>(
        std::span<const Improper>(topology.impropers),
        [](const Improper& term) { return Four{term.a, term.b, term.c, term.d}; },
        [](ImproperNumbers& numbers, std::size_t t, const Improper& term) {
            numbers.k.at[t] = term.k;
            numbers.cos_psi0.at[t] = repeatable::cos(term.psi0);
            numbers.sin_psi0.at[t] = repeatable::sin(term.psi0);
        });
    build_dihedrals(topology, bonded);
    return bonded;
}

BondedEnergy add_fast_bonded_forces(const FastBonded& bonded, std::span<const Vec3> positions,
                                    std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(positions.size() == forces.size());
    BondedEnergy energy;
    energy.bond = add_springs(bonded.bonds, positions, forces);
    energy.angle = add_angles(bonded.angles, positions, forces);
    energy.urey_bradley = add_springs(bonded.urey_bradleys, positions, forces);
    energy.dihedral =
        bonded.dihedral_constant +
        add_torsions(bonded.dihedrals, positions, forces,
                     [](const FastBonded::Series& series, TorsionBlock& block) noexcept {
                         return evaluate_dihedrals({series.cosine, series.sine}, block);
                     });
    energy.improper = add_torsions(bonded.impropers, positions, forces, evaluate_impropers);
    return energy;
}

}  // namespace palpa
