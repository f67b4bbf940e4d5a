// Solvation in what statics makes of the force field: the model that is exact near the hand, and
// work where something moves.
#include "field/processor.h"
#include "statics/adaptive_step.h"
#include "statics/fast_second_derivatives.h"
#include "statics/linearised_model.h"
#include "statics/near_pairs.h"
#include "statics/relax_joints.h"
#include "tests/support/torsion_case.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// The first of two solvated tetrapeptides on a hand that moves its base, which may turn; relaxed.
struct SolvatedHand {
    TorsionModel model =
        test::model_of(test::with_copy(test::solvated(test::tetrapeptide()), {14, 9, -6}),
                       {BaseFreedom::Turning, BaseFreedom::Free});
    TorsionState state = build_torsion_state(model);
    HeldParts held;
    ForceSettings settings{.nonbonded = eef1_settings()};

    SolvatedHand() {
        held.hands = {{.molecule = 0}};
        held.atoms.resize(model.masses.size() / 2);
        std::iota(held.atoms.begin(), held.atoms.end(), 0U);
        const auto half = static_cast<std::uint32_t>(held.atoms.size());
        for (const std::uint32_t atom : {half, half + half / 2, 2 * half - 1}) {
            state.springs.push_back({.atoms = {atom}, .k = 5, .place = state.positions[atom]});
        }
        RelaxSettings to_rest;
        to_rest.step.forces = settings;
        to_rest.force_tolerance = 1e-4;
        to_rest.steps = 20000;
        QuasiStatics statics = build_quasi_statics(model);
        CHECK(relax_joints(model, to_rest, state, statics).rms_force < 1e-3);
    }

    LinearisedModel linearised() const {
        Lineariser lineariser = build_lineariser(model, held);
        LinearisedModel linear;
        REQUIRE(linearise(model, {settings, 8, {}}, state, lineariser, linear));
        return linear;
    }
};

}  // namespace

TEST_CASE("near pairs have their solvation, in single precision and in double",
          "[statics][second-order][solvation]") {
    const SolvatedHand c;
    NearPairs near = build_near_pairs(c.model, c.state.positions, c.held.atoms, 8);
    // Each once, and every one across of atoms that count and are near.
    std::vector<std::array<std::uint32_t, 2>> pairs = near.solvated;
    for (auto& pair : pairs) std::ranges::sort(pair);
    std::ranges::sort(pairs);
    CHECK(std::ranges::adjacent_find(pairs) == pairs.end());
    const auto half = static_cast<std::uint32_t>(c.held.atoms.size());
    const std::vector<double>& volume = c.model.topology.solvation->volume;
    for (std::uint32_t i = 0; i < half; ++i) {
        for (std::uint32_t j = half; j < 2 * half; ++j) {
            const bool is_near = std::ranges::any_of(c.held.atoms, [&](std::uint32_t k) {
                return (c.state.positions[k] - c.state.positions[j]).norm() < 8;
            });
            CHECK(std::ranges::binary_search(pairs, std::array{i, j}) ==
                  (is_near && volume[i] != 0 && volume[j] != 0));
        }
    }
    std::vector<Vec3> forces(2 * half, Vec3::Zero()), fast = forces;
    ForceSettings settings = c.settings;
    const double energy = add_near_forces(c.model, settings, near, c.state.positions, forces);
    settings.fast = true;
    const double fast_energy = add_near_forces(c.model, settings, near, c.state.positions, fast);
    CHECK(fast_energy == Approx(energy).epsilon(1e-5));
    for (std::size_t i = 0; i < forces.size(); ++i) CHECK((fast[i] - forces[i]).norm() < 1e-3);
}

TEST_CASE("a linearised model with solvation is the whole energy, to second order",
          "[statics][second-order][solvation]") {
    const SolvatedHand c;
    const LinearisedModel linear = c.linearised();
    const Eigen::Index size = linear.coordinates.size();
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    Eigen::VectorXd way(size);
    for (double& x : way) x = normal(random);
    way.normalize();
    const auto errors = [&](double length) {
        TorsionState state = c.state;
        NearPairs near = linear.near;
        ModelValue model;
        evaluate_model(c.model, c.settings, linear, length * way, near, state, model);
        TorsionState there = c.state;
        place_about(c.model, linear.coordinates, linear.at, length * way, there);
        ForceMemory memory;
        update_forces(c.model, c.settings, memory, there);
        const Eigen::VectorXd gradient =
            find_gradient(c.model, linear.coordinates, linear.at, length * way, there);
        return std::array{std::abs(model.energy - there.energy()),
                          (model.gradient - gradient).norm()};
    };
    const auto far = errors(0.04), near = errors(0.02);
    CHECK(std::log2(far[0] / near[0]) == Approx(3).margin(0.5));
    CHECK(std::log2(far[1] / near[1]) == Approx(2).margin(0.4));
}

