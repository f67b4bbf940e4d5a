#include "statics/second_derivatives.h"

#include "statics/pair_derivatives.h"
#include "statics/relax_joints.h"
#include "tests/support/second_differences.h"
#include "tests/support/shared_data.h"
#include "tests/support/torsion_case.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

// A model at a state, and what hands hold there.
struct HeldCase {
    TorsionModel model;
    TorsionState state;
    std::vector<HandHold> hands;
};

SecondDerivatives derivatives_of(const HeldCase& c, const LocalCoordinates& coordinates,
                                 const NonbondedSettings& settings = {}) {
    SecondDerivatives derivatives;
    update_second_derivatives(c.model, coordinates, build_model_paths(c.model), settings, c.state,
                              derivatives);
    return derivatives;
}

void check_against_differences(const HeldCase& c, const NonbondedSettings& settings,
                               Eigen::Index step = 1) {
    const LocalCoordinates coordinates = build_local_coordinates(c.model, c.hands);
    const std::vector<Eigen::Index> columns = test::every(step, coordinates.size());

    const SecondDerivatives derivatives = derivatives_of(c, coordinates, settings);

    const Eigen::MatrixXd differences =
        test::difference_columns(c.model, coordinates, settings, c.state, columns);
    CHECK(test::worst_of_row(derivatives.all, differences, columns) < 1e-6);
    CHECK(test::worst_asymmetry(derivatives.all) < 1e-12);
}

void relax(const TorsionModel& model, TorsionState& state, double rms,
           const NonbondedSettings& settings = {}) {
    RelaxSettings relax;
    relax.step.forces.nonbonded = settings;
    relax.force_tolerance = rms;
    QuasiStatics statics = build_quasi_statics(model);
    const JointRelaxReport report = relax_joints(model, relax, state, statics);
    CHECK(report.rms_force <= rms);
}

// 0.3 Å off: no atom farther.
void push_off(const TorsionModel& model, std::uint32_t seed, TorsionState& state) {
    std::mt19937 random(seed);
    Coordinates move = test::random_move(model, 0.3, random);
    const TorsionState from = state;
    place_within(model, from, 0.3, move, state);
}

// Two peptides: the first held by a hand, which may turn it; the second on the spring of another
// hand, and restrained.
HeldCase two_peptides(const test::FlexibleCase& peptide, const Vec3& away, BaseFreedom first,
                      bool turns) {
    HeldCase c{test::model_of(test::with_copy(peptide, away), {first, BaseFreedom::Free},
                              test::all_joints),
               {},
               {{.molecule = 0, .turns = turns}, {.molecule = 1, .spring = 1}}};
    const auto second = static_cast<std::uint32_t>(peptide.positions.size());
    c.state = test::state_after(c.model, 0.03, 21);
    c.state.springs.push_back({.atoms = {3, 17},
                               .k = 12,
                               .other_atoms = {second + 8, second + 13, second + 19},
                               .length = 4});
    c.state.springs.push_back(
        {.atoms = {second + 8, second + 20, second + 2}, .k = 15, .place = {1, -2, 20}});
    c.state.springs.push_back({.atoms = {5, 15}, .k = 7, .place = {3, 3, 3}, .length = 2});
    c.state.springs.push_back({.atoms = {2, 20}, .k = 9, .other_atoms = {11}});
    return c;
}

Eigen::MatrixXd stiffness_by_response(const SecondDerivatives& d) {
    return d.of_hands() -
           d.mixed().transpose() * d.of_mobile().ldlt().solve(Eigen::MatrixXd(d.mixed()));
}

}  // namespace

TEST_CASE("second derivatives of peptides are the differences of the gradient",
          "[statics][hessian]") {
    using enum BaseFreedom;
    for (const test::FlexibleCase& peptide : {test::alanine_dipeptide(), test::tetrapeptide()}) {
        for (const BaseFreedom freedom : {Held, Turning, Free}) {
            HeldCase c{test::model_of(peptide, {freedom}, test::all_joints), {}, {}};
            if (freedom != Free) c.hands.push_back({.turns = freedom == Held});
            c.state = build_torsion_state(c.model);
            relax(c.model, c.state, 1e-3);

            check_against_differences(c, {});
            push_off(c.model, 8, c.state);
            check_against_differences(c, {});
        }
    }
}

