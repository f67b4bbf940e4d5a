#include "forces/nonbonded.h"

#include "core/assertion.h"
#include "field/pair_field.h"
#include "forces/pair_law.h"
#include "forces/solvation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace palpa {
namespace {

constexpr double core2 = pair_core_radius * pair_core_radius;

// Adds the pair's force, d from j to i, and its energy.
template <class Law>
void add_pair(const Law& law, const Vec3& d, double charges, const LennardJonesPair& parameters,
              NonbondedEnergy& energy, Vec3& on_i, Vec3& on_j) noexcept {
    const double distance2 = d.squaredNorm();
    if (distance2 >= law.reach2) return;
    const double r2 = std::max(distance2, core2);
    const PairEnergies pair = law.evaluate(r2, std::sqrt(1.0 / r2), charges, parameters);
    const double below = 0.5 * (r2 - distance2);  // 0 outside of the core
    energy.van_der_waals += pair.van_der_waals.energy + pair.van_der_waals.gradient * below;
    energy.electrostatic += pair.electrostatic.energy + pair.electrostatic.gradient * below;
    const Vec3 force = (pair.van_der_waals.gradient + pair.electrostatic.gradient) * d;
    on_i += force;
    on_j -= force;
}

template <class Law>
NonbondedEnergy add_pairs(const Topology& topology, const Law& law, double coulomb,
                          std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    NonbondedEnergy total;
    const std::size_t n = topology.size();
    for (std::size_t i = 0; i < n; ++i) {
        const double charge = coulomb * topology.charge[i];
        const LennardJonesPair* const row = topology.lennard_jones.row(topology.type[i]);
        NonbondedEnergy energy;
        Vec3 force = Vec3::Zero();
        std::size_t j = i + 1;
        const auto add_up_to = [&](std::size_t end) {
            for (; j < end; ++j) {
                add_pair(law, positions[i] - positions[j], charge * topology.charge[j],
                         row[topology.type[j]], energy, force, forces[j]);
            }
        };
        for (const std::uint32_t excluded : topology.exclusions.of(i)) {
            add_up_to(excluded);
            ++j;
        }
        add_up_to(n);
        forces[i] += force;
        total.van_der_waals += energy.van_der_waals;
        total.electrostatic += energy.electrostatic;
    }
    return total;
}

template <class Law>
NonbondedEnergy add_given_pairs(const Topology& topology, const LennardJonesTable& lennard_jones,
                                const Law& law, double coulomb,
                                std::span<const std::array<std::uint32_t, 2>> pairs,
                                std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    NonbondedEnergy energy;
    for (const auto& [i, j] : pairs) {
        add_pair(
            law, positions[i] - positions[j], coulomb * topology.charge[i] * topology.charge[j],
            lennard_jones.row(topology.type[i])[topology.type[j]], energy, forces[i], forces[j]);
    }
    return energy;
}

// Neighbours of one atom within the cutoff, an array per property, so that a compiler can put pairs
// beside each other.
struct Block {
    static constexpr std::size_t most = 128;
    using Column = std::array<double, most>;

