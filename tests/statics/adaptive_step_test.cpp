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

// What two hands do to the first two molecules between two steps: one is moved, the other moved and
// turned.
struct TwoHands {
    Vec3 first, second;
    Eigen::Quaterniond turn;
};

TwoHands hands_at(int step) {
    const double back = step < 20 ? 1 : -2;
    return {
        Vec3(0.03, 0.02, 0) * back, Vec3(-0.02, 0, 0.01) * back,
        Eigen::Quaterniond(Eigen::AngleAxisd(0.004 * back, Vec3(1, -2, 0.5 * step).normalized()))};
}

constexpr std::size_t everything = std::numeric_limits<std::size_t>::max();

}  // namespace

TEST_CASE("with everything active an adaptive step is a quasi-static one", "[statics][adaptive]") {
    const auto bases =
        GENERATE(std::array{Held, Free}, std::array{Turning, Free}, std::array{Turning, Held});
    const bool ends = GENERATE(false, true);
    auto [model, state] = test::peptide_pair(bases);
    TorsionState other = state;
    const AdaptiveSettings settings = settings_of(everything, false, ends);
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
    // Sums and lists of pairs are those of the other; one sum is that of the first choice.
    CHECK(adaptive.rebuilds == 1);
    CHECK(adaptive.memory.evaluations == plain.memory.evaluations + 1);
    REQUIRE(adaptive.memory.list.positions.empty() == !ends);
    CHECK(find_largest_move(adaptive.memory.list.positions, plain.memory.list.positions) < 1e-6);
}

TEST_CASE("how many joints may be active changes between steps", "[statics][adaptive]") {
    const bool fast = GENERATE(false, true), ends = GENERATE(false, true);
    auto [model, state] = test::peptide_pair({Turning, Free});
    AdaptiveSettings settings = settings_of(everything, fast, ends);
    settings.choose_every = 2;
    if (fast) part_atoms(model, state);
    AdaptiveStatics statics = build_adaptive_statics(model);
    const auto all = static_cast<std::size_t>(model.coordinates);

    for (int i = 0; i < 72; ++i) {
        const bool is_everything = i / 12 % 2 == 0;
        settings.limits.degrees_of_freedom = is_everything ? all : 7;
        if (i % 3 == 0) {
            shift_base(model, 0, {0.03, i < 40 ? 0.02 : -0.05, 0}, state, statics);
            REQUIRE(update_adaptive_forces(model, settings, state, statics));
        }
        REQUIRE(step_adaptive(model, settings, state, statics).step.is_finite);
        INFO("step " << i);
        if (i % 12 > 2) {
            if (is_everything) CHECK(find_active_freedom(model, statics) == all);
            if (!is_everything) CHECK(find_active_freedom(model, statics) <= 7);
        }
        const AdaptiveDeviation deviation = find_deviation(model, settings, state, statics);
        CHECK(deviation.position < 1e-9);
        CHECK(deviation.force < (fast ? 2e-5 : 1e-9));
    }
}

TEST_CASE("atoms out of all reach are told, with everything active and without",
          "[statics][adaptive]") {
    const std::size_t active = GENERATE(std::size_t{5}, everything);
    const bool fast = GENERATE(false, true), ends = GENERATE(false, true);
    auto [model, state] = test::peptide_pair({Turning, Free});
    const AdaptiveSettings settings = settings_of(active, fast, ends);
    AdaptiveStatics statics = build_adaptive_statics(model);
    shift_base(model, 0, {0, 0, 0}, state, statics);
    REQUIRE(update_adaptive_forces(model, settings, state, statics));
    const double energy = state.energy();
    const double away = GENERATE(2e6, 1e300, std::numeric_limits<double>::quiet_NaN());

    const Vec3 start = state.shifts[0];
    shift_base(model, 0, {away, 0, 0}, state, statics);
    CHECK_FALSE(update_adaptive_forces(model, settings, state, statics));

    // Mended by the caller.
    state.shifts[0] = start;
    update_positions(model, state);
    CHECK(update_adaptive_forces(model, settings, state, statics));
    CHECK(state.energy() == Approx(energy).epsilon(1e-5));
}

