// Numbers of this file: eq. 2 and eq. 3 of the paper with its constants, worked out to all digits
// shown by an independent program.
#include "haptics/gains.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

using namespace palpa;
using Catch::Matchers::WithinRel;

namespace {

constexpr double nN = 1e-9, pN = 1e-12;
constexpr double six_digits = 5e-7;   // half a unit of the seventh
constexpr double nine_digits = 2e-9;  // the tables carry ten at most

}  // namespace

TEST_CASE("eq. 2 gives the paper's hand force and its slope", "[haptics][gains]") {
    const PrintedForceLaw law({});
    const auto [F_m, F_h, slope] = GENERATE(table<double, double, double>({
        {0.02 * nN, 0.1093011912, 5380403235},
        {0.1 * nN, 0.4707959966, 3514731784},
        {0.2 * nN, 0.7264650284, 1838936589},
        {0.35 * nN, 0.9251238997, 986970721.9},
        {0.5 * nN, 1.049416327, 713829413},
        {0.75 * nN, 1.204573161, 558054121.7},
        {1 * nN, 1.336278122, 503308817.4},
        {1.5 * nN, 1.574363699, 452817075.8},
        {2 * nN, 1.788022645, 398919781.5},
        {3 * nN, 2.119810113, 265150783.7},
        {5 * nN, 2.4659766, 108727820},
        {10 * nN, 2.736634221, 26712164.6},
        {30 * nN, 2.912830461, 2911337.881},
        {100 * nN, 2.973872673, 261320.3102},
        {1000 * nN, 2.9973875, 2612.504257},
    }));
    INFO("F_m = " << F_m);

    CHECK_THAT(law.value(F_m), WithinRel(F_h, nine_digits));
    CHECK_THAT(law.slope(F_m), WithinRel(slope, nine_digits));
}

TEST_CASE("eq. 2 has the slopes that were computed for it, not those the paper's text claims",
          "[haptics][gains]") {
    const PrintedForceLaw law({});

    CHECK_THAT(law.slope(0), WithinRel(5.508036e9, six_digits));
    CHECK_THAT(law.slope(1.5 * nN), WithinRel(4.528171e8, six_digits));
    // α1, δ1, α2, δ2 show through the limits of value and slope: 5.1e9 + 0.64e9/(1 + (δ2 F0)²).
    const double delta_2_times_F_0 = 0.64e9 / (4 / std::numbers::pi) * 1.5 * nN;
    CHECK_THAT(delta_2_times_F_0, WithinRel(0.7540, 1e-4));
    CHECK_THAT(law.slope(0),
               WithinRel(5.1e9 + 0.64e9 / (1 + delta_2_times_F_0 * delta_2_times_F_0), 1e-14));
}

TEST_CASE("eq. 2 is odd to the last bit, monotone, and stays under F_h2", "[haptics][gains]") {
    const PrintedForceLaw law({});
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, 2 * nN);

    for (int i = 0; i < 10000; ++i) {
        const double F = normal(random);
        REQUIRE(law.value(-F) == -law.value(F));
        REQUIRE(law.slope(F) > 0);
        REQUIRE(std::abs(law.value(F)) < 3);
    }
    CHECK(law.value(0) == 0);
    double before = law.slope(0);
    for (double F = 0.01 * nN; F < 20 * nN; F += 0.01 * nN) {
        REQUIRE(law.slope(F) < before);  // the two "linear ranges" are soft: the slope only falls
        before = law.slope(F);
    }
}

TEST_CASE("the slopes of both laws are their derivatives", "[haptics][gains]") {
    const PrintedForceLaw force({});
    const PrintedDisplacementLaw displacement({});
    for (double F = -6.0137 * nN; F < 6 * nN; F += 0.0611 * nN) {
        INFO("F = " << F);
        const double h = 1e-14;
        CHECK_THAT((force.value(F + h) - force.value(F - h)) / (2 * h),
                   WithinRel(force.slope(F), 1e-6));
    }
    for (const double F : {1 * pN, 5 * pN, 15 * pN, 19 * pN, 20 * pN, 21 * pN, 30 * pN, 100 * pN}) {
        INFO("F = " << F);
        const double h = 1e-16;
        const double slope = (displacement.value(F + h) - displacement.value(F - h)) / (2 * h);
        CHECK_THAT(slope, WithinRel(displacement.slope(F), 1e-6));
    }
}

