#include "forces/solvation.h"

#include "core/assertion.h"
#include "core/repeatable.h"
#include "forces/solvation_law.h"

#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

// Calls visit(i, j) for every plain pair of atoms that count, in rising order.
template <class Visit>
void visit_plain_pairs(const Topology& topology, const Visit& visit) {
    const Solvation& solvation = *topology.solvation;
    const auto counts = [&](std::size_t atom) { return solvation_atom(solvation, atom).counts(); };
    const auto n = static_cast<std::uint32_t>(topology.size());
    for (std::uint32_t i = 0; i < n; ++i) {
        if (!counts(i)) continue;
        std::uint32_t j = i + 1;
        const auto visit_up_to = [&](std::uint32_t end) {
            for (; j < end; ++j) {
                if (counts(j)) visit(i, j);
            }
        };
        for (const std::uint32_t excluded : topology.exclusions.of(i)) {
            visit_up_to(excluded);
            ++j;
        }
        visit_up_to(n);
    }
}

class SolvationSum {
public:
    SolvationSum(const Topology& topology, SolvationEnd end, std::span<const Vec3> positions,
                 std::span<Vec3> forces) noexcept
        : solvation_(*topology.solvation), law_(end), positions_(positions), forces_(forces) {
        PALPA_ASSERT(positions.size() == topology.size() && forces.size() == topology.size());
    }

    void add(std::uint32_t i, std::uint32_t j) noexcept {
        const Vec3 d = positions_[i] - positions_[j];
        const double distance2 = d.squaredNorm();
        if (!(distance2 < law_.reach2)) return;
        const SolvationAtom a = solvation_atom(solvation_, i);
        if (!a.counts()) return;
        const SolvationPair pair = law_.evaluate(distance2, a, solvation_atom(solvation_, j));
        energy += pair.energy_a + pair.energy_b;
        const Vec3 force = -pair.first * d;
        forces_[i] += force;
        forces_[j] -= force;
    }

    double energy = 0;

private:
    const Solvation& solvation_;
    SolvationLaw<> law_;
    std::span<const Vec3> positions_;
    std::span<Vec3> forces_;
};

struct TabulatedExponential {
    double operator()(double x) const noexcept {
        constexpr double steps = 100, end = 350, digits = 1e5;
        const double n = std::floor(steps * std::abs(x));
        if (n >= end) return 0;
        const double at = (n + 0.5) / steps;
        return std::round(digits * repeatable::exp(-at * at)) / digits;
    }
};

template <class Law>
std::vector<double> find_energies(const Topology& topology, const Law& law,
                                  std::span<const Vec3> positions) {
    const Solvation& solvation = *topology.solvation;
    std::vector<double> energies = solvation.dg_ref;
    const auto add = [&](std::uint32_t i, std::uint32_t j) {
        const SolvationPair pair =
            law.evaluate((positions[i] - positions[j]).squaredNorm(), solvation_atom(solvation, i),
                         solvation_atom(solvation, j));
        energies[i] += pair.energy_a;
        energies[j] += pair.energy_b;
    };
    visit_plain_pairs(topology, add);
    for (const auto& [i, j] : topology.exclusions.pairs14) add(i, j);
    return energies;
}

}  // namespace

double find_solvation_reach(SolvationEnd end) noexcept {
    return std::sqrt(SolvationLaw<>(end).reach2);
}

double find_lone_solvation(const Topology& topology, SolvationEnd end) noexcept {
    if (end == SolvationEnd::None) return 0;
    PALPA_ASSERT(topology.solvation);
    double sum = 0;
    for (const double dg_ref : topology.solvation->dg_ref) sum += dg_ref;
    return sum;
}

double add_solvation_forces(const Topology& topology, SolvationEnd end,
                            std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(topology.solvation);
    SolvationSum sum(topology, end, positions, forces);
    visit_plain_pairs(topology, [&](std::uint32_t i, std::uint32_t j) { sum.add(i, j); });
    return sum.energy;
}

double add_solvation_forces(const Topology& topology, SolvationEnd end, const PairList& list,
                            PairRows rows, std::span<const Vec3> positions,
                            std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(topology.solvation && find_solvation_reach(end) <= list.cutoff);
    SolvationSum sum(topology, end, positions, forces);
    for (std::size_t row = rows.begin; row < rows.end; ++row) {
        const std::uint32_t i = list.atoms[row];
        if (!solvation_atom(*topology.solvation, i).counts()) continue;
        for (const std::uint32_t j : list.neighbours_of(row)) sum.add(i, j);
    }
    return sum.energy;
}

double add_solvation_forces(const Topology& topology, SolvationEnd end,
                            std::span<const std::array<std::uint32_t, 2>> pairs,
                            std::span<const Vec3> positions, std::span<Vec3> forces) noexcept {
    PALPA_ASSERT(topology.solvation);
    SolvationSum sum(topology, end, positions, forces);
    for (const auto& [i, j] : pairs) sum.add(i, j);
    return sum.energy;
}

std::vector<double> find_solvation_energies(const Topology& topology, SolvationEnd end,
                                            std::span<const Vec3> positions,
                                            SolvationExponential exponential) {
    PALPA_ASSERT(topology.solvation && positions.size() == topology.size());
    if (exponential == SolvationExponential::Table)
        return find_energies(topology, SolvationLaw(end, TabulatedExponential{}), positions);
    return find_energies(topology, SolvationLaw(end), positions);
}

}  // namespace palpa
