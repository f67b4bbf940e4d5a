#include "statics/second_order_step.h"

#include "statics/renewal_worker.h"
#include "tests/statics/held_pair.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <vector>

using namespace palpa;
using palpa::test::HeldPair;
using palpa::test::model_at;
using palpa::test::whole_at;

namespace {

// By complete relaxation where the hand is.
Vec3 relaxed_force(HeldPair c) {
    c.relax(1e-7);
    return find_wrench_on(c.model, c.state, 0).tail<3>();
}

Vec3 hand_force(const SecondOrderStatics& statics) { return find_hand_pull(statics, 0).tail<3>(); }

// The same each time: far from rest, under a hand that is where it was.
std::vector<HeldPair> pairs_far_from_rest() {
    const HeldPair rest;
    const LinearisedModel linear = rest.linearised();
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::vector<HeldPair> pairs(12, rest);
    for (HeldPair& c : pairs) {
        c.settings.near_reach = 1;  // Å: nearly all is quadratic
        Eigen::VectorXd at(linear.coordinates.size());
        for (double& x : at) x = 3 * normal(random);
        at.tail(linear.hands()).setZero();
        place_about(c.model, linear.coordinates, linear.at, at, c.state);
    }
    return pairs;
}

// The held atom is where the hand wants it after one step.
SecondOrderReport check_following(HeldPair& c, SecondOrderStatics& statics, double by) {
    c.move_hand({by, 0, 0});
    const Vec3 wanted = c.state.positions[c.model.bases[0].pivot];
    SecondOrderReport report = step_second_order(c.model, c.settings, c.state, statics);
    REQUIRE(report.is_finite);
    CHECK((c.state.positions[c.model.bases[0].pivot] - wanted).norm() < 1e-9);
    return report;
}

}  // namespace

TEST_CASE("atoms go with a hand as the linear response moves them", "[statics][second-order]") {
    const HeldPair c;
    const LinearisedModel linear = c.linearised();
    std::vector<std::uint32_t> atoms(c.model.masses.size());
    std::iota(atoms.begin(), atoms.end(), 0U);

    const std::vector<Mat3> responses =
        find_atom_responses(c.model, linear, linear.at, linear.hands() - 3, atoms);

    constexpr double h = 1e-4;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const Eigen::Index column = linear.hands() - 3 + axis;
        Eigen::VectorXd at(linear.coordinates.size());
        at << h * linear.response.col(column), h * Eigen::VectorXd::Unit(linear.hands(), column);
        TorsionState there = c.state, back = c.state;
        place_about(c.model, linear.coordinates, linear.at, at, there);
        place_about(c.model, linear.coordinates, linear.at, -at, back);
        for (const std::uint32_t atom : atoms) {
            const Vec3 way = (there.positions[atom] - back.positions[atom]) / (2 * h);
            CHECK((responses[atom].col(axis) - way).norm() < 1e-5 * (1 + way.norm()));
        }
    }
}

TEST_CASE("near pairs are those of what is held with what is near, and nothing else",
          "[statics][second-order]") {
    const HeldPair c;
    const double reach = 5;
    NearPairs near = build_near_pairs(c.model, c.state.positions, c.held.atoms, reach);
    const std::size_t half = c.held.atoms.size(), count = c.state.positions.size();

    // Every pair across that has one atom within reach of the held molecule.
    std::vector<std::array<std::uint32_t, 2>> pairs = near.all;
    for (auto& pair : pairs) std::ranges::sort(pair);
    std::ranges::sort(pairs);
    CHECK(std::ranges::adjacent_find(pairs) == pairs.end());
    for (std::uint32_t j = static_cast<std::uint32_t>(half); j < count; ++j) {
        const bool is_near = std::ranges::any_of(c.held.atoms, [&](std::uint32_t i) {
            return (c.state.positions[i] - c.state.positions[j]).norm() < reach;
        });
        for (const std::uint32_t i : c.held.atoms)
            CHECK(std::ranges::binary_search(pairs, std::array{i, j}) == is_near);
    }
    // Their sum is that of the pairs one by one; single precision agrees.
    std::vector<Vec3> expected(count, Vec3::Zero()), forces = expected, fast = expected;
    ForceSettings settings;
    const NonbondedEnergy sum = add_pair_forces(c.model.topology, settings.nonbonded, near.all,
                                                c.state.positions, expected);
    const double energy = add_near_forces(c.model, settings, near, c.state.positions, forces);
    settings.fast = true;
    const double fast_energy = add_near_forces(c.model, settings, near, c.state.positions, fast);
    const double total = sum.van_der_waals + sum.electrostatic;
    CHECK(energy == Approx(total).epsilon(1e-12));
    CHECK(fast_energy == Approx(total).epsilon(1e-5));
    for (std::size_t i = 0; i < count; ++i) {
        CHECK((forces[i] - expected[i]).norm() < 1e-10);
        CHECK((fast[i] - expected[i]).norm() < 1e-3);
    }
}

