// Numbers of this file: eq. 2 and eq. 3 of the paper with its constants, and the power law, worked
// out to all digits shown by an independent program.
#include "haptics/gains.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

using namespace palpa;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double nN = 1e-9, pN = 1e-12;
constexpr double six_digits = 5e-7;   // half a unit of the seventh
constexpr double nine_digits = 2e-9;  // the tables carry ten at most
constexpr double infinity = std::numeric_limits<double>::infinity();

PrintedForceLaw calibrated_law() { return PrintedForceLaw::find_calibrated({}).value(); }

// From 1e-15 N to 100 nN in even steps of the logarithm, on both sides.
std::vector<double> forces_of_all_sizes() {
    std::vector<double> forces;
    for (double exponent = -15; exponent < -7; exponent += 0.0137) {
        forces.push_back(std::pow(10, exponent));
        forces.push_back(-forces.back());
    }
    return forces;
}

// A symmetric matrix with these eigenvalues, turned out of the axes.
Mat3 turned(const Vec3& eigenvalues, const Eigen::Quaterniond& turn) {
    const Mat3 axes = turn.normalized().toRotationMatrix();
    return axes * eigenvalues.asDiagonal() * axes.transpose();
}

std::vector<ForceLaw> force_laws() {
    return {PrintedForceLaw({}),
            calibrated_law(),
            ConstantForceLaw{0.64e9},
            PerceptualForceLaw({}),
            PerceptualForceLaw({1e-9, 2.5e-9}),
            PerceptualForceLaw::for_range(20 * pN, 3 * nN),
            PerceptualForceLaw::for_range(1 * nN, 2.5 * nN)};
}

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

TEST_CASE("the slope of eq. 2 is its derivative", "[haptics][gains]") {
    const PrintedForceLaw force({});
    for (double F = -6.0137 * nN; F < 6 * nN; F += 0.0611 * nN) {
        INFO("F = " << F);
        const double h = 1e-14;
        CHECK_THAT((force.value(F + h) - force.value(F - h)) / (2 * h),
                   WithinRel(force.slope(F), 1e-6));
    }
}

TEST_CASE("eq. 3 gives the paper's displacement gain", "[haptics][gains]") {
    const PrintedDisplacementLaw law({});
    const auto [F_m, A_d] = GENERATE(table<double, double>({
        {1 * pN, 5207994.572},
        {5 * pN, 6316259.568},
        {10 * pN, 8939344.661},
        {15 * pN, 16683822.28},
        {19 * pN, 63280743.47},
        {20 * pN, 125520495.6},
        {21 * pN, 187760247.8},
        {25 * pN, 234357169},
        {30 * pN, 242101646.6},
        {50 * pN, 247359440.6},
        {100 * pN, 249009475.2},
        {350 * pN, 249759861},
        {1000 * pN, 249919136.6},
        {3000 * pN, 249973407.3},
    }));
    INFO("F_m = " << F_m);

    CHECK_THAT(law.value(F_m), WithinRel(A_d, nine_digits));
    CHECK(law.value(-F_m) == law.value(F_m));
}

