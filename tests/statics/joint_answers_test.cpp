#include "statics/joint_answers.h"

#include "tests/statics/held_pair.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

using namespace palpa;
using palpa::test::HeldPair;

namespace {

double norm_of(const std::vector<double>& values) {
    return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0));
}

// What complete relaxation, the hand where it is, yet turns every joint.
std::vector<double> turns_to_rest(HeldPair c) {
    const std::vector<double> before = c.state.angles;
    c.relax(1e-7);
    std::vector<double> turns;
    for (std::size_t i = 0; i < before.size(); ++i)
        turns.push_back(std::abs(c.state.angles[i] - before[i]));
    return turns;
}

std::vector<double> only_joints(const TorsionModel& model, const std::vector<double>& values) {
    std::vector<double> of_joints;
    for (std::size_t body = 0; body < values.size(); ++body)
        if (model.coordinate_of_body[body] >= 0) of_joints.push_back(values[body]);
    return of_joints;
}

std::vector<double> ranks_of(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
    std::vector<double> ranks(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = static_cast<double>(i);
    return ranks;
}

// Spearman's.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const std::vector<double> x = ranks_of(a), y = ranks_of(b);
    const double middle = 0.5 * (static_cast<double>(x.size()) - 1);
    double both = 0, own = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        both += (x[i] - middle) * (y[i] - middle);
        own += (x[i] - middle) * (x[i] - middle);
    }
    return both / own;
}

}  // namespace

TEST_CASE("beyond first order is the angle less the linear answer, of second order in the way",
          "[statics][second-order]") {
    const auto beyond_after = [](double way) {
        HeldPair c(1e-8);
        c.settings.evaluations = 40;
        c.settings.rest = 1e-7;
        SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
        start_second_order(c.model, c.settings, c.state, statics);
        const TorsionState start = c.state;
        c.move_hand(Vec3(way, 0, 0));
        REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
        REQUIRE(statics.renewed == 1);
        const std::vector<double> beyond = find_beyond_first_order(c.model, statics);
        // By the angles themselves.
        const Eigen::VectorXd linear = way * statics.linear->response.col(0);
        for (std::size_t body = 0; body < beyond.size(); ++body) {
            const Eigen::Index coordinate = c.model.coordinate_of_body[body];
            const double expected =
                coordinate < 0 ? 0 : c.state.angles[body] - start.angles[body] - linear[coordinate];
            CHECK(beyond[body] == Approx(expected).margin(1e-9));
        }
        return norm_of(beyond);
    };
    const double far = beyond_after(0.08), near = beyond_after(0.04);
    CHECK(near > 1e-5);
    CHECK(std::log2(far / near) == Approx(2).margin(0.5));
}

TEST_CASE("what was beyond first order can be seen until hands move again",
          "[statics][second-order]") {
    HeldPair c;
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    CHECK(norm_of(find_beyond_first_order(c.model, statics)) == 0);
    CHECK(norm_of(estimate_joint_errors(c.model, c.settings, c.state, statics)) == 0);
    for (int k = 0; k < 25; ++k) {
        c.move_hand(Vec3(0.017, 0, 0));
        REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
    }
    const double moving = norm_of(find_beyond_first_order(c.model, statics));
    const std::size_t renewed = statics.renewed;
    for (int k = 0; k < 100; ++k) {
        if (k == 50) statics.is_at_rest = false;  // once more, from a hand that has not moved
        REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
    }
    REQUIRE(statics.renewed > renewed + 1);
    REQUIRE(statics.is_at_rest);
    INFO(norm_of(find_beyond_first_order(c.model, statics)) << " of " << moving);
    CHECK(norm_of(find_beyond_first_order(c.model, statics)) > 0.5 * moving);
    // Near rest what is wrong is what one Newton step would yet turn.
    const std::vector<double> found = estimate_joint_errors(c.model, c.settings, c.state, statics);
    const std::vector<double> right = turns_to_rest(c);
    CHECK(norm_of(found) < 0.1 * moving);
    for (std::size_t i = 0; i < found.size(); ++i)
        if (c.model.coordinate_of_body[i] >= 0)
            CHECK(found[i] == Approx(right[i]).margin(0.1 * norm_of(right) + 1e-6));
}

TEST_CASE("estimated errors of joints are those of complete relaxation, in size and in order",
          "[statics][second-order]") {
    const Vec3 way = GENERATE(Vec3(0.02, 0, 0), Vec3(0, 0.02, 0), Vec3(0, 0, -0.02));
    HeldPair c;
    c.settings.evaluations = 2;  // errors worth seeing
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    double correlation = 0;
    std::size_t states = 0, right_size = 0;
    for (int k = 1; k <= 30; ++k) {
        c.move_hand(way);
        REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
        if (k <= 6) continue;
        const std::vector<double> found =
            only_joints(c.model, estimate_joint_errors(c.model, c.settings, c.state, statics));
        const std::vector<double> right = only_joints(c.model, turns_to_rest(c));
        for (const double error : found) CHECK(error >= 0);
        const double ratio = norm_of(found) / norm_of(right);
        correlation += rank_correlation(found, right);
        right_size += ratio > 0.5 && ratio < 2 ? 1 : 0;
        ++states;
    }
    CHECK(correlation / static_cast<double>(states) > 0.7);
    CHECK(static_cast<double>(right_size) > 0.9 * static_cast<double>(states));
}

TEST_CASE("where the model is at rest and old, its own error is what the growth with age says",
          "[statics][second-order]") {
    HeldPair c;
    c.settings.evaluations = 60;
    c.settings.rest = 1e-7;
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    std::size_t states = 0;
    for (int k = 1; k <= 60; ++k) {
        c.move_hand(Vec3(0.02, 0, 0));
        REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
        const double age = find_relative_age(c.model, c.settings, c.state, statics);
        // The growth is a running mean; that of the first renewals is still in it.
        if (statics.renewed < 5 || age < 0.5) continue;
        const double right = norm_of(only_joints(c.model, turns_to_rest(c)));
        // What an estimate without the growth would say.
        const double unrelaxed = norm_of(only_joints(
            c.model, find_unrelaxed_turns(c.model, *statics.linear,
                                          statics.value.gradient.head(statics.linear->mobile()))));
        const double found = norm_of(
            only_joints(c.model, estimate_joint_errors(c.model, c.settings, c.state, statics)));
        INFO("age " << age << ": unrelaxed " << unrelaxed << ", estimate " << found << ", right "
                    << right << " rad");
        CHECK(unrelaxed < 0.01 * right);
        // Not linear in the age either: that would be wrong by half from one end to the other.
        CHECK(found == Approx(right).epsilon(0.2));
        ++states;
    }
    CHECK(states >= 15);
}