    std::size_t count = 0;
    std::array<std::uint32_t, most> atoms;
    alignas(64) Column x, y, z;                       // from the neighbour to the atom, Å
    alignas(64) Column distance2;                     // Å^2
    alignas(64) Column inverse_r;                     // 1/Å, not below the core
    alignas(64) Column charges;                       // C q q'/eps
    alignas(64) Column epsilon, rmin;                 // of the pair
    alignas(64) Column van_der_waals, electrostatic;  // energies
    alignas(64) Column gradient;                      // -E'/r
};

// Of at most `Block::most` neighbours.
void find_within(double reach2, const Vec3& place, std::span<const std::uint32_t> neighbours,
                 std::span<const Vec3> positions, Block& block) noexcept {
    std::size_t count = 0;
    for (const std::uint32_t j : neighbours) {
        const Vec3 d = place - positions[j];
        const double distance2 = d.squaredNorm();
        block.x[count] = d.x();
        block.y[count] = d.y();
        block.z[count] = d.z();
        block.distance2[count] = distance2;
        block.atoms[count] = j;
        count += distance2 < reach2 ? 1 : 0;
    }
    block.count = count;
}

void look_up(const Topology& topology, double charge, const LennardJonesPair* row,
             Block& block) noexcept {
    for (std::size_t k = 0; k < block.count; ++k) {
        const std::uint32_t j = block.atoms[k];
        const LennardJonesPair& pair = row[topology.type[j]];
        block.charges[k] = charge * topology.charge[j];
        block.epsilon[k] = pair.epsilon;
        block.rmin[k] = pair.rmin;
    }
}

// As in `add_pair`.
template <class Law>
void evaluate_block(const Law law, Block& block) noexcept {
    const auto count = static_cast<Eigen::Index>(block.count);
    using Column = Eigen::Map<Eigen::ArrayXd, Eigen::Aligned16>;
    Column(block.inverse_r.data(), count) =
        Column(block.distance2.data(), count).max(core2).inverse().sqrt();
    for (std::size_t k = 0; k < block.count; ++k) {
        const double r2 = std::max(block.distance2[k], core2);
        const PairEnergies pair = law.evaluate(r2, block.inverse_r[k], block.charges[k],
                                               {block.epsilon[k], block.rmin[k]});
        const double below = 0.5 * (r2 - block.distance2[k]);
        block.van_der_waals[k] = pair.van_der_waals.energy + pair.van_der_waals.gradient * below;
        block.electrostatic[k] = pair.electrostatic.energy + pair.electrostatic.gradient * below;
        block.gradient[k] = pair.van_der_waals.gradient + pair.electrostatic.gradient;
    }
}

// Adds the neighbours' forces and energies, and the force on the atom.
void add_block(const Block& block, NonbondedEnergy& energy, Vec3& on_i,
               std::span<Vec3> forces) noexcept {
    for (std::size_t k = 0; k < block.count; ++k) {
        energy.van_der_waals += block.van_der_waals[k];
        energy.electrostatic += block.electrostatic[k];
        const Vec3 force = block.gradient[k] * Vec3(block.x[k], block.y[k], block.z[k]);
        on_i += force;
        forces[block.atoms[k]] -= force;
    }
}

template <class Law>
NonbondedEnergy add_listed_pairs(const Topology& topology, const Law& law, double coulomb,
                                 const PairList& list, PairRows rows,
                                 std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    NonbondedEnergy total;
    Block block;
    for (std::size_t row = rows.begin; row < rows.end; ++row) {
        const std::uint32_t i = list.atoms[row];
        std::span<const std::uint32_t> neighbours = list.neighbours_of(row);
        NonbondedEnergy energy;
        Vec3 force = Vec3::Zero();
        while (!neighbours.empty()) {
            const std::size_t count = std::min(neighbours.size(), Block::most);
            find_within(law.reach2, positions[i], neighbours.first(count), positions, block);
            look_up(topology, coulomb * topology.charge[i],
                    topology.lennard_jones.row(topology.type[i]), block);
            evaluate_block(law, block);
            add_block(block, energy, force, forces);
            neighbours = neighbours.subspan(count);
        }
        forces[i] += force;
        total.van_der_waals += energy.van_der_waals;
        total.electrostatic += energy.electrostatic;
    }
    return total;
}

void add_given_solvation(const Topology& topology, const NonbondedSettings& settings,
                         std::span<const std::array<std::uint32_t, 2>> pairs,
                         std::span<const Vec3> positions, std::span<Vec3> forces,
                         NonbondedEnergy& energy) noexcept {
    if (settings.solvation == SolvationEnd::None) return;
    energy.solvation = add_solvation_forces(topology, settings.solvation, pairs, positions, forces);
}

}  // namespace

NonbondedSettings eef1_settings(SolvationEnd solvation) noexcept {
    return {.dielectric = 1.5,
            .distance_dielectric = true,
            .electrostatics = ElectrostaticCutoff::CubicShift,
            .van_der_waals = VanDerWaalsCutoff::SmoothSwitch,
            .switch_from = 7,
            .cutoff = 9,
            .solvation = solvation};
}

NonbondedSettings without_solvation(NonbondedSettings settings) noexcept {
    settings.solvation = SolvationEnd::None;
    return settings;
}

std::optional<PairRule> find_field_rule(const NonbondedSettings& settings,
                                        std::span<const ReplacedPair> replaced) noexcept {
    const PairRule rule{settings.coulomb_constant / settings.dielectric, replaced};
    if (settings.electrostatics == ElectrostaticCutoff::None &&
        settings.van_der_waals == VanDerWaalsCutoff::None &&
        settings.solvation == SolvationEnd::None && !settings.distance_dielectric)
        return rule;
    if (settings.electrostatics != ElectrostaticCutoff::CubicShift ||
        settings.van_der_waals != VanDerWaalsCutoff::SmoothSwitch || !settings.distance_dielectric)
        return std::nullopt;
    PairRule smooth = rule;
    smooth.smooth = {settings.switch_from, settings.cutoff, settings.solvation};
    return smooth;
}

