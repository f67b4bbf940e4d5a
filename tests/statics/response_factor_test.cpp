#include "statics/response_factor.h"

#include "statics/hessian_product.h"
#include "statics/relax_joints.h"
#include "tests/support/torsion_case.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

using namespace palpa;

namespace {

SecondDerivatives derivatives_at(const TorsionModel& model, const TorsionState& state,
                                 const LocalCoordinates& coordinates,
                                 const NonbondedSettings& settings = {}) {
    SecondDerivatives derivatives;
    update_second_derivatives(model, coordinates, build_model_paths(model), settings, state,
                              derivatives);
    return derivatives;
}

Eigen::MatrixXd matrix_of(const AtomMetric& metric, Eigen::Index size) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
    for (const AtomMetric::Entry& entry : metric.entries) {
        result(entry.row, entry.column) = entry.value;
        result(entry.column, entry.row) = entry.value;
    }
    return result;
}

void relax(const TorsionModel& model, TorsionState& state) {
    RelaxSettings settings;
    settings.force_tolerance = 1e-4;
    QuasiStatics statics = build_quasi_statics(model);
    CHECK(relax_joints(model, settings, state, statics).end == RelaxEnd::Converged);
}

// Where a model is, whatever its second derivatives.
struct Factored {
    SecondDerivatives derivatives;
    AtomMetric metric;
    ResponseFactor factor;
    bool is_done = false;
};

Factored factored(const TorsionModel& model, const TorsionState& state,
                  const std::vector<HandHold>& hands = {}, const NonbondedSettings& settings = {}) {
    const LocalCoordinates coordinates = build_local_coordinates(model, hands);
    Factored result{derivatives_at(model, state, coordinates, settings), {}, {}};
    update_atom_metric(model, coordinates, state, result.metric);
    result.is_done = update_response_factor(result.derivatives, result.metric, {}, result.factor);
    return result;
}

