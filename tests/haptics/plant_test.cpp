#include "haptics/plant.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <tuple>

using namespace palpa;
using Catch::Matchers::WithinRel;

TEST_CASE("a free handle under a held force moves as the closed form says", "[haptics][plant]") {
    const double M = 0.045, B = 0.1, T = 0.01, F = 0.3;
    const SampledPlant plant = sample_plant(build_plant({M, B}, std::nullopt), T);

    const Eigen::Vector2d state = plant.A * Eigen::Vector2d(0.01, 0.2) + plant.B * Eigen::Vector2d(F, 0);

    const double e = std::exp(-B * T / M), end = F / B;
    CHECK_THAT(state(1), WithinRel(end + (0.2 - end) * e, 1e-12));
    CHECK_THAT(state(0), WithinRel(0.01 + end * T + (0.2 - end) * M / B * (1 - e), 1e-12));
}

TEST_CASE("a held handle comes to rest where springs balance", "[haptics][plant]") {
    const auto grip = GENERATE(Grip::Light, Grip::Slack, Grip::Medium, Grip::Firm, Grip::FirmGrip);
    const HandModel hand = *hand_model(grip);
    const SampledPlant plant = sample_plant(build_plant({}, hand), 0.05);
    const double force = 0.7, target = 0.02;

    PlantState state = PlantState::Zero(plant.A.rows());
    for (int i = 0; i < 4000; ++i) {
        state = (plant.A * state + plant.B * Eigen::Vector2d(force, hand.stiffness_N_per_m * target)).eval();
    }

    CHECK_THAT(state(0), WithinRel(target + force / static_stiffness(hand), 1e-9));
    CHECK(state(1) == Approx(0).margin(1e-12));
}

// Largest stable K of the sampled loop, N/m, for periods of 1, 5, 14, 33 and 83 ms; a reference
// computed by another program.
TEST_CASE("the sampled loop loses stability where the reference says", "[haptics][plant]") {
    const auto [viscosity, grip, period_ms, K] = GENERATE(table<double, Grip, double, double>({
        {0.1, Grip::None, 1, 66.7},     {0.1, Grip::None, 5, 13.4},     {0.1, Grip::None, 14, 4.80},
        {0.1, Grip::None, 33, 2.06},    {0.1, Grip::None, 83, 0.842},   {0.5, Grip::None, 1, 334},
        {0.5, Grip::None, 5, 67.7},     {0.5, Grip::None, 14, 24.8},    {0.5, Grip::None, 33, 11.0},
        {0.5, Grip::None, 83, 4.80},    {2.0, Grip::None, 1, 1350},     {2.0, Grip::None, 5, 282},
        {2.0, Grip::None, 14, 109},     {2.0, Grip::None, 33, 51.2},    {2.0, Grip::None, 83, 22.7},
        {0.1, Grip::Light, 1, 735},     {0.1, Grip::Light, 5, 149},     {0.1, Grip::Light, 14, 55.4},
        {0.1, Grip::Light, 33, 27.3},   {0.1, Grip::Light, 83, 22.4},   {0.1, Grip::Slack, 1, 734},
        {0.1, Grip::Slack, 5, 147},     {0.1, Grip::Slack, 14, 53.2},   {0.1, Grip::Slack, 33, 23.6},
        {0.1, Grip::Slack, 83, 11.9},   {0.1, Grip::Medium, 1, 2750},   {0.1, Grip::Medium, 5, 568},
        {0.1, Grip::Medium, 14, 226},   {0.1, Grip::Medium, 33, 137},   {0.1, Grip::Medium, 83, 148},
        {0.1, Grip::Firm, 1, 6792},     {0.1, Grip::Firm, 5, 1419},     {0.1, Grip::Firm, 14, 586},
        {0.1, Grip::Firm, 33, 385},     {0.1, Grip::Firm, 83, 394},
    }));
    INFO("viscosity " << viscosity << ", grip " << static_cast<int>(grip) << ", " << period_ms << " ms");

    const Plant plant = build_plant({0.045, viscosity}, hand_model(grip));

    CHECK_THAT(find_critical_stiffness(plant, period_ms * 1e-3), WithinRel(K, 0.02));
}

TEST_CASE("for little damping the limit is B/(1.5 T_s), whatever the mass", "[haptics][plant]") {
    const auto mass = GENERATE(0.02, 0.045, 0.5);

    const double K = find_critical_stiffness(build_plant({mass, 0.1}, std::nullopt), 1e-3);

    CHECK_THAT(K, WithinRel(0.1 / (1.5 * 1e-3), 0.005));
}