TEST_CASE("A_d is exactly A_dmin without force and A_dmax in the limit", "[haptics][gains]") {
    const PrintedDisplacementLaw law({});

    CHECK(law.value(0) == 0.005e9);
    CHECK_THAT(law.value(1e300), WithinRel(0.25e9, 1e-14));
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

TEST_CASE("eq. 2 calibrated has the slopes that the paper's text claims", "[haptics][gains]") {
    const PrintedForceLaw law = calibrated_law();

    CHECK_THAT(law.slope(0), WithinRel(5.1e9, 1e-13));
    CHECK_THAT(law.slope(1.5 * nN), WithinRel(0.64e9, 1e-13));
    CHECK_THAT(law.value(1.5 * nN), WithinAbs(1.699, 5e-4));
    CHECK_THAT(law.value(10 * nN), WithinAbs(2.835, 5e-4));
    // δ1, δ2 of the table, 0.91874 and 1.65154 times the printed ones.
    const double alpha = 2 / std::numbers::pi, delta_1 = 7.360113e9, delta_2 = 8.301549e8;
    for (const double F : {0.01 * nN, 0.3 * nN, 1 * nN, 2 * nN, 6 * nN}) {
        INFO("F = " << F);
        const double expected =
            alpha * (std::atan(delta_1 * F) + std::atan(delta_2 * (F - 1.5 * nN)) +
                     std::atan(delta_2 * (F + 1.5 * nN)));
        CHECK_THAT(law.value(F), WithinRel(expected, six_digits));
    }
}

TEST_CASE("calibration holds for other parameters", "[haptics][gains]") {
    const auto p = GENERATE(PrintedForceLaw::Parameters{.A_fmin = 2e9},
                            PrintedForceLaw::Parameters{.A_fmin = 0.2e9},
                            PrintedForceLaw::Parameters{.F_0 = 5e-9, .A_fmin = 0.3e9},
                            PrintedForceLaw::Parameters{.A_fmin = 6.4e9, .A_fmax = 51e9},
                            PrintedForceLaw::Parameters{.F_h1 = 0.5, .F_h2 = 1.2, .A_fmax = 20e9},
                            PrintedForceLaw::Parameters{.F_h1 = 2.9, .A_fmin = 0.5e9});
    INFO(p.F_h1 << " " << p.F_h2 << " " << p.F_0 << " " << p.A_fmin << " " << p.A_fmax);

    const auto law = PrintedForceLaw::find_calibrated(p);

    REQUIRE(law);
    CHECK_THAT(law->slope(0), WithinRel(p.A_fmax, 1e-12));
    CHECK_THAT(law->slope(p.F_0), WithinRel(p.A_fmin, 1e-12));
    CHECK_THAT(law->value(1e10 * p.F_0), WithinRel(p.F_h2, 1e-8));
    for (double F = 0; F < 10 * p.F_0; F += 0.01 * p.F_0) REQUIRE(law->slope(F) > 0);
}

TEST_CASE("parameters without two ranges have no calibrated law", "[haptics][gains]") {
    const auto p = GENERATE(
        PrintedForceLaw::Parameters{.A_fmin = 1e7},  // low forces alone are steeper at F_0
        PrintedForceLaw::Parameters{.F_0 = 0.2e-9},  // low forces end beyond F_0
        // A_fmax F_0 is 0.7: above α1 = 2/π and α1 - α2, below α1 + α2 = 3/π.
        PrintedForceLaw::Parameters{
            .F_h1 = 1, .F_h2 = 2, .F_0 = 1e-9, .A_fmin = 0.5e9, .A_fmax = 0.7e9},
        PrintedForceLaw::Parameters{.F_h1 = 3, .F_h2 = 3}, PrintedForceLaw::Parameters{.F_h1 = 0},
        PrintedForceLaw::Parameters{.F_0 = 0}, PrintedForceLaw::Parameters{.A_fmin = 0},
        PrintedForceLaw::Parameters{.A_fmin = -1e9}, PrintedForceLaw::Parameters{.A_fmax = -1e9},
        PrintedForceLaw::Parameters{.A_fmax = infinity},
        PrintedForceLaw::Parameters{.A_fmin = std::numeric_limits<double>::quiet_NaN()});

    CHECK_FALSE(PrintedForceLaw::find_calibrated(p));
}

TEST_CASE("the perceptual law is linear, then a power law, then bounded", "[haptics][gains]") {
    const PerceptualForceLaw law({});
    const auto [F_m, F_h] = GENERATE(table<double, double>({
        {1 * pN, 0.015},
        {5 * pN, 0.075},
        {10 * pN, 0.15},
        {20 * pN, 0.27317915231411943},
        {40 * pN, 0.41253086150626617},
        {100 * pN, 0.6285294284280717},
        {322 * pN, 1.07573543803979},
        {1 * nN, 1.8107778256079845},
        {3 * nN, 3.0},
        {6 * nN, 3.246384487120924},
        {10 * nN, 3.274408384816666},
        {100 * nN, 3.2979944440056252},
    }));
    INFO("F_m = " << F_m);

    CHECK_THAT(law.value(F_m), WithinRel(F_h, 1e-13));
    CHECK(law.value(-F_m) == -law.value(F_m));
}

TEST_CASE("the perceptual law gives equally many noticeable steps per decade", "[haptics][gains]") {
    const PerceptualForceLaw law({});
    const auto steps = [&](double low, double high) {
        return std::log(law.value(high) / law.value(low)) / std::log(1.09);
    };

    // 10 times the force over log10(150) = 2.176 decades, in steps of 9 %.
    CHECK_THAT(steps(0.05 * nN, 0.5 * nN), WithinRel(26.7192 / 2.17609, 1e-5));
    CHECK_THAT(steps(0.3 * nN, 3 * nN), WithinRel(26.7192 / 2.17609, 1e-5));
    // The joint takes away less than a step.
    CHECK(PerceptualForceLaw::Parameters{}.F_h_lo - law.value(20 * pN) < 0.05);
}

TEST_CASE("the perceptual law's pieces join in value and slope", "[haptics][gains]") {
    const auto p =
        GENERATE(PerceptualForceLaw::Parameters{}, PerceptualForceLaw::Parameters{1e-12, 100e-9},
                 PerceptualForceLaw::Parameters{1e-9, 2.5e-9});
    const PerceptualForceLaw law(p);

    for (const double joint : {p.F_lo / 2, 2 * p.F_lo, p.F_hi}) {
        INFO("at " << joint);
        const double below = joint * (1 - 1e-12), above = joint * (1 + 1e-12);
        CHECK_THAT(law.value(below), WithinRel(law.value(above), 1e-11));
        CHECK_THAT(law.slope(below), WithinRel(law.slope(above), 1e-10));
    }
    CHECK_THAT(law.value(p.F_hi), WithinRel(3.0, 1e-14));
    CHECK_THAT(law.slope(0), WithinRel(0.3 / p.F_lo, 1e-14));
    CHECK(law.value(0) == 0);
    CHECK(law.value(infinity) == p.F_h_limit);
    CHECK(law.slope(infinity) == 0);
}

TEST_CASE("a range that must be felt gives a power law with its joint below", "[haptics][gains]") {
    const auto law = PerceptualForceLaw::for_range(20 * pN, 3 * nN);
    // ln 9/ln 150 = 0.438515 is the power; 0.3 N 2^-power at 10 pN is where the joint is.
    const double power = std::log(9.0) / std::log(150.0);

    CHECK(law.value(20 * pN) >= 0.3);
    CHECK_THAT(law.value(20 * pN), WithinRel(0.3, 1e-13));
    CHECK(law.value(3 * nN) == 2.7);
    CHECK_THAT(law.value(200 * pN), WithinRel(0.3 * std::pow(10, power), 1e-13));
    CHECK_THAT(law.value(std::sqrt(20e-12 * 3e-9)), WithinRel(0.9, 1e-13));
    CHECK_THAT(law.slope(3 * nN), WithinRel(power * 2.7 / (3 * nN), 1e-13));
    CHECK_THAT(law.slope(0), WithinRel(0.3 * std::pow(2, -power) / (10 * pN), 1e-13));
    CHECK_THAT(law.value(5 * pN), WithinRel(law.slope(0) * 5 * pN, 1e-13));
    CHECK(law.value(infinity) == 3);
}

TEST_CASE("a narrow range that must be felt gives a linear law", "[haptics][gains]") {
    const double F_lo = 100 * pN, F_hi = GENERATE(101 * pN, 300 * pN, 900 * pN);
    const auto law = PerceptualForceLaw::for_range(F_lo, F_hi);

    for (const double share : {0.001, 0.03, 0.12, 0.3, 0.7, 0.999}) {
        INFO("at " << share << " of F_hi");
        CHECK_THAT(law.value(share * F_hi), WithinRel(2.7 * share, 1e-13));
        CHECK_THAT(law.slope(share * F_hi), WithinRel(2.7 / F_hi, 1e-12));
    }
    CHECK(law.value(F_lo) >= 0.3);
    CHECK(law.value(F_hi) == 2.7);
}

TEST_CASE("whatever range must be felt is, and below the clamp", "[haptics][gains]") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> log_lo(-13, -8), log_ratio(0.001, 6);

    for (int i = 0; i < 2000; ++i) {
        const double F_lo = std::pow(10, log_lo(random)),
                     F_hi = F_lo * std::pow(10, log_ratio(random));
        const auto law = PerceptualForceLaw::for_range(F_lo, F_hi);
        INFO("from " << F_lo << " to " << F_hi);
        REQUIRE(law.value(F_lo) >= 0.3);
        REQUIRE(law.value(F_hi) <= 2.7);
        REQUIRE(law.value(1e4 * F_hi) < 3);
        double before = 0;
        for (double F = F_lo / 100; F < 100 * F_hi; F *= 1.07) {
            const double h = 1e-6 * F;
            REQUIRE(law.value(F) > before);
            REQUIRE(law.slope(F) > 0);
            // Pieces join in value and slope, so differences hold across their ends too; above F_hi
            // forces near 3 N leave them fewer digits.
            if (F < F_hi)
                REQUIRE_THAT((law.value(F + h) - law.value(F - h)) / (2 * h),
                             WithinRel(law.slope(F), 1e-5));
            REQUIRE(law.value(-F) == -law.value(F));
            before = law.value(F);
        }
    }
}