// L L^T - (H + shift M), of the largest of H.
double error_of(const Factored& f) {
    const Eigen::Index size = f.derivatives.mobile;
    Eigen::MatrixXd L = Eigen::MatrixXd::Zero(size, size);
    for (Eigen::Index r = 0; r < size; ++r) {
        for (Eigen::Index c = 0; c <= r; ++c)
            L(r, c) =
                f.factor.cholesky.at(static_cast<std::size_t>(r), static_cast<std::size_t>(c));
    }
    const Eigen::MatrixXd wanted =
        f.derivatives.of_mobile() + f.factor.shift * matrix_of(f.metric, size);
    return (L * L.transpose() - wanted).cwiseAbs().maxCoeff() / wanted.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("the metric is that of atoms' moves", "[statics][factor]") {
    using enum BaseFreedom;
    const TorsionModel model =
        test::model_of(test::with_copy(test::tetrapeptide(), {12, 5, -2}), {Turning, Free});
    const TorsionState state = test::state_after(model, 0.3, 5);
    AtomMetric metric;

    update_atom_metric(model, build_local_coordinates(model), state, metric);

    const Eigen::MatrixXd J = test::find_jacobian(model, state);
    const Eigen::MatrixXd M = matrix_of(metric, model.coordinates), of_moves = J.transpose() * J;
    // Turns count for 0.1 Å^2 of each atom more.
    const double atoms = static_cast<double>(state.positions.size());
    CHECK((M - of_moves).cwiseAbs().maxCoeff() < 0.1 * atoms + 1e-6);
    for (Eigen::Index i = 0; i < model.coordinates; ++i) CHECK(M(i, i) >= of_moves(i, i) - 1e-6);
    const Coordinates move = Coordinates::Random(model.coordinates);
    CHECK(metric.square_of(move) == Approx(move.dot(M * move)));
}

TEST_CASE("at rest the factor is that of the second derivatives themselves", "[statics][factor]") {
    const TorsionModel model =
        test::model_of(test::tetrapeptide(), {BaseFreedom::Held}, test::all_joints);
    TorsionState state = build_torsion_state(model);
    state.springs.push_back({.atoms = {50, 55, 58}, .k = 5, .place = state.positions[55]});
    relax(model, state);

    const Factored f = factored(model, state, {{.molecule = 0, .spring = 0}});

    REQUIRE(f.is_done);
    CHECK(f.factor.shift == 0);
    CHECK(f.factor.tries == 1);
    CHECK(f.factor.negative == std::size_t{0});
    CHECK(error_of(f) < 1e-14);
    const SecondDerivatives& d = f.derivatives;
    const Eigen::MatrixXd response = d.of_mobile().ldlt().solve(Eigen::MatrixXd(d.mixed()));
    CHECK((find_response(f.factor, d.mixed()) - response).norm() < 1e-9 * response.norm());
    const Eigen::MatrixXd K = d.of_hands() - d.mixed().transpose() * response;
    CHECK((find_relaxed_stiffness(d, f.factor) - K).norm() < 1e-9 * K.norm());
}

TEST_CASE("off rest the factor is shifted, by little more than it needs", "[statics][factor]") {
    const TorsionModel model =
        test::model_of(test::tetrapeptide(), {BaseFreedom::Held}, test::all_joints);
    std::mt19937 random(7);
    TorsionState rest = build_torsion_state(model);
    relax(model, rest);
    std::size_t shifted = 0;
    for (int i = 0; i < 20; ++i) {
        INFO("state " << i);
        TorsionState state = rest;
        Coordinates move = test::random_move(model, 0.8, random);
        place_within(model, rest, 0.2 + 0.1 * i, move, state);

        const Factored f = factored(model, state);

        REQUIRE(f.is_done);
        CHECK(error_of(f) < 1e-14);
        const Eigen::MatrixXd M = matrix_of(f.metric, model.coordinates);
        const double lowest =
            Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
                f.derivatives.of_mobile(), M, Eigen::EigenvaluesOnly | Eigen::Ax_lBx)
                .eigenvalues()[0];
        CHECK((f.factor.shift == 0) == (lowest > 0));
        CHECK(f.factor.negative.has_value() == (lowest > 0));
        CHECK(f.factor.shift >= -lowest);
        CHECK(f.factor.shift <= std::max(1e-4, -10 * lowest));
        CHECK(f.factor.tries <= 8);
        shifted += f.factor.shift > 0 ? 1 : 0;
    }
    CHECK(shifted > 3);
}

TEST_CASE("what nothing holds has a factor too", "[statics][factor]") {
    using enum BaseFreedom;

    SECTION("a molecule that nothing is near") {
        NonbondedSettings settings;
        settings.electrostatics = ElectrostaticCutoff::ForceSwitch;
        settings.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
        const TorsionModel model =
            test::model_of(test::with_copy(test::tetrapeptide(), {60, 0, 0}), {Held, Free});
        TorsionState state = build_torsion_state(model);
        const Factored f = factored(model, state, {}, settings);
        REQUIRE(f.is_done);
        CHECK(f.factor.shift > 0);
        CHECK(find_response(f.factor, Coordinates::Ones(model.coordinates)).allFinite());
    }
    SECTION("one atom, which turns for nothing") {
        test::TorsionCase c;
        c.masses = {12};
        c.positions = {{1, 2, 3}};
        c.bodies.bodies = {{}};
        c.bodies.body_of = {0};
        const TorsionModel model = test::forceless_model(c, Free);
        const Factored f = factored(model, build_torsion_state(model));
        REQUIRE(f.is_done);
        CHECK(f.factor.shift == FactorSettings{}.least_shift);
        CHECK(find_response(f.factor, Coordinates::Ones(6)).allFinite());
    }
    SECTION("nothing that moves") {
        const TorsionModel model =
            test::forceless_model(test::torsion_case(3, 1, test::TorsionShape::Tree), Held);
        const Factored f = factored(model, build_torsion_state(model), {{.molecule = 0}});
        REQUIRE(f.is_done);
        CHECK(f.derivatives.mobile == 0);
        CHECK(find_relaxed_stiffness(f.derivatives, f.factor).isZero());
    }
}

