// What can just be told apart follows from the force law and from what a hand can tell apart.
#include "tools/lab/experiments/forced_choice.h"

#include "core/draws.h"
#include "haptics/gains.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// Of the waters.
constexpr double rest_angstrom = 2.7667, strongest_newton = 0.322e-9;

// Neither friction nor a delay worth speaking of, and a hand that follows its way.
ForcedChoiceOptions waters(Question question, std::vector<CouplingMode> modes) {
    ForcedChoiceOptions options;
    options.study.scene = test::in_project("scenes/water");
    options.study.settings = {"hand.grip=firm", "device.friction_N=0", "run.period_ms=1"};
    options.study.modes = std::move(modes);
    options.question = question;
    return options;
}

ForceLaw law_of(CouplingMode mode) {
    if (mode == CouplingMode::ConstantForceConstantDisplacement) return ConstantForceLaw{0.64e9};
    return PrintedForceLaw({});
}

// ln of the ratio at which the felt force is noticeably larger, and smaller: the mean of both.
double predict_threshold(const ForceLaw& law) {
    const double felt = hand_force(law, strongest_newton), step = noticeable_newton(felt);
    const auto force_that_feels_like = [&](double newton) {
        double low = 0, high = 100 * strongest_newton;
        while (high - low > 1e-12 * high) {
            const double middle = 0.5 * (low + high);
            (hand_force(law, middle) < newton ? low : high) = middle;
        }
        return low;
    };
    return 0.5 * std::log(force_that_feels_like(felt + step) / force_that_feels_like(felt - step));
}

}  // namespace

TEST_CASE("the strongest pull that is felt is the law's of the strongest attraction",
          "[experiments][coupling]") {
    const auto mode = GENERATE(CouplingMode::VariableForceConstantDisplacement,
                               CouplingMode::ConstantForceConstantDisplacement);
    const double ratio = GENERATE(0.6, 1.0, 2.0);
    const ForcedChoiceOptions options = waters(Question::AttractsMore, {mode});
    Draws draws(1, 0);

    const Impression felt = feel_molecule(options, mode, rest_angstrom, ratio, draws);

    const double expected = hand_force(law_of(mode), ratio * strongest_newton);
    CHECK(felt.value == felt.force_newton);
    CHECK(felt.value == Approx(expected).epsilon(0.03));
}

TEST_CASE("with constant gains stiffness is felt in proportion, guarded it is capped",
          "[experiments][coupling]") {
    // Near the rest the waters' spring is 29.3 N/m: 75 N/m at the hand, and more further in.
    const auto feel = [](CouplingMode mode, double ratio) {
        Draws draws(1, 0);
        return feel_molecule(waters(Question::Stiffer, {mode}), mode, rest_angstrom, ratio, draws)
            .value;
    };
    constexpr auto constant = CouplingMode::ConstantForceConstantDisplacement;
    const double once = feel(constant, 1), twice = feel(constant, 2);
    const double guarded_once = feel(CouplingMode::Guarded, 1);
    const double guarded_twice = feel(CouplingMode::Guarded, 2);

    CHECK(once > 75);
    CHECK(twice / once > 1.5);
    CHECK(guarded_once < 205);  // K_cap is 200 N/m
    CHECK(guarded_twice < 205);
    CHECK(guarded_twice / guarded_once < 1.2);
}

TEST_CASE("the fitted threshold is the one that the force law predicts", "[experiments][long]") {
    const auto mode = GENERATE(CouplingMode::VariableForceConstantDisplacement,
                               CouplingMode::ConstantForceConstantDisplacement);
    ForcedChoiceOptions options = waters(Question::AttractsMore, {mode});
    options.study.operators = 8;

    const PsychometricFit fit = fit_psychometric(count_answers(mode, play_choices(options)));

    const double predicted = predict_threshold(law_of(mode));
    INFO("threshold " << fit.curve.threshold() << " ± " << fit.threshold_error << ", predicted "
                      << predicted);
    REQUIRE(fit.end == PsychometricEnd::Found);
    CHECK(fit.threshold_error < 0.2 * predicted);
    CHECK(std::abs(fit.curve.threshold() - predicted) < 2.5 * fit.threshold_error);
    CHECK(std::abs(fit.curve.middle) < 2.5 * fit.middle_error);
}

TEST_CASE("choices are the same whatever modes are played beside", "[experiments][coupling]") {
    constexpr auto one = CouplingMode::ConstantForceConstantDisplacement;
    constexpr auto other = CouplingMode::VariableForceConstantDisplacement;
    const auto choose = [](std::vector<CouplingMode> modes, std::size_t repeats) {
        ForcedChoiceOptions options = waters(Question::AttractsMore, std::move(modes));
        options.study.settings.emplace_back("run.period_ms=14");
        options.study.operators = 2;
        options.repeats = repeats;
        std::vector<Choice> own;
        for (const Choice& choice : play_choices(options))
            if (choice.mode == one && own.size() < 10) own.push_back(choice);
        return own;
    };
    const std::vector<Choice> alone = choose({one}, 1);
    REQUIRE(alone.size() == 10);

    const std::vector<Choice> first = choose({one, other}, 1), last = choose({other, one}, 2);

    for (std::size_t i = 0; i < alone.size(); ++i) {
        for (const Choice& choice : {first[i], last[i]}) {
            CHECK(choice.reference == alone[i].reference);
            CHECK(choice.comparison == alone[i].comparison);
            CHECK(choice.is_more == alone[i].is_more);
        }
    }
}

TEST_CASE("without force nobody can tell", "[experiments][coupling]") {
    ForcedChoiceOptions options = waters(Question::AttractsMore, {CouplingMode::NoForce});
    options.study.operators = 1;

    const PsychometricFit fit =
        fit_psychometric(count_answers(CouplingMode::NoForce, play_choices(options)));

    CHECK(fit.end == PsychometricEnd::TooFlat);
}