TEST_CASE("second derivatives between two peptides have springs and hands in them",
          "[statics][hessian]") {
    const test::FlexibleCase peptide = test::tetrapeptide();
    const Vec3 away(14, 9, -6);
    check_against_differences(two_peptides(peptide, away, BaseFreedom::Held, true), {});
    check_against_differences(two_peptides(peptide, away, BaseFreedom::Held, false), {});
    check_against_differences(two_peptides(peptide, away, BaseFreedom::Turning, false), {});
}

TEST_CASE("second derivatives have the cutoff that the energy has", "[statics][hessian]") {
    NonbondedSettings settings;
    settings.electrostatics = GENERATE(
        ElectrostaticCutoff::Switch, ElectrostaticCutoff::Shift, ElectrostaticCutoff::ForceShift,
        ElectrostaticCutoff::ForceSwitch, ElectrostaticCutoff::CubicShift);
    settings.van_der_waals = GENERATE(VanDerWaalsCutoff::Switch, VanDerWaalsCutoff::ForceSwitch,
                                      VanDerWaalsCutoff::SmoothSwitch);
    settings.switch_from = 6.5;
    settings.cutoff = 9;
    HeldCase c = two_peptides(test::alanine_dipeptide(), {6, 3, -2}, BaseFreedom::Turning, false);
    // No pair within the moves of the differences from where second derivatives jump.
    const auto is_clear = [&] {
        const std::vector<std::uint32_t>& body_of = c.model.tree.bodies.body_of;
        for (std::size_t i = 0; i < body_of.size(); ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                if (body_of[i] == body_of[j]) continue;
                const double r = (c.state.positions[i] - c.state.positions[j]).norm();
                if (std::abs(r - settings.cutoff) < 0.005 ||
                    std::abs(r - settings.switch_from) < 0.005)
                    return false;
            }
        }
        return true;
    };
    const std::vector<ModelSpring> springs = c.state.springs;
    for (std::uint32_t seed = 1; !is_clear() && seed < 200; ++seed) {
        c.state = test::state_after(c.model, 0.1, seed);
        c.state.springs = springs;
    }
    REQUIRE(is_clear());

    check_against_differences(c, settings);
}

TEST_CASE("second derivatives of solvated peptides are the differences of the gradient",
          "[statics][hessian][solvation]") {
    HeldCase c = two_peptides(test::solvated(test::tetrapeptide()), {14, 9, -6},
                              BaseFreedom::Turning, false);
    const LocalCoordinates coordinates = build_local_coordinates(c.model, c.hands);
    const std::vector<Eigen::Index> columns = test::every(1, coordinates.size());
    const NonbondedSettings settings = eef1_settings();

    const SecondDerivatives derivatives = derivatives_of(c, coordinates, settings);

    const Eigen::MatrixXd differences =
        test::difference_columns(c.model, coordinates, settings, c.state, columns);
    CHECK(test::worst_of_row(derivatives.all, differences, columns) < 1e-6);
    CHECK((derivatives.all - differences).cwiseAbs().maxCoeff() <
          1e-7 * derivatives.all.cwiseAbs().maxCoeff());
    CHECK(test::worst_asymmetry(derivatives.all) < 1e-12);
    // Solvation's own part.
    const NonbondedSettings vacuum = eef1_settings(SolvationEnd::None);
    const Eigen::MatrixXd part = derivatives.all - derivatives_of(c, coordinates, vacuum).all;
    const Eigen::MatrixXd expected =
        differences - test::difference_columns(c.model, coordinates, vacuum, c.state, columns);
    CHECK(part.cwiseAbs().maxCoeff() > 1);
    CHECK((part - expected).cwiseAbs().maxCoeff() < 1e-6 * part.cwiseAbs().maxCoeff());
}

