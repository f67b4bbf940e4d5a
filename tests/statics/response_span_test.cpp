#include "statics/response_span.h"

#include "tests/statics/held_pair.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <optional>
#include <random>

using namespace palpa;
using palpa::test::HeldPair;
using palpa::test::model_at;

namespace {

LinearisedModel linearised(const HeldPair& c, std::size_t responses) {
    Lineariser lineariser = build_lineariser(c.model, c.held);
    SecondOrderSettings settings = c.settings;
    settings.responses = responses;
    LinearisedModel linear;
    REQUIRE(linearise(c.model, settings, c.state, lineariser, linear));
    return linear;
}

SecondDerivatives derivatives_of(const HeldPair& c, const LinearisedModel& linear) {
    SecondDerivatives derivatives;
    update_second_derivatives(c.model, linear.coordinates, build_model_paths(c.model),
                              c.settings.forces.nonbonded, c.state, derivatives);
    return derivatives;
}

}  // namespace

TEST_CASE("a span of responses holds those to the hand, each combination of curvature one",
          "[statics][second-order]") {
    const HeldPair c;
    const LinearisedModel linear = linearised(c, 12);
    const Eigen::MatrixXd& basis = linear.span->basis;
    CHECK(basis.cols() <= 12);
    CHECK(basis.cols() > 6);
    CHECK(linear.mobile() == basis.cols());

    const SecondDerivatives derivatives = derivatives_of(c, linear);
    const Eigen::MatrixXd curvature = basis.transpose() * derivatives.of_mobile() * basis;
    CHECK((curvature - Eigen::MatrixXd::Identity(basis.cols(), basis.cols())).norm() < 1e-6);
    CHECK((basis * linear.span->response - linear.response).norm() < 1e-6 * linear.response.norm());
    const Eigen::MatrixXd exact =
        -derivatives.of_mobile().ldlt().solve(Eigen::MatrixXd(derivatives.mixed()));
    CHECK((linear.response - exact).norm() < 1e-6 * exact.norm());
}

TEST_CASE("in the span of its responses a model is what it is among all coordinates",
          "[statics][second-order]") {
    const HeldPair c;
    const LinearisedModel whole = c.linearised(), few = linearised(c, 12);
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> part(-0.01, 0.01);
    for (int i = 0; i < 20; ++i) {
        const Eigen::VectorXd at =
            Eigen::VectorXd::NullaryExpr(few.gradient.size(), [&] { return part(engine); });
        const Eigen::VectorXd all = few.span->expand(at);
        const ModelValue value = model_at(c, few, at), expected = model_at(c, whole, all);
        CHECK(value.energy == Approx(expected.energy).margin(1e-6));
        const Eigen::VectorXd gradient = few.span->reduce(expected.gradient);
        CHECK((value.gradient - gradient).norm() < 1e-5 * (1 + gradient.norm()));
        TorsionState one = c.state, other = c.state;
        place_by(c.model, few, at, one);
        place_about(c.model, whole.coordinates, whole.at, all, other);
        CHECK(one.positions == other.positions);
    }
}

TEST_CASE("more responses come nearer to the rest of the model among all coordinates",
          "[statics][second-order]") {
    const Vec3 way = Vec3::Unit(GENERATE(0, 1, 2));
    struct End {
        double energy;
        Vec3 force;
    };
    const auto end_with = [&](std::optional<std::size_t> responses) -> End {
        HeldPair c;
        c.settings.responses = responses;
        c.settings.renew_hand = c.settings.farthest_hand;
        SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
        start_second_order(c.model, c.settings, c.state, statics);
        c.move_hand(0.2 * way);
        for (std::size_t i = 1; i < c.settings.still_steps; ++i) {
            REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
        }
        REQUIRE(statics.renewed == 1);  // at the start
        return {statics.value.energy, find_hand_pull(statics, 0).tail<3>()};
    };
    const End hand_only = end_with(0), few = end_with(9), more = end_with(24), all = end_with({});
    constexpr double rounding = 1e-5;  // kcal/mol, of pairs in single precision
    CHECK(few.energy < hand_only.energy + rounding);
    CHECK(more.energy < few.energy + rounding);
    CHECK(all.energy < more.energy + rounding);
    INFO((hand_only.force - all.force).norm()
         << " " << (few.force - all.force).norm() << " " << (more.force - all.force).norm());
    CHECK(more.energy - all.energy < 0.1 * (hand_only.energy - all.energy) + rounding);
    CHECK((more.force - all.force).norm() < 0.3 * (hand_only.force - all.force).norm());
}
