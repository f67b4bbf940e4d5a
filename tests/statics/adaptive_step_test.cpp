#include "statics/adaptive_step.h"

#include "tests/support/torsion_case.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

using namespace palpa;

namespace {

using enum BaseFreedom;

// Two peptides near each other.
struct PeptidePair {
    TorsionModel model;
    TorsionState state;
};

PeptidePair peptide_pair(std::array<BaseFreedom, 2> bases) {
    PeptidePair result{
        test::model_of(test::with_copy(test::tetrapeptide(), {12, 5, -2}), {bases[0], bases[1]}),
        {}};
    result.state = test::state_after(result.model, 0.03, 21);
    return result;
}

AdaptiveSettings settings_of(std::size_t active, bool fast, bool ends) {
    AdaptiveSettings settings;
    settings.limits.degrees_of_freedom = active;
    settings.choose_every = 5;
    ForceSettings& forces = settings.step.forces;
    forces.fast = fast;
    if (ends) {
        forces.nonbonded.electrostatics = ElectrostaticCutoff::ForceSwitch;
        forces.nonbonded.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
        forces.nonbonded.cutoff = 9;
        forces.nonbonded.switch_from = 8.8;  // so that no pair is missed
        forces.skin = 0.8;  // so that lists are built often, and cut down in between
        settings.tile_skin = 0.2;
    }
    return settings;
}

// Atoms begin on each other. Where they are 0.5 Å apart, rounding their places to single precision
// is already 1e-5 of the force.
void part_atoms(const TorsionModel& model, TorsionState& state) {
    const QuasiStaticSettings settings = settings_of(0, false, false).step;
    QuasiStatics statics = build_quasi_statics(model);
    update_forces(model, settings.forces, statics.memory, state);
    for (int i = 0; i < 100; ++i) {
        REQUIRE(step_quasi_static(model, settings, state, statics).is_finite);
    }
}

constexpr std::size_t everything = std::numeric_limits<std::size_t>::max();

}  // namespace

TEST_CASE("with everything active an adaptive step is a quasi-static one", "[statics][adaptive]") {
    const auto bases =
        GENERATE(std::array{Held, Free}, std::array{Turning, Free}, std::array{Turning, Held});
    auto [model, state] = peptide_pair(bases);
    TorsionState other = state;
    const AdaptiveSettings settings = settings_of(everything, false, false);
    AdaptiveStatics adaptive = build_adaptive_statics(model);
    QuasiStatics plain = build_quasi_statics(model);
    update_forces(model, settings.step.forces, plain.memory, other);

    for (int i = 0; i < 40; ++i) {
        const AdaptiveReport report = step_adaptive(model, settings, state, adaptive);
        const QuasiStaticReport expected = step_quasi_static(model, settings.step, other, plain);

        CHECK(find_active_freedom(model, adaptive) == static_cast<std::size_t>(model.coordinates));
        REQUIRE(report.step.is_taken == expected.is_taken);
        REQUIRE(report.step.is_bounded == expected.is_bounded);
        REQUIRE(report.step.energy_change ==
                Approx(expected.energy_change).epsilon(1e-5).margin(1e-9));
    }

    CHECK(find_largest_move(state.positions, other.positions) < 1e-6);
    CHECK(state.energy() == Approx(other.energy()).margin(1e-6));
}

TEST_CASE("work where something moves agrees with work on everything", "[statics][adaptive]") {
    const auto bases =
        GENERATE(std::array{Held, Free}, std::array{Turning, Free}, std::array{Turning, Held});
    const std::size_t active = GENERATE(std::size_t{0}, std::size_t{3}, std::size_t{9}, everything);
    const bool fast = GENERATE(false, true), ends = GENERATE(false, true);
    auto [model, state] = peptide_pair(bases);
    const AdaptiveSettings settings = settings_of(active, fast, ends);
    AdaptiveStatics statics = build_adaptive_statics(model);
    if (fast) part_atoms(model, state);
    if (bases[0] == Held) state.tether = Tether{{50, 51, 52}, 20, state.positions[51]};
    CHECK(update_adaptive_forces(model, settings, state, statics));
    double largest = std::abs(state.energy());
    std::vector<Vec3> copied = state.positions;
    std::size_t rebuilds = statics.rebuilds;

    for (int i = 0; i < 60; ++i) {
        if (i % 3 == 0) {
            const Vec3 by(0.02, i < 30 ? 0.01 : -0.04, 0);
            if (state.tether) state.tether->place += by;
            if (bases[0] == Turning) shift_base(model, 0, by, state, statics);
            CHECK(update_adaptive_forces(model, settings, state, statics));
        }
        const double before = state.energy();
        largest = std::max(largest, std::abs(before));
        const AdaptiveReport report = step_adaptive(model, settings, state, statics);
        REQUIRE(report.step.is_finite);
        if (statics.rebuilds != rebuilds) copied = state.positions;
        for (std::size_t c = 0; c < statics.has_moved.size(); ++c) {
            if (statics.has_moved[c] == 0) continue;
            for (const std::uint32_t a : atoms_of(statics.clusters, c))
                copied[a] = state.positions[a];
        }
        std::ranges::fill(statics.has_moved, std::uint8_t{0});
        rebuilds = statics.rebuilds;
        CHECK(copied == state.positions);
        CHECK(report.step.largest_move <= settings.step.largest_move);
        CHECK(find_active_freedom(model, statics) <= active);
        // To rounding, where everything was summed anew.
        if (!fast) CHECK(state.energy() <= before + 1e-13 * largest);
        if (i % 4 != 3) continue;

        const AdaptiveDeviation deviation = find_deviation(model, settings, state, statics);
        INFO("step " << i);
        CHECK(deviation.position < 1e-9);
        CHECK(deviation.force < (fast ? 2e-5 : 1e-9));
        // What was rounded stays until everything is summed anew.
        CHECK(deviation.energy < (fast ? 1e-3 + 1e-7 * largest : 1e-9 + 1e-12 * largest));
    }
    CHECK(statics.choices >= 10);
}

TEST_CASE("a base and a joint that are not chosen keep their places", "[statics][adaptive]") {
    auto [model, state] = peptide_pair({Held, Free});
    const TorsionState start = state;
    const AdaptiveSettings settings = settings_of(2, false, false);
    AdaptiveStatics statics = build_adaptive_statics(model);

    for (int i = 0; i < 4; ++i) CHECK(step_adaptive(model, settings, state, statics).step.is_taken);

    std::size_t turned = 0;
    for (std::size_t b = 0; b < state.angles.size(); ++b) {
        if (state.angles[b] == start.angles[b]) continue;
        CHECK(statics.selection.is_active[b] == 1);
        ++turned;
    }
    CHECK(turned == 2);
    CHECK(state.shifts[1] == start.shifts[1]);
}

TEST_CASE("an adaptive step has the wrench of the others on a molecule", "[statics][adaptive]") {
    auto [model, state] = peptide_pair({Turning, Held});
    const AdaptiveSettings settings = settings_of(6, false, false);
    AdaptiveStatics statics = build_adaptive_statics(model);
    for (int i = 0; i < 7; ++i) (void)step_adaptive(model, settings, state, statics);
    TorsionState full = state;
    ForceMemory memory;
    update_forces(model, settings.step.forces, memory, full);
    Vec6 expected = Vec6::Zero();
    for (std::size_t i = 0; i < full.positions.size() / 2; ++i) {
        expected.head<3>() += full.positions[i].cross(full.forces[i]);
        expected.tail<3>() += full.forces[i];
    }

    CHECK((find_wrench_on(statics, 0) - expected).norm() < 1e-8 * expected.norm());
}
