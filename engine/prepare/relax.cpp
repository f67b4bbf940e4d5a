#include "prepare/relax.h"

#include "forces/minimise.h"
#include "forces/pair_list.h"

#include <algorithm>
#include <limits>
#include <thread>

namespace palpa {
namespace {

constexpr double cutoff = 9;     // Å
constexpr double skin = 2;       // Å
constexpr double restraint = 5;  // kcal/mol/Å^2
// Two, whatever the machine has: results repeat for a number of threads.
constexpr std::size_t threads = 2;

// Charges are screened as by 4 r: in vacuum salt bridges would pull side chains through the water
// that is not there.
NonbondedSettings short_ranged() {
    NonbondedSettings settings;
    settings.dielectric = 4;
    settings.distance_dielectric = true;
    settings.electrostatics = ElectrostaticCutoff::Shift;
    settings.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
    settings.switch_from = 7;
    settings.cutoff = cutoff;
    return settings;
}

EnergyTerms find_energy(const Topology& topology, std::span<const Vec3> positions) {
    const PairList list = build_pair_list(topology.exclusions, cutoff, skin, positions);
    std::vector<Vec3> forces(positions.size(), Vec3::Zero());
    return add_forces(topology, short_ranged(), list, positions, forces, threads);
}

std::size_t steps_for(std::size_t atoms) {
    constexpr std::size_t atom_steps = 8'000'000;
    return std::clamp<std::size_t>(atom_steps / std::max<std::size_t>(atoms, 1), 50, 300);
}

AtomContact find_largest_move(std::span<const Vec3> before, std::span<const Vec3> after,
                              std::span<const double> k) {
    AtomContact largest;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double distance = (after[i] - before[i]).norm();
        if (k[i] > 0 && distance > largest.distance) {
            largest = {static_cast<std::uint32_t>(i), 0, distance};
        }
    }
    return largest;
}

}  // namespace

std::optional<AtomContact> find_closest_contact(const Topology& topology,
                                                std::span<const Vec3> positions) {
    constexpr double reach = 4;  // Å
    const PairList list = build_pair_list(topology.exclusions, reach, 0, positions);
    std::optional<AtomContact> closest;
    double least = reach;
    for (std::size_t row = 0; row < list.atoms.size(); ++row) {
        const std::uint32_t a = list.atoms[row];
        for (const std::uint32_t b : list.neighbours_of(row)) {
            const double distance = (positions[a] - positions[b]).norm();
            if (!(distance < least)) continue;
            least = distance;
            closest = AtomContact{std::min(a, b), std::max(a, b), distance};
        }
    }
    return closest;
}

ClashReport relax(const Topology& topology, std::span<const std::uint8_t> is_built,
                  std::span<const std::uint8_t> is_hydrogen, std::vector<Vec3>& positions,
                  const std::function<void(double share)>& progress) {
    ClashReport report;
    report.before = find_energy(topology, positions);
    report.closest_before = find_closest_contact(topology, positions);
    const std::vector<Vec3> given = positions;
    MinimiseSettings settings;
    settings.nonbonded = short_ranged();
    settings.skin = skin;
    settings.steps = steps_for(positions.size());
    settings.threads = threads;
    const auto part = [&](double from) {
        return [&progress, &settings, from](std::size_t step, double) {
            progress(from + 0.5 * static_cast<double>(step) / static_cast<double>(settings.steps));
        };
    };

    std::vector<std::uint8_t> is_fixed(is_built.begin(), is_built.end());
    for (std::uint8_t& flag : is_fixed) flag = flag == 0 ? 1 : 0;
    const MinimiseReport built =
        minimise(topology, settings, {{}, {}, is_fixed}, positions, part(0));

    std::vector<double> k(positions.size(), 0);
    for (std::size_t i = 0; i < k.size(); ++i) {
        if (is_built[i] == 0 && is_hydrogen[i] == 0) k[i] = restraint;
    }
    const MinimiseReport all = minimise(topology, settings, {k, given, {}}, positions, part(0.5));
    report.steps = built.steps + all.steps;
    report.rms_force = all.rms_force;
    report.after = find_energy(topology, positions);
    report.closest_after = find_closest_contact(topology, positions);
    report.largest_move = find_largest_move(given, positions, k);
    return report;
}

}  // namespace palpa