TEST_CASE("at its point a linearised model is the whole energy, to second order",
          "[statics][second-order]") {
    const HeldPair c;
    const LinearisedModel linear = c.linearised();
    const Eigen::Index size = linear.coordinates.size();
    const Eigen::VectorXd origin = Eigen::VectorXd::Zero(size);
    CHECK(model_at(c, linear, origin).energy == Approx(c.state.energy()).epsilon(1e-10));
    CHECK((model_at(c, linear, origin).gradient - linear.gradient).norm() < 1e-8);

    // Its error grows with the third power of the way, that of the gradient with the second.
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    Eigen::VectorXd way(size);
    for (double& x : way) x = normal(random);
    way.normalize();
    const auto errors = [&](double length) {
        const ModelValue model = model_at(c, linear, length * way);
        const ModelValue whole = whole_at(c, linear, length * way);
        return std::array{std::abs(model.energy - whole.energy),
                          (model.gradient - whole.gradient).norm()};
    };
    const auto far = errors(0.04), near = errors(0.02);
    CHECK(std::log2(far[0] / near[0]) == Approx(3).margin(0.5));
    CHECK(std::log2(far[1] / near[1]) == Approx(2).margin(0.4));
}

TEST_CASE("the gradient of a linearised model is that of its energy", "[statics][second-order]") {
    const HeldPair c;
    const LinearisedModel linear = c.linearised();
    Eigen::VectorXd at = Eigen::VectorXd::Zero(linear.coordinates.size());
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 0.02);
    for (double& x : at) x = normal(random);
    const ModelValue value = model_at(c, linear, at);
    constexpr double h = 1e-3;  // single precision of the product rounds energies
    for (Eigen::Index i = 0; i < at.size(); ++i) {
        const Eigen::VectorXd by = h * Eigen::VectorXd::Unit(at.size(), i);
        const double slope =
            (model_at(c, linear, at + by).energy - model_at(c, linear, at - by).energy) / (2 * h);
        CHECK(value.gradient[i] == Approx(slope).epsilon(2e-3).margin(0.02));
    }
}

TEST_CASE("the stiffness where everything follows is that of relaxed forces",
          "[statics][second-order]") {
    const HeldPair c(1e-8);
    const LinearisedModel linear = c.linearised();
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double h = 0.005;  // Å
        HeldPair forth = c, back = c;
        forth.move_hand(h * Vec3::Unit(axis));
        back.move_hand(-h * Vec3::Unit(axis));
        const Vec3 slope = (relaxed_force(back) - relaxed_force(forth)) / (2 * h);
        INFO("axis " << axis << ": " << slope.transpose() << " against "
                     << linear.relaxed_stiffness.col(axis).transpose());
        CHECK((slope - linear.relaxed_stiffness.col(axis)).norm() <
              0.01 * linear.relaxed_stiffness.norm());
        // Frozen it is stiffer.
        CHECK(linear.frozen_stiffness(axis, axis) > linear.relaxed_stiffness(axis, axis));
    }
}

TEST_CASE("the force on a hand that moves is that of complete relaxation",
          "[statics][second-order]") {
    HeldPair c;
    c.settings.forces.fast = GENERATE(false, true);
    const Vec3 way = Vec3::Unit(GENERATE(0, 1, 2));
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    const Vec3 start = relaxed_force(c);
    double worst = 0, largest = 0;
    for (int k = 1; k <= 20; ++k) {
        c.move_hand(0.02 * way);
        const SecondOrderReport report = step_second_order(c.model, c.settings, c.state, statics);
        REQUIRE(report.is_finite);
        CHECK(report.age < 0.125);
        if (k % 5 != 0) continue;
        const Vec3 expected = relaxed_force(c);
        largest = std::max(largest, (expected - start).norm());
        worst = std::max(worst, (hand_force(statics) - expected).norm());
    }
    CHECK(statics.renewed >= 3);
    INFO(worst << " of " << largest);
    CHECK(worst < 0.03 * largest);
}

