#include "tools/lab/experiments/psychometric.h"

#include "core/draws.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace palpa;

namespace {

constexpr std::array levels{-0.8, -0.4, -0.2, -0.1, -0.05, 0.05, 0.1, 0.2, 0.4, 0.8};

// Made without the curve's own code: lapses are drawn as lapses.
std::vector<AnsweredLevel> answer(double middle, double width, std::size_t each, Draws& draws) {
    std::vector<AnsweredLevel> answered;
    for (const double level : levels) {
        AnsweredLevel at{level, each, 0};
        for (std::size_t i = 0; i < each; ++i) {
            const bool lapses = draws.between(0, 1) < lapse_share;
            const bool more =
                lapses ? draws.below(2) == 0 : level + width * draws.normal() > middle;
            if (more) ++at.more;
        }
        answered.push_back(at);
    }
    return answered;
}

// What is answered by somebody who is always right, or always says one thing.
template <class More>
std::vector<AnsweredLevel> answer_all(const More& more) {
    std::vector<AnsweredLevel> answered;
    for (const double level : levels) answered.push_back({level, 20, more(level)});
    return answered;
}

void check_numbers(const PsychometricFit& fit) {
    for (const double value : {fit.curve.middle, fit.curve.width, fit.curve.threshold(),
                               fit.curve.slope(), fit.middle_error, fit.threshold_error})
        CHECK(std::isfinite(value));
}

}  // namespace

TEST_CASE("from many answers the curve they were drawn from is found",
          "[experiments][psychometric]") {
    const double middle = GENERATE(-0.1, 0.0, 0.15);
    const double width = GENERATE(0.08, 0.3);
    Draws draws(1, 0);

    const PsychometricFit fit = fit_psychometric(answer(middle, width, 20'000, draws));

    REQUIRE(fit.end == PsychometricEnd::Found);
    CHECK(fit.curve.middle == Approx(middle).margin(0.006));
    CHECK(fit.curve.width == Approx(width).epsilon(0.03));
    CHECK(fit.curve.threshold() == Approx(0.67449 * width).epsilon(0.03));
    // Of Φ itself, by its difference.
    const double h = 1e-4, m = fit.curve.middle;
    CHECK(fit.curve.slope() * (1 - lapse_share) ==
          Approx((fit.curve.share(m + h) - fit.curve.share(m - h)) / (2 * h)).epsilon(1e-5));
}

TEST_CASE("from few answers it is missed by its standard error", "[experiments][psychometric]") {
    constexpr double middle = 0.05, width = 0.25;
    constexpr int studies = 400;
    Draws draws(2, 0);
    double middle_squares = 0, threshold_squares = 0;

    for (int i = 0; i < studies; ++i) {
        const PsychometricFit fit = fit_psychometric(answer(middle, width, 40, draws));
        REQUIRE(fit.end == PsychometricEnd::Found);
        middle_squares += std::pow((fit.curve.middle - middle) / fit.middle_error, 2);
        threshold_squares +=
            std::pow((fit.curve.threshold() - 0.67449 * width) / fit.threshold_error, 2);
    }

    // Mean of 400 squares that are 1 on average: a standard error of 0.07, and what is not normal.
    CHECK(middle_squares / studies == Approx(1).margin(0.3));
    CHECK(threshold_squares / studies == Approx(1).margin(0.3));
}

TEST_CASE("the likelihood's derivatives are its differences", "[experiments][psychometric]") {
    Draws draws(3, 0);
    const std::vector<AnsweredLevel> answered = answer(0.1, 0.2, 30, draws);
    const PsychometricCurve curve{GENERATE(-0.2, 0.1, 0.5), GENERATE(0.1, 0.4)};
    const double h = 1e-5;

    const LogLikelihood at = find_log_likelihood(curve, answered);

    const auto value = [&](double middle, double log_width) {
        return find_log_likelihood({curve.middle + middle, curve.width * std::exp(log_width)},
                                   answered)
            .value;
    };
    CHECK(at.gradient[0] == Approx((value(h, 0) - value(-h, 0)) / (2 * h)).epsilon(1e-6));
    CHECK(at.gradient[1] == Approx((value(0, h) - value(0, -h)) / (2 * h)).epsilon(1e-6));
}

TEST_CASE("nothing near the curve that was found is more likely", "[experiments][psychometric]") {
    Draws draws(4, 0);
    const std::vector<AnsweredLevel> answered = answer(0.05, 0.2, 15, draws);

    const PsychometricFit fit = fit_psychometric(answered);

    REQUIRE(fit.end == PsychometricEnd::Found);
    const LogLikelihood at = find_log_likelihood(fit.curve, answered);
    CHECK(std::abs(at.gradient[0]) < 1e-3);
    CHECK(std::abs(at.gradient[1]) < 1e-3);
    for (double middle = -1; middle < 1; middle += 0.02)
        for (double width = 0.02; width < 4; width *= 1.1)
            CHECK(find_log_likelihood({middle, width}, answered).value <= at.value);
}

TEST_CASE("answers that tell no width are said to, and are no NaN", "[experiments][psychometric]") {
    const PsychometricFit right =
        fit_psychometric(answer_all([](double level) { return level > 0 ? 20U : 0U; }));
    const PsychometricFit wrong =
        fit_psychometric(answer_all([](double level) { return level > 0 ? 0U : 20U; }));
    const PsychometricFit always = fit_psychometric(answer_all([](double) { return 20U; }));
    const PsychometricFit never = fit_psychometric(answer_all([](double) { return 0U; }));
    const PsychometricFit guessed = fit_psychometric(answer_all([](double) { return 10U; }));
    // 60 of 100 at most.
    const PsychometricFit hardly = fit_psychometric(answer_all([](double level) {
        return level > 0.3 ? 12U : level < -0.3 ? 8U : 10U;
    }));
    const PsychometricFit nothing = fit_psychometric({});
    const std::vector<AnsweredLevel> same{{0.1, 20, 15}, {0.1, 10, 9}};
    const PsychometricFit one = fit_psychometric(same);

    CHECK(right.end == PsychometricEnd::TooSteep);
    for (const PsychometricFit& fit : {wrong, always, never, guessed, hardly, nothing, one})
        CHECK(fit.end == PsychometricEnd::TooFlat);
    for (const PsychometricFit& fit : {right, wrong, always, never, guessed, hardly, nothing, one})
        check_numbers(fit);
}
