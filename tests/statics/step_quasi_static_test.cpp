#include "statics/step_quasi_static.h"

#include "statics/relax_joints.h"
#include "tests/support/torsion_case.h"
#include "tests/support/torsion_oracles.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace palpa;
using test::TorsionShape;

namespace {

// Made-up bodies with forces, where they are after random turns.
struct Pushed {
    TorsionModel model;
    TorsionState state;
    test::TorsionCase moved;  // the same, atoms where the state has them
};

Pushed pushed(TorsionShape shape, BaseFreedom freedom, std::size_t bodies = 25) {
    const test::TorsionCase c = test::torsion_case(77, bodies, shape);
    Pushed result{test::forceless_model(c, freedom), {}, c};
    result.state = test::state_after(result.model, 1, 9);
    result.state.forces = c.forces;
    result.moved.positions = result.state.positions;
    return result;
}

// By the dense mass matrix in long double, of free bases or held ones.
Coordinates dense_accelerations(const Pushed& p, BaseFreedom freedom) {
    const std::size_t bodies = p.moved.bodies.bodies.size();
    test::Held held{std::vector<std::uint8_t>(bodies, 1), {GuidedBase{}}};
    if (freedom == BaseFreedom::Held) held.guides[0].guide = BaseGuide::Whole;
    const test::TorsionAccelerations found = test::dense_accelerations(p.moved, held);
    Coordinates result(p.model.coordinates);
    for (std::size_t b = 1; b < bodies; ++b) {
        result[p.model.coordinate_of_body[b]] = found.joints[b];
    }
    if (freedom == BaseFreedom::Free) result.tail<6>() = found.bases[0];
    return result;
}

// Where the quasi-static step meets forces of all kinds.
struct Peptides {
    TorsionModel model;
    TorsionState state;
};

Peptides peptides(BaseFreedom first, BaseFreedom second) {
    Peptides result{
        test::model_of(test::with_copy(test::tetrapeptide(), {12, 5, -2}), {first, second}), {}};
    result.state = test::state_after(result.model, 0.03, 21);
    return result;
}

}  // namespace

TEST_CASE("accelerations are those of the dense mass matrix", "[statics][step]") {
    const auto shape = GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Star);
    const auto freedom = GENERATE(BaseFreedom::Free, BaseFreedom::Held);
    const Pushed p = pushed(shape, freedom);
    QuasiStatics statics = build_quasi_statics(p.model);
    const Coordinates expected = dense_accelerations(p, freedom);
    Coordinates found, product;

    update_coordinate_accelerations(p.model, p.state, statics.assembly, found);
    CHECK((found - expected).norm() < 1e-8 * expected.norm());

    // The same by the forces along the coordinates.
    TorsionState state = p.state;
    update_coordinate_forces(p.model, state);
    multiply_by_inverse_mass(p.model, state, state.coordinate_forces, statics.assembly, product);
    CHECK((product - expected).norm() < 1e-8 * expected.norm());
}

TEST_CASE("a base that only turns keeps its pivot in place", "[statics][step]") {
    const auto shape = GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Star);
    const std::size_t bodies = GENERATE(std::size_t{1}, std::size_t{2}, std::size_t{25});
    Pushed p = pushed(shape, BaseFreedom::Turning, bodies);
    QuasiStatics statics = build_quasi_statics(p.model);
    const Coordinates expected = test::find_accelerations(p.model, p.state);
    Coordinates found, product;

    update_coordinate_accelerations(p.model, p.state, statics.assembly, found);
    CHECK((found - expected).norm() < 1e-7 * expected.norm());
    CHECK(found.tail<3>().norm() > 0);

    update_coordinate_forces(p.model, p.state);
    multiply_by_inverse_mass(p.model, p.state, p.state.coordinate_forces, statics.assembly,
                             product);
    CHECK((product - expected).norm() < 1e-7 * expected.norm());
}