TEST_CASE("what is not finite has no factor", "[statics][factor]") {
    SecondDerivatives derivatives;
    derivatives.mobile = 2;
    derivatives.all = Eigen::MatrixXd::Constant(2, 2, std::numeric_limits<double>::quiet_NaN());
    AtomMetric metric{{{0, 0, 1}, {1, 1, 1}}};
    ResponseFactor factor;

    CHECK(!update_response_factor(derivatives, metric, {}, factor));
}

// Two rods on joints along z, the end of the second on a hand's spring: the arm follows in its
// plane.
TEST_CASE("an arm of two joints follows a hand in its plane, not across it", "[statics][factor]") {
    test::TorsionCase rods;
    const Vec3 up(0, 0, 1), elbow(1.5, 0.5, 0);
    for (const double fold : {0.2, 0.9, 2.4}) {
        const Vec3 end = elbow + 1.2 * Vec3(std::cos(fold), std::sin(fold), 0);
        rods.positions = {-up, Vec3::Zero(), elbow - up, elbow, end, Vec3(-1, 0, -1)};
        rods.masses.assign(6, 12);
        rods.bodies.bodies = {{}, {0, {0, 1}}, {1, {2, 3}}};
        rods.bodies.body_of = {0, 1, 1, 2, 2, 0};
        const TorsionModel model = test::forceless_model(rods, BaseFreedom::Held);
        TorsionState state = build_torsion_state(model);
        state.springs.push_back({.atoms = {4}, .k = 3, .place = end + 0.4 * up});

        const Factored f = factored(model, state, {{.molecule = 0, .spring = 0}});

        REQUIRE(f.is_done);
        const Mat3 K = find_relaxed_stiffness(f.derivatives, f.factor);
        CHECK(K(2, 2) == Approx(3));
        CHECK(K.topLeftCorner<2, 2>().norm() < 1e-12);
    }
}

TEST_CASE("a product with one direction is that of the matrix", "[statics][hessian]") {
    using enum BaseFreedom;
    const TorsionModel model = test::model_of(test::with_copy(test::tetrapeptide(), {14, 9, -6}),
                                              {Turning, Free}, test::all_joints);
    TorsionState state = test::state_after(model, 0.03, 21);
    state.springs.push_back({.atoms = {70, 82, 64}, .k = 15, .place = {1, -2, 20}});
    const LocalCoordinates coordinates = build_local_coordinates(
        model, std::vector<HandHold>{{.molecule = 0}, {.molecule = 1, .spring = 0}});
    const SecondDerivatives derivatives = derivatives_at(model, state, coordinates);
    TorsionState trial = build_torsion_state(model);
    ForceMemory memory;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < 5; ++i) {
        Eigen::VectorXd direction(coordinates.size());
        for (double& value : direction) value = uniform(random);
        const Eigen::VectorXd expected = derivatives.all * direction;
        const double largest = expected.cwiseAbs().maxCoeff();
        HessianProductSettings settings;

        const std::size_t before = memory.evaluations;
        const Eigen::VectorXd product =
            find_hessian_product(model, coordinates, settings, memory, state, direction, trial);

        CHECK(memory.evaluations == before + 2);
        CHECK((product - expected).cwiseAbs().maxCoeff() < 3e-5 * largest);

        settings.forces.fast = true;
        const Eigen::VectorXd fast =
            find_hessian_product(model, coordinates, settings, memory, state, direction, trial);
        CHECK((fast - expected).cwiseAbs().maxCoeff() < 1e-2 * largest);
    }
    CHECK(find_hessian_product(model, coordinates, {}, memory, state,
                               Eigen::VectorXd::Zero(coordinates.size()), trial)
              .isZero());
}