TEST_CASE("work where something moves has all solvation", "[statics][adaptive][solvation]") {
    const bool fast = GENERATE(false, true);
    const std::size_t active = GENERATE(std::size_t{3}, std::size_t{1000});
    SolvatedHand c;
    AdaptiveSettings settings;
    settings.limits.degrees_of_freedom = active;
    settings.choose_every = 5;
    settings.step.forces = c.settings;
    settings.step.forces.fast = fast;
    settings.step.forces.skin = 0.8;  // so that lists are built often
    settings.tile_skin = 0.2;
    AdaptiveStatics statics = build_adaptive_statics(c.model);
    for (int i = 0; i < 60; ++i) {
        if (i % 3 == 0) {
            shift_base(c.model, 0, {0.03, i < 30 ? 0.02 : -0.05, 0}, c.state, statics);
            REQUIRE(update_adaptive_forces(c.model, settings, c.state, statics));
        }
        REQUIRE(step_adaptive(c.model, settings, c.state, statics).step.is_finite);
        if (i % 4 != 3) continue;
        const AdaptiveDeviation deviation = find_deviation(c.model, settings, c.state, statics);
        INFO("step " << i);
        CHECK(deviation.position < 1e-9);
        CHECK(deviation.force < (fast ? 2e-5 : 1e-9));
        CHECK(deviation.energy < (fast ? 1e-2 : 1e-8));
    }
    CHECK(c.state.terms.solvation < 0);
    if (fast) CHECK(statics.memory.fast_pairs.in_double == 0);
}

TEST_CASE("fast second derivatives with solvation are those of the double sums",
          "[statics][hessian][fast][solvation]") {
    const std::vector<std::string> kinds = list_processor_kinds();
    const std::string kind = kinds[GENERATE(range(0, 4)) % kinds.size()];
    INFO(kind);
    // All of it, and solvation alone, of which single precision takes no digits for the rest.
    test::FlexibleCase peptides =
        test::with_copy(test::solvated(test::tetrapeptide()), {14, 9, -6});
    const bool is_alone = GENERATE(false, true);
    if (is_alone) {
        std::ranges::fill(peptides.topology.charge, 0);
        for (LennardJonesPair& pair : peptides.topology.lennard_jones.pairs) pair.epsilon = 0;
    }
    const TorsionModel model =
        test::model_of(peptides, {BaseFreedom::Turning, BaseFreedom::Free}, test::all_joints);
    TorsionState state = test::state_after(model, 0.03, 21);
    state.springs.push_back({.atoms = {70, 82, 64}, .k = 15, .place = {1, -2, 20}});
    const LocalCoordinates coordinates =
        build_local_coordinates(model, std::vector<HandHold>{{.molecule = 0}});
    const FastSecondDerivatives fast = build_fast_second_derivatives(model, coordinates);
    const auto both_of = [&](const NonbondedSettings& settings) {
        std::array<SecondDerivatives, 2> both;
        SecondDerivativesMemory memory;
        use_processor_kind(kind);
        CHECK(update_fast_second_derivatives(model, coordinates, fast, settings, state, memory,
                                             both[0]));
        use_processor_kind(kinds.front());
        update_second_derivatives(model, coordinates, fast.paths, settings, state, both[1]);
        return both;
    };
    const auto largest = [](const Eigen::MatrixXd& m) { return m.cwiseAbs().maxCoeff(); };

    const auto water = both_of(eef1_settings());
    const auto vacuum = both_of(eef1_settings(SolvationEnd::None));

    for (const auto& both : {water, vacuum})
        CHECK(largest(both[0].all - both[1].all) < 1e-6 * largest(both[1].all));
    const Eigen::MatrixXd fast_part = water[0].all - vacuum[0].all;
    const Eigen::MatrixXd part = water[1].all - vacuum[1].all;
    CHECK(largest(part) > 1);
    if (is_alone) CHECK(largest(fast_part - part) < 1e-6 * largest(part));
}
