#include "haptics/plant.h"

#include "tests/support/critical_stiffness.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <optional>

using namespace palpa;
using Catch::Matchers::WithinRel;

TEST_CASE("a free handle under a held force moves as the closed form says", "[haptics][plant]") {
    const double M = 0.045, B = 0.1, T = 0.01, F = 0.3;
    const SampledPlant plant = sample_plant(build_plant({M, B}, std::nullopt), T);

    const Eigen::Vector2d state =
        plant.A * Eigen::Vector2d(0.01, 0.2) + plant.B * Eigen::Vector2d(F, 0);

    const double e = std::exp(-B * T / M), end = F / B;
    CHECK_THAT(state(1), WithinRel(end + (0.2 - end) * e, 1e-12));
    CHECK_THAT(state(0), WithinRel(0.01 + end * T + (0.2 - end) * M / B * (1 - e), 1e-12));
}

TEST_CASE("a held handle comes to rest where springs balance", "[haptics][plant]") {
    const auto grip = GENERATE(HandGrip::Light, HandGrip::Slack, HandGrip::Medium, HandGrip::Firm,
                               HandGrip::FirmGrip);
    const HandModel hand = *hand_model(grip);
    const SampledPlant plant = sample_plant(build_plant({}, hand), 0.05);
    const double force = 0.7, target = 0.02;

    PlantState state = PlantState::Zero(plant.A.rows());
    for (int i = 0; i < 4000; ++i) {
        state =
            (plant.A * state + plant.B * Eigen::Vector2d(force, hand.stiffness_N_per_m * target))
                .eval();
    }

    CHECK_THAT(state(0), WithinRel(target + force / static_stiffness(hand), 1e-9));
    CHECK(state(1) == Approx(0).margin(1e-12));
}

TEST_CASE("the sampled loop loses stability where the reference says", "[haptics][plant]") {
    const test::CriticalStiffness reference = GENERATE(from_range(test::critical_stiffness));
    INFO(reference.viscosity << " Ns/m, " << grip_names[static_cast<std::size_t>(reference.grip)]
                             << ", " << reference.period_ms << " ms");

    const Plant plant = build_plant({0.045, reference.viscosity}, hand_model(reference.grip));

    CHECK_THAT(critical_stiffness(plant, static_cast<double>(reference.period_ms) * 1e-3),
               WithinRel(reference.K, 0.02));
}

TEST_CASE("for little damping the limit is B/(1.5 T_s), whatever the mass", "[haptics][plant]") {
    const auto mass = GENERATE(0.02, 0.045, 0.5);

    const double K = critical_stiffness(build_plant({mass, 0.1}, std::nullopt), 1e-3);

    CHECK_THAT(K, WithinRel(0.1 / (1.5 * 1e-3), 0.005));
}