TEST_CASE("renewals that come late leave the force near that of complete relaxation",
          "[statics][second-order]") {
    HeldPair c;
    c.settings.renews_at_once = false;
    const std::size_t delay = GENERATE(1, 3, 10);
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    const Vec3 start = relaxed_force(c);
    std::size_t due = 0, late = 0;
    double worst = 0, largest = 0;
    for (std::size_t k = 1; k <= 60; ++k) {
        if (statics.pending && k >= due) {
            (void)adopt_pending(c.model, c.settings, statics);
            ++late;
        }
        const bool was_pending = statics.pending.has_value();
        c.move_hand(Vec3(0.01, 0, 0));
        const SecondOrderReport report = step_second_order(c.model, c.settings, c.state, statics);
        REQUIRE(report.is_finite);
        CHECK_FALSE((k > 1 && report.is_renewed));
        if (statics.pending && !was_pending) due = k + delay;
        if (k % 10 != 0) continue;
        const Vec3 expected = relaxed_force(c);
        largest = std::max(largest, (expected - start).norm());
        worst = std::max(worst, (hand_force(statics) - expected).norm());
    }
    CHECK(late >= 3);
    INFO(worst << " of " << largest);
    CHECK(worst < 0.03 * largest);
}

TEST_CASE("atoms that a model has as parabolas do not come too close", "[statics][second-order]") {
    const double reach = GENERATE(3.0, 6.0);
    HeldPair c;
    c.settings.near_reach = reach;
    const LinearisedModel linear = c.linearised();
    const std::vector<Vec3>& positions = c.state.positions;
    const std::vector<std::uint32_t>& body_of = c.model.tree.bodies.body_of;
    // One by one, by the definition.
    const FastAtoms& fast = c.model.fast.atoms;
    const auto left_out = std::span(fast.left_out).first(fast.first_replaced);
    const auto half = static_cast<std::uint32_t>(positions.size() / 2);
    std::size_t expected = 0;
    for (std::uint32_t a = 0; a < positions.size(); ++a) {
        for (std::uint32_t b = a + 1; b < positions.size(); ++b) {
            const bool is_excluded = std::ranges::any_of(left_out, [&](const auto& pair) {
                return (pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a);
            });
            const double distance = (positions[a] - positions[b]).norm();
            const bool is_exact = (a < half) != (b < half) && distance < reach;
            expected += distance <= 4.5 && body_of[a] != body_of[b] && !is_excluded && !is_exact;
        }
    }
    CHECK(linear.close.pairs.size() == expected);
    REQUIRE(expected > 50);
    CHECK_FALSE(are_too_close(linear.close, positions));
    for (std::size_t i = 0; i < expected; i += 7) {
        const auto& [a, b] = linear.close.pairs[i];
        std::vector<Vec3> nearer = positions;
        const double distance = (positions[a] - positions[b]).norm();
        const double radii = fast.half_rmin[a] + fast.half_rmin[b];
        const auto put = [&](double apart) {
            nearer[a] = positions[b] + apart / distance * (positions[a] - positions[b]);
            return are_too_close({{{a, b}}, {linear.close.least_squares[i]}}, nearer);
        };
        CHECK(put(0.799 * std::min(distance, radii)));
        CHECK_FALSE(put(0.801 * std::min(distance, radii)));
    }
}