TEST_CASE("force laws are odd and monotone, and slopes are their derivatives", "[haptics][gains]") {
    const auto law = GENERATE(from_range(force_laws()));
    INFO("law " << law.index());

    for (const double F : forces_of_all_sizes()) {
        INFO("F = " << F);
        const double h = 1e-5 * std::abs(F);
        const double after = hand_force(law, F + h), before = hand_force(law, F - h);
        REQUIRE(after > before);
        REQUIRE(hand_force(law, -F) == -hand_force(law, F));
        REQUIRE(hand_force_slope(law, -F) == hand_force_slope(law, F));
        REQUIRE_THAT(force_gain(law, F), WithinRel(hand_force(law, F) / F, 1e-14));
        // Above 10 nN the difference of two forces of nearly 3 N has not the digits.
        if (std::abs(F) > 10 * nN) continue;
        REQUIRE_THAT((after - before) / (2 * h), WithinRel(hand_force_slope(law, F), 1e-6));
    }
}

TEST_CASE("the Jacobian of a hand force in space is its derivative", "[haptics][gains]") {
    const auto law = GENERATE(ForceLaw(PrintedForceLaw({})), ForceLaw(calibrated_law()),
                              ForceLaw(ConstantForceLaw{0.64e9}), ForceLaw(PerceptualForceLaw({})));
    const double size = GENERATE(3 * pN, 30 * pN, 300 * pN, 3.3 * nN);
    INFO("law " << law.index() << ", " << size << " N");
    const Vec3 F = size * Vec3(0.3, -0.8, 0.5);
    const auto felt = [&](const Vec3& f) -> Vec3 {
        return hand_force(law, f.norm()) * f.normalized();
    };

    const Mat3 jacobian = force_jacobian(law, F);

    const double h = 1e-5 * size;
    for (int i = 0; i < 3; ++i) {
        const Vec3 step = h * Vec3::Unit(i);
        const Vec3 difference = (felt(F + step) - felt(F - step)) / (2 * h);
        CHECK((difference - jacobian.col(i)).norm() < 1e-6 * jacobian.norm());
    }
}