std::optional<std::string_view> find_problem(const NonbondedSettings& settings) noexcept {
    if (!(settings.dielectric > 0)) return "the dielectric must be above 0";
    const bool switches = settings.electrostatics == ElectrostaticCutoff::Switch ||
                          settings.electrostatics == ElectrostaticCutoff::ForceSwitch ||
                          settings.van_der_waals != VanDerWaalsCutoff::None;
    const bool ends = switches || settings.electrostatics != ElectrostaticCutoff::None;
    if (ends && !(settings.cutoff > 0)) return "the cutoff must be above 0 Å";
    if (switches && !(settings.switch_from > 0 && settings.switch_from < settings.cutoff))
        return "the switching distance must be above 0 Å and below the cutoff";
    if (settings.distance_dielectric && settings.electrostatics == ElectrostaticCutoff::ForceShift)
        return "a force shift needs a constant dielectric, not one that grows with distance";
    return std::nullopt;
}

bool has_end(const NonbondedSettings& settings) noexcept {
    return settings.electrostatics != ElectrostaticCutoff::None &&
           settings.van_der_waals != VanDerWaalsCutoff::None;
}

double find_reach(const NonbondedSettings& settings) noexcept {
    if (!has_end(settings)) return std::numeric_limits<double>::infinity();
    return std::max(settings.cutoff, find_solvation_reach(settings.solvation));
}

NonbondedEnergy add_nonbonded_forces(const Topology& topology, const NonbondedSettings& settings,
                                     std::span<const Vec3> positions,
                                     std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(!find_problem(settings));
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    const double coulomb = settings.coulomb_constant / settings.dielectric;
    NonbondedEnergy energy = with_law(settings, [&](const auto& law) {
        return add_pairs(topology, law, coulomb, positions, forces);
    });
    if (settings.solvation != SolvationEnd::None)
        energy.solvation = add_solvation_forces(topology, settings.solvation, positions, forces);
    return energy;
}

NonbondedEnergy add_nonbonded_forces(const Topology& topology, const NonbondedSettings& settings,
                                     const PairList& list, std::span<const Vec3> positions,
                                     std::span<Vec3> forces) noexcept {
    return add_nonbonded_forces(topology, settings, list, {0, list.atoms.size()}, positions,
                                forces);
}

NonbondedEnergy add_nonbonded_forces(const Topology& topology, const NonbondedSettings& settings,
                                     const PairList& list, PairRows rows,
                                     std::span<const Vec3> positions,
                                     std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(!find_problem(settings) && has_end(settings));
    PALPA_ASSERT(find_reach(settings) <= list.cutoff);
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    PALPA_ASSERT(!is_outdated(list, positions));
    const double coulomb = settings.coulomb_constant / settings.dielectric;
    NonbondedEnergy energy = with_law(settings, [&](const auto& law) {
        if constexpr (std::decay_t<decltype(law)>::ends) {
            return add_listed_pairs(topology, law, coulomb, list, rows, positions, forces);
        } else {
            return NonbondedEnergy{};
        }
    });
    if (settings.solvation != SolvationEnd::None) {
        energy.solvation =
            add_solvation_forces(topology, settings.solvation, list, rows, positions, forces);
    }
    return energy;
}

NonbondedEnergy add_pair_forces(const Topology& topology, const NonbondedSettings& settings,
                                std::span<const std::array<std::uint32_t, 2>> pairs,
                                std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(!find_problem(settings));
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    const double coulomb = settings.coulomb_constant / settings.dielectric;
    NonbondedEnergy energy = with_law(settings, [&](const auto& law) {
        return add_given_pairs(topology, topology.lennard_jones, law, coulomb, pairs, positions,
                               forces);
    });
    add_given_solvation(topology, settings, pairs, positions, forces, energy);
    return energy;
}

NonbondedEnergy add_nonbonded14_forces(const Topology& topology, const NonbondedSettings& settings,
                                       std::span<const Vec3> positions,
                                       std::span<Vec3> forces) noexcept {
    return add_pair14_forces(topology, settings, topology.exclusions.pairs14, positions, forces);
}

NonbondedEnergy add_pair14_forces(const Topology& topology, const NonbondedSettings& settings,
                                  std::span<const std::array<std::uint32_t, 2>> pairs,
                                  std::span<const Vec3> positions,
                                  std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(!find_problem(settings));
    PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    const double coulomb =
        settings.coulomb_constant / settings.dielectric * settings.coulomb14_factor;
    NonbondedEnergy energy = with_law(settings, [&](const auto& law) {
        return add_given_pairs(topology, topology.lennard_jones14, law, coulomb, pairs, positions,
                               forces);
    });
    add_given_solvation(topology, settings, pairs, positions, forces, energy);
    return energy;
}

}  // namespace palpa