TEST_CASE("a hand that jumps waits for renewals, stride by stride, and comes to the same force",
          "[statics][second-order]") {
    HeldPair c;
    c.settings.renews_at_once = false;
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
    const std::uint32_t pivot = c.model.bases[0].pivot;
    const Vec3 goal = c.state.positions[pivot] + Vec3(1, 0, 0);
    std::size_t adopted = 0, lagging = 0;
    for (int k = 0; k < 300; ++k) {
        if (k % 3 == 2 && statics.pending) {
            (void)adopt_pending(c.model, c.settings, statics);
            ++adopted;
        }
        const Vec3 before = c.state.positions[pivot];
        c.move_hand(goal - before);
        const SecondOrderReport report = step_second_order(c.model, c.settings, c.state, statics);
        REQUIRE(report.is_finite);
        CHECK_FALSE(report.is_renewed);
        // Not beyond the region of the model, and what stays behind says so.
        CHECK(report.age <= c.settings.farthest_hand + c.settings.stride);
        CHECK(report.lags == ((goal - c.state.positions[pivot]).norm() > 1e-9));
        lagging += report.lags ? 1 : 0;
    }
    CHECK(lagging > 3);
    CHECK(adopted > 3);
    CHECK((goal - c.state.positions[pivot]).norm() < 1e-9);
    const Vec3 expected = relaxed_force(c);
    CHECK((hand_force(statics) - expected).norm() < 0.01 * (1 + expected.norm()));
}

TEST_CASE("where a model does not hold a hand waits at rest, and may go back",
          "[statics][second-order]") {
    HeldPair c;
    c.settings.renews_at_once = false;
    c.settings.stride = 0.05;
    c.settings.farthest = 0.12;  // Å, which the second stride or the third takes an atom to
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
    const std::uint32_t pivot = c.model.bases[0].pivot;
    const Vec3 start = c.state.positions[pivot], goal = start + Vec3(0.29, 0, 0);
    const auto step_to = [&](const Vec3& place) {
        c.move_hand(place - c.state.positions[pivot]);
        return step_second_order(c.model, c.settings, c.state, statics);
    };
    REQUIRE(step_to(goal).lags);
    REQUIRE(statics.discarded == 1);
    REQUIRE(statics.pending);
    const Vec3 waits = c.state.positions[pivot];
    CHECK((waits - start).norm() > 0.04);
    std::size_t last = 1;
    for (int k = 0; k < 40; ++k) {
        const SecondOrderReport report = step_to(goal);
        CHECK(report.lags);
        last = report.model_evaluations;
    }
    CHECK(statics.discarded == 1);
    CHECK(last == 0);  // at the model's rest
    CHECK((c.state.positions[pivot] - waits).norm() < 1e-9);
    CHECK(step_to(start).lags == false);
    CHECK((c.state.positions[pivot] - start).norm() < 1e-9);
    // With a new model it goes on.
    (void)step_to(goal);
    (void)adopt_pending(c.model, c.settings, statics);
    (void)step_to(goal);
    CHECK(c.state.positions[pivot].x() > waits.x() + 0.04);
}

// A rod on a joint along z, its end on a spring to a fixed place and on one that a hand holds:
// E = const - r |c| at rest, where c = k1 a + k2 x in the plane. Where the hand makes c small the
// rod turns over, and what the hand feels is as soft as -r k2^2/|c|.
TEST_CASE("a rod turns over under the hand as its closed form says", "[statics][second-order]") {
    constexpr double r = 1.5, k1 = 1, k2 = 1.3;
    const double aside = GENERATE(1.0, 0.3, 0.1);
    test::TorsionCase rod;
    const Vec3 up(0, 0, 1);
    rod.positions = {-up, Vec3::Zero(), r * Vec3::UnitX(), Vec3(-1, 0, -1)};
    rod.masses.assign(4, 12);
    rod.bodies.bodies = {{}, {0, {0, 1}}};
    rod.bodies.body_of = {0, 1, 1, 0};
    const TorsionModel model = test::forceless_model(rod, BaseFreedom::Held);
    TorsionState state = build_torsion_state(model);
    Vec3 x(1, aside, 0);
    state.springs = {{.atoms = {2}, .k = k1, .place = Vec3(1, 0, 0)},
                     {.atoms = {2}, .k = k2, .place = x}};
    const SecondOrderSettings settings;
    SecondOrderStatics statics =
        build_second_order_statics(model, {{{.molecule = 0, .spring = 1}}, {2}});
    Lineariser lineariser = build_lineariser(model, statics.renewals.lineariser.held);
    double softest = 0;
    for (int k = 0; k < 150; ++k) {
        REQUIRE(step_second_order(model, settings, state, statics).is_finite);
        const Vec3 c = k1 * Vec3(1, 0, 0) + k2 * x;
        const Vec3 expected = k2 * (r * c.normalized() - x);
        // Of the 2 or more by which the rod is pulled; at the sharpest its end goes 15 Å an
        // ångström.
        CHECK((hand_force(statics) - expected).norm() < (aside < 0.2 ? 0.2 : 0.1));

        TorsionState rest = state;
        RelaxSettings to_rest;
        to_rest.force_tolerance = 1e-9;
        QuasiStatics full = build_quasi_statics(model);
        (void)relax_joints(model, to_rest, rest, full);
        CHECK((rest.positions[2] - r * c.normalized()).norm() < 1e-6);
        LinearisedModel linear;
        REQUIRE(linearise(model, settings, rest, lineariser, linear));
        const Vec3 across = up.cross(c).normalized();
        const double softened = r * k2 * k2 / c.norm();
        const Mat3 K = k2 * Mat3::Identity() - softened * across * across.transpose();
        CHECK((linear.relaxed_stiffness - K).norm() < 1e-5 * K.norm());
        softest = std::max(softest, softened);
        x.x() -= 0.02;
        state.springs[1].place = x;
    }
    CHECK(softest > 0.9 * r * k2 / aside);
    CHECK(state.positions[2].x() < 0);
}

