#include "forces/force_field.h"

#include "core/assertion.h"
#include "forces/bonded.h"
#include "forces/cmap.h"
#include "forces/solvation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <vector>

namespace palpa {
namespace {

constexpr std::array all_terms{
    &EnergyTerms::bond,      &EnergyTerms::angle,    &EnergyTerms::urey_bradley,
    &EnergyTerms::dihedral,  &EnergyTerms::improper, &EnergyTerms::cmap,
    &EnergyTerms::lj,        &EnergyTerms::lj14,     &EnergyTerms::coulomb,
    &EnergyTerms::coulomb14, &EnergyTerms::solvation};

void add_pairs(const NonbondedEnergy& pairs, EnergyTerms& energy) noexcept {
    energy.lj += pairs.van_der_waals;
    energy.coulomb += pairs.electrostatic;
    energy.solvation += pairs.solvation;
}

void add_pairs14(const NonbondedEnergy& pairs, EnergyTerms& energy) noexcept {
    energy.lj14 = pairs.van_der_waals;
    energy.coulomb14 = pairs.electrostatic;
    energy.solvation += pairs.solvation;
}

// All terms but the plain pairs.
EnergyTerms add_bonded_forces(const Topology& topology, const NonbondedSettings& settings,
                              std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    EnergyTerms energy;
    energy.bond = add_bond_forces(topology.bonds, positions, forces);
    energy.angle = add_angle_forces(topology.angles, positions, forces);
    energy.urey_bradley = add_urey_bradley_forces(topology.urey_bradleys, positions, forces);
    energy.dihedral = add_dihedral_forces(topology.dihedrals, positions, forces);
    energy.improper = add_improper_forces(topology.impropers, positions, forces);
    energy.cmap = add_cmap_forces(topology.cmap_terms, topology.cmap_maps, positions, forces);
    energy.solvation = find_lone_solvation(topology, settings.solvation);
    add_pairs14(add_nonbonded14_forces(topology, settings, positions, forces), energy);
    return energy;
}

}  // namespace

double EnergyTerms::magnitude() const noexcept {
    double sum = 0;
    for (const auto term : all_terms) sum += std::abs(this->*term);
    return sum;
}

EnergyTerms& EnergyTerms::operator+=(const EnergyTerms& other) noexcept {
    for (const auto term : all_terms) this->*term += other.*term;
    return *this;
}

EnergyTerms& EnergyTerms::operator-=(const EnergyTerms& other) noexcept {
    for (const auto term : all_terms) this->*term -= other.*term;
    return *this;
}

EnergyTerms add_forces(const Topology& topology, const NonbondedSettings& settings,
                       std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    EnergyTerms energy = add_bonded_forces(topology, settings, positions, forces);
    add_pairs(add_nonbonded_forces(topology, settings, positions, forces), energy);
    return energy;
}

EnergyTerms add_forces(const Topology& topology, const NonbondedSettings& settings,
                       const PairList& list, std::span<const Vec3> positions,
                       std::span<Vec3> forces, std::size_t threads) {
    PALPA_ASSERT(threads > 0);
    // Bonded terms take about a fifth of the time of a protein's pairs; this thread has them too.
    const auto count = static_cast<double>(threads);
    const double own = std::max(0.0, (1.2 - 0.2 * count) / count);
    const double each = threads > 1 ? (1.0 - own) / (count - 1.0) : 0.0;
    struct Helper {
        std::vector<Vec3> forces;
        NonbondedEnergy energy;
        std::jthread thread;
    };
    std::vector<Helper> helpers(threads - 1);
    for (std::size_t i = 0; i < helpers.size(); ++i) {
        const double from = own + each * static_cast<double>(i);
        const PairRows rows = find_rows(list, from, i + 1 == helpers.size() ? 1.0 : from + each);
        helpers[i].forces.assign(forces.size(), Vec3::Zero());
        helpers[i].thread = std::jthread([&, rows, &helper = helpers[i]] {
            helper.energy =
                add_nonbonded_forces(topology, settings, list, rows, positions, helper.forces);
        });
    }
    const PairRows rows = find_rows(list, 0, helpers.empty() ? 1.0 : own);
    EnergyTerms energy = add_bonded_forces(topology, settings, positions, forces);
    add_pairs(add_nonbonded_forces(topology, settings, list, rows, positions, forces), energy);
    for (Helper& helper : helpers) {
        helper.thread.join();
        add_pairs(helper.energy, energy);
        for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += helper.forces[i];
    }
    return energy;
}

FastForceField build_fast_force_field(const Topology& topology) {
    return {build_fast_atoms(topology), build_fast_bonded(topology)};
}

EnergyTerms add_fast_terms(const Topology& topology, const Topology& terms,
                           const FastBonded& bonded, const NonbondedSettings& settings,
                           std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    EnergyTerms energy;
    const BondedEnergy sums = add_fast_bonded_forces(bonded, positions, forces);
    energy.bond = sums.bond;
    energy.angle = sums.angle;
    energy.urey_bradley = sums.urey_bradley;
    energy.dihedral = sums.dihedral;
    energy.improper = sums.improper;
    energy.cmap = add_cmap_forces(terms.cmap_terms, topology.cmap_maps, positions, forces);
    add_pairs14(add_pair14_forces(topology, settings, terms.exclusions.pairs14, positions, forces),
                energy);
    return energy;
}

EnergyTerms add_fast_forces(const Topology& topology, const FastForceField& fast,
                            const NonbondedSettings& settings, double skin,
                            std::span<const Vec3> positions, FastPairs& pairs,
                            std::span<Vec3> forces, PairResult result, std::size_t threads) {
    EnergyTerms energy;
    energy.solvation = find_lone_solvation(topology, settings.solvation);
    const NonbondedSettings beside =
        has_fast_form(settings) ? without_solvation(settings) : settings;
    const auto add_others = [&] {
        energy += add_fast_terms(topology, topology, fast.bonded, beside, positions, forces);
    };
    // The other terms of a protein's atom take about as long as two tiles of pairs.
    add_pairs(add_fast_nonbonded_forces(topology, fast.atoms, settings, skin, positions, pairs,
                                        forces, result, {threads, add_others, 2 * topology.size()}),
              energy);
    return energy;
}

}  // namespace palpa