TEST_CASE("molecules beside each other accelerate each in its own way", "[statics][step]") {
    using enum BaseFreedom;
    const auto freedoms = GENERATE(std::array{Held, Free}, std::array{Turning, Free},
                                   std::array{Turning, Held}, std::array{Free, Free});
    auto [model, state] = peptides(freedoms[0], freedoms[1]);
    QuasiStatics statics = build_quasi_statics(model);
    update_forces(model, {}, statics.memory, state);
    const Coordinates expected = test::find_accelerations(model, state);
    Coordinates found;

    update_coordinate_accelerations(model, state, statics.assembly, found);

    CHECK((found - expected).norm() < 1e-7 * expected.norm());
}

TEST_CASE("a step goes half of h squared times the acceleration", "[statics][step]") {
    using enum BaseFreedom;
    const auto freedoms = GENERATE(std::array{Held, Free}, std::array{Turning, Free});
    auto [model, state] = peptides(freedoms[0], freedoms[1]);
    QuasiStatics statics = build_quasi_statics(model);
    update_forces(model, {}, statics.memory, state);
    const Coordinates accelerations = test::find_accelerations(model, state);
    QuasiStaticSettings settings;
    settings.first_h = std::sqrt(2e-3 / accelerations.norm());
    const Coordinates move = 1e-3 * accelerations.normalized();
    TorsionState expected = state;
    add_move(model, move, expected);
    const double before = state.energy();

    const QuasiStaticReport report = step_quasi_static(model, settings, state, statics);

    CHECK(report.is_taken);
    CHECK_FALSE(report.is_bounded);
    for (std::size_t b = 0; b < state.angles.size(); ++b) {
        CHECK(state.angles[b] - expected.angles[b] == Approx(0).margin(1e-7 * move.norm()));
    }
    CHECK(find_largest_move(state.positions, expected.positions) < 1e-6 * report.largest_move);
    CHECK(report.energy_change < 0);
    CHECK(state.energy() - before == Approx(report.energy_change).epsilon(1e-9));
    CHECK(statics.h == Approx(1.2 * settings.first_h));

    // Its forces are those of the place where it is.
    TorsionState again = state;
    update_forces(model, {}, statics.memory, again);
    CHECK(again.forces == state.forces);
}

TEST_CASE("every step in double lowers the energy and no atom goes too far", "[statics][step]") {
    using enum BaseFreedom;
    auto [model, state] = peptides(Turning, Free);
    QuasiStatics statics = build_quasi_statics(model);
    QuasiStaticSettings settings;
    settings.largest_move = GENERATE(0.02, 0.2);
    settings.first_h = 3;
    update_forces(model, {}, statics.memory, state);
    const double start = state.energy();
    int taken = 0, refused = 0;

    for (int i = 0; i < 150; ++i) {
        const TorsionState before = state;
        const double h = statics.h == 0 ? settings.first_h : statics.h;
        const QuasiStaticReport report = step_quasi_static(model, settings, state, statics);
        REQUIRE(report.is_finite);
        const double far = find_largest_move(before.positions, state.positions);
        if (report.is_taken) {
            ++taken;
            CHECK(state.energy() <= before.energy());
            CHECK(far <= settings.largest_move);
            CHECK(far == report.largest_move);
        } else {
            ++refused;
            CHECK(report.energy_change > 0);
            CHECK(state.positions == before.positions);
            CHECK(state.angles == before.angles);
            CHECK(state.shifts == before.shifts);
            CHECK(state.forces == before.forces);
            CHECK(state.energy() == before.energy());
            if (!report.is_bounded) CHECK(statics.h == Approx(0.5 * h));
        }
        // The pivot of the first molecule stays.
        CHECK((state.positions[0] - before.positions[0]).norm() < 1e-12);
    }
    CHECK(taken > 50);
    if (settings.largest_move > 0.1) CHECK(refused > 0);
    CHECK(state.energy() < start - 10);
}