TEST_CASE("a hand that nothing holds back drags both molecules without a force",
          "[statics][second-order]") {
    // Turning everything about the hand is a flat direction: the second derivatives are singular.
    HeldPair c;
    c.state.springs.clear();
    c.relax(1e-5);
    const LinearisedModel linear = c.linearised();
    const Eigen::MatrixXd frozen = linear.frozen_stiffness.bottomRightCorner<3, 3>();
    CHECK(frozen.norm() > 1);
    CHECK(linear.relaxed_stiffness.bottomRightCorner<3, 3>().norm() < 1e-3 * frozen.norm());

    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    const std::vector<Vec3> start = c.state.positions;
    for (int k = 0; k < 50; ++k) {
        c.move_hand(Vec3(0.02, 0, 0));
        REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
        CHECK(hand_force(statics).norm() < 0.3);  // 20 pN
    }
    for (int k = 0; k < 60; ++k) (void)step_second_order(c.model, c.settings, c.state, statics);
    CHECK(hand_force(statics).norm() < 0.01);
    // They may turn, but keep their shape and stay side by side.
    const std::vector<Vec3>& end = c.state.positions;
    for (std::size_t a = 0; a < start.size(); a += 5) {
        for (std::size_t b = 0; b < a; b += 3)
            CHECK((end[a] - end[b]).norm() == Approx((start[a] - start[b]).norm()).margin(0.05));
    }
}

TEST_CASE(
    "a hand's work is the change of the energy and what renewals set free, and a closed "
    "path costs nothing",
    "[statics][second-order]") {
    HeldPair c;
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
    const double start = statics.value.energy;
    double work = 0, released = 0, farthest = 0;
    Vec3 force = hand_force(statics);
    const auto go = [&](const Vec3& by) {
        const Vec3 before = force;
        c.move_hand(by);
        const SecondOrderReport report = step_second_order(c.model, c.settings, c.state, statics);
        REQUIRE(report.is_finite);
        released += report.released;
        force = hand_force(statics);
        work -= 0.5 * (before + force).dot(by);
    };
    for (int k = 0; k < 60; ++k) {
        go({0.01, 0, 0});
        if (k % 10 != 9) continue;
        HeldPair rest = c;
        rest.relax(1e-7);
        farthest = work;
        CHECK(work == Approx(rest.state.energy() - start).epsilon(0.02).margin(0.01));
        CHECK(work == Approx(statics.value.energy + released - start).epsilon(0.02).margin(0.01));
    }
    for (int k = 0; k < 60; ++k) go({-0.01, 0, 0});
    REQUIRE(farthest > 0.1);
    CHECK(std::abs(work) < 0.02 * farthest);
    CHECK(released < 0.02 * farthest);
}