TEST_CASE("without force the Jacobian is the slope in all directions", "[haptics][gains]") {
    const ForceLaw law = PrintedForceLaw({});
    const Mat3 at_0 = 5.508036e9 * Mat3::Identity();

    CHECK(force_jacobian(law, Vec3::Zero()).isApprox(at_0, six_digits));
    CHECK(force_jacobian(law, Vec3(1e-100, -1e-200, 0)).isApprox(at_0, six_digits));
    CHECK(force_jacobian(law, Vec3(0, 0, 1e-17)).isApprox(at_0, six_digits));
}

TEST_CASE("the largest felt stiffness bounds that of every direction", "[haptics][gains]") {
    const ForceLaw law = PrintedForceLaw({});
    const Mat3 stiffness = turned({29.3, -2.5, 4}, {0.9, 0.2, -0.3, 0.1});
    const Vec3 F = Vec3(0.2, -0.5, 0.9) * nN;

    const double largest = largest_felt(law, F, stiffness);

    const Mat3 felt = force_jacobian(law, F) * stiffness;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    double closest = 0;
    for (int i = 0; i < 200000; ++i) {
        const Vec3 n = Vec3(normal(random), normal(random), normal(random)).normalized();
        closest = std::max(closest, n.dot(felt * n));
    }
    CHECK(closest <= largest * (1 + 1e-12));
    CHECK(closest > 0.999 * largest);
}