TEST_CASE("second derivatives of listed pairs are those of all, where all are listed",
          "[statics][hessian][solvation]") {
    test::FlexibleCase peptide = test::solvated(test::tetrapeptide());
    Topology& topology = peptide.topology;
    topology.dihedrals.clear();
    topology.impropers.clear();
    topology.cmap_terms.clear();
    topology.exclusions.pairs14.clear();
    HeldCase c = two_peptides(peptide, {9, 6, -4}, BaseFreedom::Turning, false);
    c.state.springs.clear();
    c.hands = {{.molecule = 0}};
    const LocalCoordinates coordinates = build_local_coordinates(c.model, c.hands);
    std::vector<std::array<std::uint32_t, 2>> plain, some;
    for (std::uint32_t i = 0; i < c.model.topology.size(); ++i) {
        const auto excluded = c.model.topology.exclusions.of(i);
        for (std::uint32_t j = i + 1; j < c.model.topology.size(); ++j) {
            if (!std::ranges::binary_search(excluded, j)) plain.push_back({i, j});
        }
    }
    const auto listed = [&](const auto& pairs, const auto& solvated) {
        SecondDerivatives derivatives;
        update_pair_derivatives(c.model, coordinates, pairs, solvated, eef1_settings(), c.state,
                                derivatives);
        return derivatives.all;
    };
    const Eigen::MatrixXd all = derivatives_of(c, coordinates, eef1_settings()).all;
    const double largest = all.cwiseAbs().maxCoeff();

    CHECK((listed(plain, plain) - all).cwiseAbs().maxCoeff() < 1e-11 * largest);
    CHECK((listed(plain, some) -
           derivatives_of(c, coordinates, eef1_settings(SolvationEnd::None)).all)
              .cwiseAbs()
              .maxCoeff() < 1e-11 * largest);
    // Any share of them, and the rest.
    std::vector<std::array<std::uint32_t, 2>> others;
    for (const auto& pair : plain) (pair[1] % 5 == 0 ? some : others).push_back(pair);
    CHECK((listed(some, others) + listed(others, some) - all).cwiseAbs().maxCoeff() <
          1e-11 * largest);
    CHECK(listed(std::span(plain).first(0), std::span(plain).first(0)).isZero(0));
}

TEST_CASE("nothing changes where everything moves as one", "[statics][hessian]") {
    using enum BaseFreedom;
    HeldCase c{
        test::model_of(test::with_copy(test::tetrapeptide(), {9, 4, -2}), {Free, Free}), {}, {}};
    c.state = build_torsion_state(c.model);
    relax(c.model, c.state, 2e-5);
    const LocalCoordinates coordinates = build_local_coordinates(c.model);
    const SecondDerivatives derivatives = derivatives_of(c, coordinates);

    for (int axis = 0; axis < 3; ++axis) {
        Eigen::VectorXd shift = Eigen::VectorXd::Zero(coordinates.size()), turn = shift;
        for (std::uint32_t m = 0; m < 2; ++m) {
            const Eigen::Index first = c.model.coordinate_of_base[m];
            shift[first + 3 + axis] = 1;
            turn[first + axis] = 1;
            turn.segment<3>(first + 3) = Vec3(Vec3::Unit(axis)).cross(c.state.pivots[m]);
        }

        const double largest = derivatives.all.cwiseAbs().maxCoeff();
        CHECK((derivatives.all * shift).cwiseAbs().maxCoeff() < 1e-12 * largest);
        CHECK((derivatives.all * turn).cwiseAbs().maxCoeff() < 1e-3);
    }
}