TEST_CASE("a pending renewal made beside steps in another thread gives the same bits",
          "[statics][second-order]") {
    const auto walk = [](bool is_threaded) {
        HeldPair c;
        c.settings.renews_at_once = false;
        SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
        RenewalWorker worker;
        std::vector<double> forces;
        for (std::size_t k = 1; k <= 60; ++k) {
            if (k % 6 == 0 && statics.pending) (void)adopt_pending(c.model, c.settings, statics);
            if (is_threaded) worker.start_if_pending(c.model, c.settings, statics);
            // Another spring is no longer that of the renewal under way, which has to end first.
            if (k == 30 || k == 31) c.state.springs[1].place += Vec3(0, 0.05, 0);
            c.move_hand(Vec3(k == 40 ? 0.5 : 0.02, 0, 0));
            const SecondOrderReport report =
                step_second_order(c.model, c.settings, c.state, statics, [&] { worker.await(); });
            REQUIRE(report.is_finite);
            worker.await();
            const Vec3 force = hand_force(statics);
            forces.insert(forces.end(), {force.x(), force.y(), force.z()});
        }
        CHECK(statics.renewed > 5);
        return forces;
    };
    CHECK(walk(true) == walk(false));
}

TEST_CASE("the error estimate of a step is near its error", "[statics][second-order]") {
    constexpr double pN = 69.4770;  // of a kcal/mol/Å
    std::size_t right = 0, states = 0;
    for (int k = 0; k < 30; ++k) {
        HeldPair c;
        // Too rough a step, so that there are errors.
        c.settings.evaluations = 1;
        c.settings.renew_hand = 0.2;
        SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
        const Vec3 way = (k % 4 < 2 ? 1 : -1) * (0.1 + 0.005 * k) * Vec3::Unit(k % 3);
        SecondOrderReport report;
        for (int i = 0; i < 4; ++i) {
            c.move_hand(way);
            report = step_second_order(c.model, c.settings, c.state, statics);
        }
        REQUIRE(report.is_finite);
        const double error = pN * (hand_force(statics) - relaxed_force(c)).norm();
        if (error < 10 || error > 1000) continue;
        ++states;
        const double estimate = pN * report.error_estimate;
        UNSCOPED_INFO(estimate << " pN estimated, " << error);
        if (estimate < 2 * error && error < 2 * estimate) ++right;
    }
    CHECK(states >= 12);
    CHECK(6 * right >= 5 * states);
}

TEST_CASE("a tight tolerance has more pairs exact than a loose one, and both keep the force in it",
          "[statics][second-order]") {
    const auto reach_with = [](double tolerance) {
        HeldPair c;
        c.settings.tolerance = tolerance;
        c.settings.near_reach = 6;
        SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
        for (int k = 1; k <= 60; ++k) {
            c.move_hand(0.02 * Vec3::UnitX());
            REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
            if (k % 10 == 0) CHECK((hand_force(statics) - relaxed_force(c)).norm() < 2 * tolerance);
        }
        REQUIRE(statics.renewed > 3);
        return statics.near_reach;
    };
    const double tight = reach_with(1e-3), loose = reach_with(1);
    CHECK(tight > 6);
    CHECK(loose < 6);
}

TEST_CASE("a tolerance that nothing meets renews once at a place, and goes on",
          "[statics][second-order]") {
    HeldPair c;
    c.settings.tolerance = 1e-12;
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    for (int k = 0; k < 5; ++k) {
        c.move_hand({0.05, 0, 0});
        const std::size_t before = statics.renewed;
        CHECK(step_second_order(c.model, c.settings, c.state, statics).is_finite);
        CHECK(statics.renewed - before <= 3);
    }
}

TEST_CASE("while a hand stands still the whole energy never rises, and comes to rest",
          "[statics][second-order]") {
    std::vector<HeldPair> pairs = pairs_far_from_rest();
    int trial = 0;
    for (HeldPair& c : pairs) {
        INFO("trial " << trial++);
        SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
        const auto step = [&] {
            REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
            return statics.linear->at.energy();
        };
        for (std::size_t k = 0; k <= c.settings.still_steps; ++k) (void)step();
        double energy = step();
        for (int k = 0; k < 200; ++k) {
            const double next = step();
            CHECK(next <= energy + 1e-9 * std::abs(energy));
            energy = next;
        }
        CHECK(statics.is_at_rest);
    }
}