TEST_CASE("the felt stiffness is slope times stiffness along the force, gain times it across",
          "[haptics][gains]") {
    const ForceLaw law = PrintedForceLaw({});
    const Vec3 F(1.5 * nN, 0, 0);

    CHECK_THAT(largest_felt(law, F, Vec3(100, 0, 0).asDiagonal()),
               WithinRel(100 * 4.528171e8, six_digits));
    CHECK_THAT(largest_felt(law, F, Vec3(0, 100, 0).asDiagonal()),
               WithinRel(100 * 1.574363699 / (1.5 * nN), nine_digits));
    CHECK(largest_felt(law, F, Vec3(-1, -2, -3).asDiagonal()) == 0);
    CHECK(largest_felt(law, F, Mat3::Zero()) == 0);
    CHECK(largest_felt(law, F, Mat3::Constant(std::nan(""))) == infinity);
    CHECK(largest_felt(law, Vec3::Constant(infinity), Mat3::Identity()) == infinity);
}

TEST_CASE("the cap raises A_d until the hand feels K_cap", "[haptics][gains]") {
    const ForceLaw law = PrintedForceLaw({});
    // The water dimer's equilibrium: 29.3 N/m make 646 N/m at A_dmax, and want 8.1e8 for 200.
    const double felt = largest_felt(law, Vec3::Zero(), Vec3(29.3, 0, 0).asDiagonal());
    CHECK_THAT(felt / 0.25e9, WithinAbs(646, 0.7));

    const double A_d = capped_gain(0.25e9, felt, 200);

    CHECK_THAT(A_d, WithinRel(8.1e8, 0.005));
    CHECK_THAT(felt / A_d, WithinRel(200.0, 1e-14));
    CHECK(capped_gain(0.25e9, felt, 700) == 0.25e9);
    CHECK(capped_gain(0.25e9, 0, 200) == 0.25e9);
    CHECK(capped_gain(0.25e9, infinity, 200) == infinity);
}

TEST_CASE("eq. 3 repaired has no notch in contact and leaves free space alone",
          "[haptics][gains]") {
    const DisplacementLaw repaired = RepairedDisplacementLaw({});
    const DisplacementLaw printed = PrintedDisplacementLaw({});

    CHECK_THAT(displacement_gain(repaired, 0, 29.3), WithinRel(0.25e9, 0.01));
    // Two waters 6.24 Å apart: 20 pN, 0.12 N/m make 0.6 pN, 0.04 N/m make 0.2 pN.
    CHECK_THAT(displacement_gain(repaired, 20 * pN, 0.04), WithinRel(1.2552e8, 1e-3));
    CHECK(displacement_gain(repaired, 0, 0.04) < 1.01 * 0.005e9);
    for (const double F : forces_of_all_sizes()) {
        REQUIRE_THAT(displacement_gain(repaired, F),
                     WithinRel(displacement_gain(printed, F), 1e-15));
        REQUIRE(displacement_gain(repaired, F, 3) >= displacement_gain(repaired, F));
        REQUIRE(displacement_gain(repaired, F, -3) == displacement_gain(repaired, F, 3));
        REQUIRE(displacement_gain(repaired, -F, 3) == displacement_gain(repaired, F, 3));
    }
}

TEST_CASE("the printed and the constant displacement law do not look at the stiffness",
          "[haptics][gains]") {
    const DisplacementLaw printed = PrintedDisplacementLaw({});
    const DisplacementLaw constant = ConstantDisplacementLaw{1e8};

    CHECK(displacement_gain(printed, 15 * pN, 29.3) == displacement_gain(printed, 15 * pN));
    CHECK(displacement_gain(constant, 15 * pN, 29.3) == 1e8);
}