TEST_CASE("the stiffness that a hand feels is that of relaxed forces", "[statics][hessian]") {
    using enum BaseFreedom;
    // Held at one end, and by a spring at the other.
    const std::vector<HandHold> hands{{.molecule = 0, .spring = 0}};
    HeldCase c{test::model_of(test::tetrapeptide(), {Held}, test::all_joints), {}, hands};
    c.state = build_torsion_state(c.model);
    c.state.springs.push_back({.atoms = {50, 55, 58}, .k = 5, .place = c.state.positions[55]});
    relax(c.model, c.state, 1e-5);
    const LocalCoordinates coordinates = build_local_coordinates(c.model, hands);

    const Mat3 K = stiffness_by_response(derivatives_of(c, coordinates));

    Mat3 expected;
    for (int axis = 0; axis < 3; ++axis) {
        const auto pulled = [&](double by) -> Vec3 {
            TorsionState state = c.state;
            state.springs[0].place[axis] += by;
            relax(c.model, state, 1e-5);
            return -find_spring_force(c.model, state.springs[0], state.positions);
        };
        expected.col(axis) = (pulled(0.01) - pulled(-0.01)) / 0.02;
    }
    CHECK((K - expected).norm() < 0.01 * expected.norm());
    CHECK(K.norm() < 0.9 * c.state.springs[0].k * std::sqrt(3.0));
}

// Two rods in a plane, on joints along z, the first of which stands on the ground; the end of the
// second is on a spring that a hand holds.
TEST_CASE("two joints in a plane have the second derivatives of their closed form",
          "[statics][hessian]") {
    constexpr double a = 1.6, b = 1.1, alpha = 0.4, beta = 0.7, k = 3;
    test::TorsionCase rods;
    // Atoms 0 and 1 make the first axis, 2 and 3 the second, 4 is the end.
    const Vec3 up(0, 0, 1);
    const Vec3 elbow(a * std::cos(alpha), a * std::sin(alpha), 0);
    const Vec3 end = elbow + b * Vec3(std::cos(alpha + beta), std::sin(alpha + beta), 0);
    rods.positions = {-up, Vec3::Zero(), elbow - up, elbow, end, Vec3(-1, 0, -1)};
    rods.masses.assign(6, 12);
    rods.bodies.bodies = {{}, {0, {0, 1}}, {1, {2, 3}}};
    rods.bodies.body_of = {0, 1, 1, 2, 2, 0};
    HeldCase c{test::forceless_model(rods, BaseFreedom::Held), {}, {{.molecule = 0, .spring = 0}}};
    c.state = build_torsion_state(c.model);
    const Vec3 place = end + Vec3(0.5, -0.8, 0);
    c.state.springs.push_back({.atoms = {4}, .k = k, .place = place});
    const LocalCoordinates coordinates = build_local_coordinates(c.model, c.hands);

    const SecondDerivatives derivatives = derivatives_of(c, coordinates);

    // x(alpha, beta), y(alpha, beta): E = k/2 ((x - X)^2 + (y - Y)^2).
    const Vec3 far = end - elbow;
    const Vec3 d_alpha(-end.y(), end.x(), 0), d_beta(-far.y(), far.x(), 0), stretch = end - place;
    Eigen::Matrix2d H;
    H(0, 0) = k * (d_alpha.dot(d_alpha) - stretch.dot(end));
    H(0, 1) = H(1, 0) = k * (d_alpha.dot(d_beta) - stretch.dot(far));
    H(1, 1) = k * (d_beta.dot(d_beta) - stretch.dot(far));
    CHECK((derivatives.of_mobile() - H).norm() < 1e-13);
    CHECK((derivatives.mixed().row(0).transpose() + k * d_alpha).norm() < 1e-13);
    CHECK((derivatives.mixed().row(1).transpose() + k * d_beta).norm() < 1e-13);
    CHECK((derivatives.of_hands() - k * Mat3::Identity()).norm() < 1e-13);
}

TEST_CASE("second derivatives of crambin are the differences of the gradient",
          "[statics][hessian][slow]") {
    const auto folder = test::find_shared_data("reference");
    if (!folder) return;
    HeldCase c{
        test::model_of(test::read_flexible_case(*folder, "crambin_c36m", "minimised_300_steps"),
                       {BaseFreedom::Free}),
        {},
        {}};
    c.state = build_torsion_state(c.model);
    relax(c.model, c.state, 0.1);

    check_against_differences(c, {}, 7);
    push_off(c.model, 3, c.state);
    check_against_differences(c, {}, 7);
}