TEST_CASE("a slow hand is followed, and renews the model by its way alone",
          "[statics][second-order]") {
    HeldPair c;
    // Å a step. More than 0.001 Å in sum counts as a move: after 6, 4, 2 or 3 (by rounding), and 2.
    const double by = GENERATE(0.0002, 0.0003, 0.0005, 0.0006);
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
    const std::size_t before = statics.renewed;
    for (double way = 0; way < 0.24; way += by) {
        (void)check_following(c, statics, by);
    }
    CHECK(statics.renewed - before <= 4);  // every 0.1 Å, or an atom every 0.3 Å
}

TEST_CASE("a hand that trembles where nothing is at rest yet renews less than once a step",
          "[statics][second-order]") {
    // Rounding decides by chance how many a few steps need; three are enough in all others.
    constexpr std::size_t steps = 60, usual = 3, most = 12;
    std::vector<HeldPair> pairs = pairs_far_from_rest();
    std::size_t renewed = 0, unusual = 0;
    for (HeldPair& c : pairs) {
        INFO("trial " << &c - pairs.data());
        SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
        for (std::size_t k = 0; k < steps; ++k) {
            const std::size_t before = statics.renewed;
            (void)check_following(c, statics, k % 2 == 0 ? 1e-6 : -1e-6);
            CHECK(statics.renewed - before <= most);
            unusual += statics.renewed - before > usual ? 1 : 0;
        }
        renewed += statics.renewed;
    }
    CHECK(renewed < steps * pairs.size());
    CHECK(100 * unusual <= steps * pairs.size());
}

TEST_CASE("a hand that creeps is followed while a new model is still being made",
          "[statics][second-order]") {
    HeldPair c;
    c.settings.renews_at_once = false;
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
    for (int k = 0; k < 400; ++k) {
        REQUIRE_FALSE(check_following(c, statics, 0.0003).lags);
        if (statics.pending && k % 7 == 0) (void)adopt_pending(c.model, c.settings, statics);
    }
}

TEST_CASE("out and back without a snap the hand's force is what it was",
          "[statics][second-order]") {
    HeldPair c;
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    const auto follow = [&](const Vec3& by) {
        c.move_hand(by);
        REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
        return hand_force(statics);
    };
    double work = 0, gross = 0;
    Vec3 force = follow(Vec3::Zero());
    for (int k = 0; k < 30; ++k) {
        const Vec3 by(k < 15 ? 0.02 : -0.02, 0, 0), before = force;
        force = follow(by);
        const double done = -0.5 * (before + force).dot(by);
        work += done;
        if (k < 15) gross += std::abs(done);
    }
    INFO(work << " of " << gross << " kcal/mol");
    CHECK(std::abs(work) < 0.02 * gross);
}

TEST_CASE("a hand that jumps, or one that holds what nothing surrounds, leaves everything finite",
          "[statics][second-order]") {
    HeldPair c;
    SecondOrderStatics statics = build_second_order_statics(c.model, c.held);
    const Vec3 by = GENERATE(Vec3(3, 0, 0), Vec3(-3, 0, 0), Vec3(0, 0, 3), Vec3(500, 0, 0));
    REQUIRE(step_second_order(c.model, c.settings, c.state, statics).is_finite);
    const Vec3 place = c.state.positions[c.model.bases[0].pivot];
    c.move_hand(by);
    const SecondOrderReport report = step_second_order(c.model, c.settings, c.state, statics);
    CHECK(report.is_finite);
    CHECK((c.state.positions[c.model.bases[0].pivot] - place - by).norm() < 1e-9);
    CHECK(hand_force(statics).allFinite());
    CHECK(statics.value.energy < 1e4);
}

TEST_CASE("a model in which nothing can move has the frozen stiffness", "[statics][second-order]") {
    TorsionModel model = test::model_of(test::with_copy(test::alanine_dipeptide(), {9, 0, 0}),
                                        {BaseFreedom::Held, BaseFreedom::Held}, {.overrides = {}});
    TorsionState state = build_torsion_state(model);
    HeldParts held{{{.molecule = 0}}, {}};
    held.atoms.resize(model.masses.size() / 2);
    std::iota(held.atoms.begin(), held.atoms.end(), 0U);
    SecondOrderStatics statics = build_second_order_statics(model, held);
    shift_base(model, 0, {0.05, 0, 0}, state);
    CHECK(step_second_order(model, {}, state, statics).is_finite);
    CHECK(find_hand_pull(statics, 0).allFinite());
}