TEST_CASE("work where something moves agrees with work on everything", "[statics][adaptive]") {
    const auto bases =
        GENERATE(std::array{Held, Free}, std::array{Turning, Free}, std::array{Turning, Held});
    const std::size_t active = GENERATE(std::size_t{0}, std::size_t{3}, std::size_t{9}, everything);
    const bool fast = GENERATE(false, true), ends = GENERATE(false, true);
    auto [model, state] = test::peptide_pair(bases);
    const AdaptiveSettings settings = settings_of(active, fast, ends);
    AdaptiveStatics statics = build_adaptive_statics(model);
    if (fast) part_atoms(model, state);
    if (bases[0] == Held) state.springs = {{{50, 51, 52}, 20, state.positions[51]}};
    CHECK(update_adaptive_forces(model, settings, state, statics));
    double largest = std::abs(state.energy());
    std::vector<Vec3> copied = state.positions;
    std::size_t rebuilds = statics.rebuilds;

    for (int i = 0; i < 60; ++i) {
        if (i % 3 == 0) {
            const Vec3 by(0.02, i < 30 ? 0.01 : -0.04, 0);
            for (ModelSpring& spring : state.springs) spring.place += by;
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
    auto [model, state] = test::peptide_pair({Held, Free});
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
    auto [model, state] = test::peptide_pair({Turning, Held});
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

TEST_CASE("two hands move and turn a molecule each", "[statics][adaptive]") {
    // Beside a third that moves by itself, and one that is fixed.
    const auto bases =
        GENERATE(std::vector{Turning, Held, Free, Held}, std::vector{Turning, Turning, Free, Held},
                 std::vector{Held, Free, Free, Held});
    const std::size_t active = GENERATE(std::size_t{0}, std::size_t{8}, everything);
    const bool fast = GENERATE(false, true), ends = GENERATE(false, true);
    const TorsionModel model = test::model_of(
        test::with_copy(test::with_copy(test::alanine_dipeptide(), {7, 3, -2}), {-3, 9, 4}), bases);
    TorsionState state = test::state_after(model, 0.03, 4);
    const AdaptiveSettings settings = settings_of(active, fast, ends);
    if (fast) part_atoms(model, state);
    AdaptiveStatics statics = build_adaptive_statics(model);
    REQUIRE(update_adaptive_forces(model, settings, state, statics));

    for (int i = 0; i < 40; ++i) {
        const TwoHands hands = hands_at(i);
        const std::vector<Vec3> before = state.positions;
        shift_base(model, 0, hands.first, state, statics);
        turn_base(model, 1, hands.turn, hands.second, state, statics);

        const std::size_t atoms = before.size() / 4;
        Vec3 pivot = before[atoms];
        if (bases[1] == Free) {
            pivot.setZero();
            for (std::size_t a = atoms; a < 2 * atoms; ++a)
                pivot += model.masses[a] / model.molecule_masses[1] * before[a];
        }
        for (std::size_t a = 0; a < before.size(); ++a) {
            Vec3 expected = before[a];
            if (a < atoms) expected += hands.first;
            if (a / atoms == 1) expected = pivot + hands.turn * (before[a] - pivot) + hands.second;
            REQUIRE((state.positions[a] - expected).norm() < 1e-12);
        }

        REQUIRE(update_adaptive_forces(model, settings, state, statics));
        REQUIRE(step_adaptive(model, settings, state, statics).step.is_finite);
        const AdaptiveDeviation deviation = find_deviation(model, settings, state, statics);
        INFO("step " << i);
        CHECK(deviation.position < 1e-9);
        CHECK(deviation.force < (fast ? 2e-5 : 1e-9));
        TorsionState full = state;
        ForceMemory memory;
        update_forces(model, settings.step.forces, memory, full);
        for (const std::size_t molecule : {std::size_t{0}, std::size_t{1}}) {
            Vec6 expected = Vec6::Zero();
            for (std::size_t a = molecule * atoms; a < (molecule + 1) * atoms; ++a) {
                expected.head<3>() += full.positions[a].cross(full.forces[a]);
                expected.tail<3>() += full.forces[a];
            }
            // What its atoms do to each other is rounded and cancels.
            const double size = test::stacked(full.forces).norm() * 20;
            CHECK((find_wrench_on(statics, molecule) - expected).norm() <
                  (fast ? 1e-5 : 1e-9) * size);
            CHECK((find_wrench_on(model, full, molecule) - expected).norm() < 1e-12 * size);
        }
    }
    CHECK(statics.is_guided == std::vector<std::uint8_t>{1, 1, 0, 0});
}

TEST_CASE("with everything active two hands lead to where they lead a quasi-static step",
          "[statics][adaptive]") {
    const auto bases =
        GENERATE(std::array{Turning, Held}, std::array{Turning, Turning}, std::array{Held, Free});
    auto [model, state] = test::peptide_pair(bases);
    TorsionState other = state;
    const AdaptiveSettings settings = settings_of(everything, false, false);
    AdaptiveStatics adaptive = build_adaptive_statics(model);
    QuasiStatics plain = build_quasi_statics(model);
    const std::vector<Vec3> start = state.positions;

    for (int i = 0; i < 30; ++i) {
        const TwoHands hands = hands_at(i);
        shift_base(model, 0, hands.first, state, adaptive);
        turn_base(model, 1, hands.turn, hands.second, state, adaptive);
        REQUIRE(update_adaptive_forces(model, settings, state, adaptive));
        const AdaptiveReport report = step_adaptive(model, settings, state, adaptive);
        shift_base(model, 0, hands.first, other);
        turn_base(model, 1, hands.turn, hands.second, other);
        update_forces(model, settings.step.forces, plain.memory, other);
        const QuasiStaticReport expected = step_quasi_static(model, settings.step, other, plain);

        REQUIRE(report.step.is_taken == expected.is_taken);
        REQUIRE(report.step.energy_change ==
                Approx(expected.energy_change).epsilon(1e-5).margin(1e-9));
    }

    CHECK(find_largest_move(start, state.positions) > 0.2);
    CHECK(find_largest_move(state.positions, other.positions) < 1e-6);
}