TEST_CASE("a step that would raise the energy halves h and leaves all as it is",
          "[statics][step]") {
    const TorsionModel model = test::model_of(test::alanine_dipeptide(), {BaseFreedom::Held});
    TorsionState state = build_torsion_state(model);
    QuasiStatics statics = build_quasi_statics(model);
    RelaxSettings rest;
    rest.force_tolerance = 1e-3;
    REQUIRE(relax_joints(model, rest, state, statics).end == RelaxEnd::Converged);
    const TorsionState before = state;
    // So far beyond the minimum that it is uphill, and within bounds.
    QuasiStaticSettings settings;
    settings.largest_move = 10;
    Coordinates accelerations;
    update_coordinate_accelerations(model, state, statics.assembly, accelerations);
    statics.h = std::sqrt(2 * 0.3 / accelerations.cwiseAbs().maxCoeff());
    const double h = statics.h;

    const QuasiStaticReport report = step_quasi_static(model, settings, state, statics);

    CHECK_FALSE(report.is_taken);
    CHECK_FALSE(report.is_bounded);
    CHECK(report.energy_change > 0.01);
    CHECK(statics.h == Approx(h / 2));
    CHECK(state.positions == before.positions);
    CHECK(state.forces == before.forces);
    CHECK(state.energy() == before.energy());
}

TEST_CASE("a step from where nothing is a number is none", "[statics][step]") {
    auto [model, state] = peptides(BaseFreedom::Turning, BaseFreedom::Free);
    QuasiStatics statics = build_quasi_statics(model);
    update_forces(model, {}, statics.memory, state);
    const TorsionState before = state;
    state.forces[3].x() = std::numeric_limits<double>::quiet_NaN();

    const QuasiStaticReport report = step_quasi_static(model, {}, state, statics);

    CHECK_FALSE(report.is_finite);
    CHECK_FALSE(report.is_taken);
    CHECK(state.positions == before.positions);
    CHECK(state.angles == before.angles);
}

TEST_CASE("a move is shortened until no atom goes too far", "[statics][step]") {
    auto [model, state] = peptides(BaseFreedom::Free, BaseFreedom::Free);
    QuasiStatics statics = build_quasi_statics(model);
    std::mt19937 random(3);
    const double limit = GENERATE(1e-3, 0.05, 1.0);

    for (int i = 0; i < 20; ++i) {
        const Coordinates wanted = test::random_move(model, 2, random);
        Coordinates move = wanted;
        const double far = place_within(model, state, limit, move, statics.trial);

        CHECK(far <= limit);
        CHECK(far > 0.5 * limit);
        CHECK(far == find_largest_move(state.positions, statics.trial.positions));
        // Along the way that was wanted, and what was done.
        CHECK(move.dot(wanted) == Approx(move.norm() * wanted.norm()).epsilon(1e-12));
        TorsionState expected = state;
        add_move(model, move, expected);
        CHECK(expected.positions == statics.trial.positions);
    }
    Coordinates little = Coordinates::Constant(model.coordinates, 1e-9);
    const Coordinates before = little;
    static_cast<void>(place_within(model, state, limit, little, statics.trial));
    CHECK(little == before);
}

TEST_CASE("the largest move is the farthest atom's", "[statics][step]") {
    CHECK(find_largest_move({}, {}) == 0);
    CHECK(find_largest_move({{0, 0, 0}, {1, 1, 1}}, {{0, 1, 0}, {1, -2, 5}}) == 5);
}

TEST_CASE("where fast pairs round the energy, the forces tell whether it falls",
          "[statics][step]") {
    ForceSettings settings;
    TorsionState from, to;
    const Coordinates move = Coordinates::Ones(2);
    from.coordinate_forces = Coordinates::Ones(2);
    to.coordinate_forces = -0.5 * Coordinates::Ones(2);
    from.terms.bond = 1e4;

    to.terms.bond = 1e4 + 0.001;
    CHECK_FALSE(is_lower(settings, from, to, move));
    settings.fast = true;
    CHECK(is_lower(settings, from, to, move));
    to.coordinate_forces *= 3;
    CHECK_FALSE(is_lower(settings, from, to, move));
    to.terms.bond = 1e4 - 0.1;
    CHECK(is_lower(settings, from, to, move));
    to.terms.bond = 1e4 + 0.1;
    to.coordinate_forces = from.coordinate_forces;
    CHECK_FALSE(is_lower(settings, from, to, move));
    // Smaller energies are rounded by less.
    from.terms.bond = 100;
    to.terms.bond = 100.001;
    CHECK_FALSE(is_lower(settings, from, to, move));
}