TEST_CASE("eq. 3 gives the paper's displacement gain and its slope", "[haptics][gains]") {
    const PrintedDisplacementLaw law({});
    const auto [F_m, A_d, slope] = GENERATE(table<double, double, double>({
        {1 * pN, 5207994.572, 2.189119164e17},
        {5 * pN, 6316259.568, 3.506465209e17},
        {10 * pN, 8939344.661, 7.846149874e17},
        {15 * pN, 16683822.28, 3.047927451e18},
        {19 * pN, 63280743.47, 3.962305686e19},
        {20 * pN, 125520495.6, 7.924611373e19},
        {21 * pN, 187760247.8, 3.962305686e19},
        {25 * pN, 234357169, 3.047927451e18},
        {30 * pN, 242101646.6, 7.846149874e17},
        {50 * pN, 247359440.6, 8.795351135e16},
        {100 * pN, 249009475.2, 1.238027085e16},
        {350 * pN, 249759861, 7.276894953e14},
        {1000 * pN, 249919136.6, 8.251356853e13},
        {3000 * pN, 249973407.3, 8.923708932e12},
    }));
    INFO("F_m = " << F_m);

    CHECK_THAT(law.value(F_m), WithinRel(A_d, nine_digits));
    CHECK_THAT(law.slope(F_m), WithinRel(slope, nine_digits));
    CHECK(law.value(-F_m) == law.value(F_m));
    CHECK(law.slope(-F_m) == -law.slope(F_m));
}

TEST_CASE("A_d is exactly A_dmin without force and A_dmax in the limit", "[haptics][gains]") {
    const PrintedDisplacementLaw law({});

    CHECK(law.value(0) == 0.005e9);
    CHECK_THAT(law.value(1e300), WithinRel(0.25e9, 1e-14));
    // dA_d/d|F| = β γ / (1 + (F_off γ)²) on both sides of the kink at 0: 1.9762e17 per newton.
    CHECK_THAT(law.slope(1e-20), WithinRel(1.9762e17, 1e-4));
    CHECK_THAT(law.slope(-1e-20), WithinRel(-1.9762e17, 1e-4));
    CHECK(law.slope(0) == 0);
}

TEST_CASE("A_d passes from low to high around F_off", "[haptics][gains]") {
    const PrintedDisplacementLaw law({});
    const auto [share, F_m] = GENERATE(table<double, double>({{0.1, 17.34 * pN},
                                                              {0.5, 20.02 * pN},
                                                              {0.9, 23.13 * pN},
                                                              {0.95, 26.42 * pN},
                                                              {0.99, 52.34 * pN}}));

    const double A_d = 0.005e9 + share * 0.245e9;
    CHECK(law.value(F_m - 0.01 * pN) < A_d);
    CHECK(law.value(F_m + 0.01 * pN) > A_d);
}

TEST_CASE("the gain of a force law is its slope where there is no force", "[haptics][gains]") {
    const ForceLaw printed = PrintedForceLaw({});
    const ForceLaw constant = ConstantForceLaw{0.64e9};
    const ForceLaw none = ConstantForceLaw{0};

    CHECK_THAT(force_gain(printed, 0), WithinRel(5.508036e9, six_digits));
    CHECK_THAT(force_gain(printed, 1e-30), WithinRel(5.508036e9, six_digits));
    CHECK_THAT(force_gain(printed, 1.5 * nN), WithinRel(1.0496e9, 1e-4));
    CHECK(force_gain(constant, 1 * nN) == 0.64e9);
    CHECK(hand_force(constant, -1 * nN) == -0.64);
    CHECK(hand_force(none, 5 * nN) == 0);
    CHECK(force_gain(none, 0) == 0);
}
