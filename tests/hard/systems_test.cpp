// Systems at which steps could go wrong, in every way of stepping: nothing becomes infinite, no
// energy comes from nowhere, bodies keep their shape, and reports say what happened.
#include "molecule/coincident_atoms.h"
#include "statics/relax_joints.h"
#include "tests/hard/made_up_systems.h"
#include "tests/hard/ways_of_stepping.h"
#include "tests/support/load_error_of.h"
#include "tests/support/shared_data.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::check_all_ways;
using test::Outcome;
using enum palpa::BaseFreedom;

namespace {

void check_all_ways(const TorsionModel& model, int steps) {
    test::check_all_ways(model, build_torsion_state(model), steps);
}

test::FlexibleCase with_charges(test::FlexibleCase c, double factor) {
    for (double& charge : c.topology.charge) charge *= factor;
    return c;
}

}  // namespace

TEST_CASE("molecules on top of each other part, an atom by 0.05 Å a step", "[hard]") {
    const auto shift = GENERATE(Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(1, -0.5, 0.3));
    const TorsionModel model =
        test::model_of(test::with_copy(test::alanine_dipeptide(), shift), {Turning, Free});

    test::check_all_ways(model, build_torsion_state(model), 60,
                         [&](const Outcome& outcome, const TorsionState& state) {
                             CHECK(outcome.is_finite);
                             CHECK(outcome.bounded > 0);
                             CHECK(test::exact_energy(model, state) <
                                   test::exact_energy(model, build_torsion_state(model)) / 2);
                         });
}

TEST_CASE("a molecule and its copy in one place are finite, and are named", "[hard]") {
    test::FlexibleCase c = test::with_copy(test::tetrapeptide(), Vec3::Zero());
    const std::size_t atoms = c.positions.size() / 2;
    for (std::size_t i = 0; i < atoms; ++i) c.positions[i + atoms] = c.positions[i];
    const TorsionModel model = test::model_of(c, {Held, Free});

    check_all_ways(model, 40);
    const auto words = describe_coincident_atoms(c.connectivity.names, c.positions, 0.5);
    REQUIRE(words);
    CHECK_THAT(*words, Contains("0.00 Å apart, and 61 more such pairs"));
}

TEST_CASE("two atoms in one place push nowhere, and their report says at rest", "[hard]") {
    const test::FlexibleCase c = test::ions({{1, 2, 3}, {1, 2, 3}}, 1);
    const TorsionModel model = test::model_of(c, {Free, Free});
    TorsionState state = build_torsion_state(model);
    QuasiStatics statics = build_quasi_statics(model);

    const JointRelaxReport report = relax_joints(model, {}, state, statics);

    // Which is why a start is looked at for atoms on each other.
    CHECK(report.end == RelaxEnd::Converged);
    CHECK(describe_coincident_atoms(c.connectivity.names, c.positions, 0.5));
    check_all_ways(model, 5);
}

TEST_CASE("bodies of one atom have no orientation to turn", "[hard]") {
    const auto first = GENERATE(Held, Turning, Free);
    const auto second = GENERATE(Held, Turning, Free);
    const double distance = GENERATE(0.02, 0.3, 2.0, 4.0, 30.0);
    const TorsionModel model =
        test::model_of(test::ions({{0, 0, 0}, {distance, 0, 0}}, 1), {first, second});

    check_all_ways(model, 30);
}

TEST_CASE("one water alone feels nothing and goes nowhere", "[hard]") {
    const auto freedom = GENERATE(Held, Turning, Free);
    const TorsionModel model = test::model_of(test::waters({{4, 5, 6}}), {freedom});

    test::check_all_ways(model, build_torsion_state(model), 10,
                         [&](const Outcome& outcome, const TorsionState& state) {
                             CHECK(outcome.is_finite);
                             CHECK(outcome.refused == 0);
                             CHECK(state.energy() == 0);
                             CHECK(find_largest_move(state.positions, model.reference) == 0);
                         });
}

TEST_CASE("waters in each other part", "[hard]") {
    const auto shift = GENERATE(Vec3(0, 0, 0), Vec3(0.3, 0.1, 0.2), Vec3(1.2, 0, 0));
    const TorsionModel model =
        test::model_of(test::waters({{0, 0, 0}, shift, {2, 2, 0.5}}), {Held, Free, Turning});

    check_all_ways(model, 100);
}

TEST_CASE("everything fixed is at rest whatever pulls", "[hard]") {
    const TorsionModel model =
        test::model_of(test::with_copy(test::alanine_dipeptide(), {1, 0, 0}), {Held, Held},
                       {.overrides = {{{6, 8}, BondMotion::Rigid},
                                      {{8, 14}, BondMotion::Rigid},
                                      {{28, 30}, BondMotion::Rigid},
                                      {{30, 36}, BondMotion::Rigid}}});
    REQUIRE(model.coordinates == 0);

    test::check_all_ways(model, build_torsion_state(model), 5,
                         [&](const Outcome& outcome, const TorsionState& state) {
                             CHECK(outcome.is_finite);
                             CHECK(outcome.bounded == 0);
                             CHECK(state.positions == model.reference);
                         });
}

TEST_CASE("axes on one line turn each on its own", "[hard]") {
    const auto freedom = GENERATE(Held, Turning, Free);
    const test::FlexibleCase c = test::axes_in_line(8, 1.2);
    const TorsionModel model = test::model_of(c, {freedom});
    REQUIRE(model.tree.bodies.joints() == 7);

    test::check_all_ways(model, build_torsion_state(model), 200,
                         [&](const Outcome& outcome, const TorsionState& state) {
                             CHECK(outcome.is_finite);
                             CHECK(outcome.taken > 100);
                             CHECK(state.angles != build_torsion_state(model).angles);
                         });
}

TEST_CASE("a body whose atoms are all on its axis is refused in words", "[hard]") {
    const std::string error =
        test::load_error_of([] { test::model_of(test::axes_in_line(4, 0), {Free}); });

    CHECK_THAT(error, Contains("has only collinear atoms on one side"));
    CHECK_THAT(error, Contains("expected it to be rigid"));
}

TEST_CASE("atoms a hundredth of an angstrom beside their axes turn within bounds", "[hard]") {
    const auto freedom = GENERATE(Held, Turning, Free);
    const TorsionModel model = test::model_of(test::axes_in_line(5, 0.01), {freedom});

    check_all_ways(model, 200);
}

TEST_CASE("a spring that pulls along an axis, or at a pivot, has no lever to turn it", "[hard]") {
    const test::FlexibleCase c = test::axes_in_line(4, 1.2);
    const auto freedom = GENERATE(Held, Turning);
    const TorsionModel model = test::model_of(c, {freedom});
    TorsionState start = build_torsion_state(model);
    // The pivot, and an atom of the last axis; both are on the line.
    const std::uint32_t atom = GENERATE(0U, 6U);
    REQUIRE(c.positions[atom].tail<2>().norm() == 0);
    start.springs = {{{atom}, 1000, c.positions[atom] + Vec3(20, 0, 0)}};

    test::check_all_ways(model, start, 50, [&](const Outcome& outcome, const TorsionState& state) {
        CHECK(outcome.is_finite);
        // All on the line are as far from the pivot as ever; a base that turns may tilt it.
        CHECK(state.positions[atom].norm() == Approx(c.positions[atom].norm()).margin(1e-9));
        if (freedom == Held) CHECK((state.positions[atom] - c.positions[atom]).norm() < 1e-9);
    });
}

TEST_CASE("a ring of disulphides stays a ring", "[hard]") {
    const std::size_t units = GENERATE(std::size_t{2}, std::size_t{3}, std::size_t{6});
    const auto freedom = GENERATE(Held, Free);
    const test::FlexibleCase c = test::disulphide_ring(units);
    const TorsionModel model = test::model_of(c, {freedom});
    const std::vector<std::array<std::uint32_t, 2>>& springs = model.tree.bodies.springs;
    // One of them opens the ring; the others hold the rest together.
    REQUIRE(springs.size() == 1);
    REQUIRE(model.bases.size() == 1);

    test::check_all_ways(model, build_torsion_state(model), 400,
                         [&](const Outcome& outcome, const TorsionState& state) {
                             CHECK(outcome.is_finite);
                             CHECK(outcome.taken > 100);
                             for (const auto& [a, b] : springs) {
                                 const Vec3 bond = state.positions[a] - state.positions[b];
                                 CHECK(bond.norm() == Approx(2.03).margin(0.1));
                             }
                         });
}

TEST_CASE("proline turns with its ring in one piece", "[hard]") {
    const auto folder = test::find_shared_data("reference");
    if (!folder) return;
    const test::FlexibleCase c = test::read_flexible_case(*folder, "tetra_ampa_c36m");
    const TorsionModel model = test::model_of(c, {Free}, test::all_joints);
    // N, CA, CB, CD and CG of the ring are one body.
    std::vector<std::uint32_t> ring;
    for (std::uint32_t i = 0; i < c.connectivity.names.size(); ++i) {
        const AtomName& name = c.connectivity.names[i];
        for (const char* const atom : {"N", "CA", "CB", "CG", "CD"}) {
            if (name.residue == "PRO" && name.atom == atom) ring.push_back(i);
        }
    }
    REQUIRE(ring.size() == 5);
    const std::vector<std::uint32_t>& body_of = model.tree.bodies.body_of;
    for (const std::uint32_t atom : ring) CHECK(body_of[atom] == body_of[ring[0]]);

    test::check_all_ways(model, test::state_after(model, 2, 5), 150,
                         [](const Outcome& outcome, const TorsionState&) {
                             CHECK(outcome.is_finite);
                             CHECK(outcome.taken > 75);
                         });
}

TEST_CASE("huge charges pull and push no harder than a step allows", "[hard]") {
    const double factor = GENERATE(30.0, 1e3, 1e6, 1e12);
    INFO("charges " << factor << " times what they are");
    const auto away = GENERATE(Vec3(3, 1, 2), Vec3(12, 5, -2));
    const TorsionModel model = test::model_of(
        with_charges(test::with_copy(test::alanine_dipeptide(), away), factor), {Turning, Free});

    test::check_all_ways(model, build_torsion_state(model), 60,
                         [](const Outcome& outcome, const TorsionState&) {
                             CHECK(outcome.is_finite);
                             CHECK(outcome.bounded > 0);
                         });
}

TEST_CASE("charges whose energies are no numbers move nothing, and reports say so", "[hard]") {
    const double factor = GENERATE(1e20, 1e100, 1e160, 1e200);
    INFO("charges " << factor << " times what they are");
    const TorsionModel model = test::model_of(
        with_charges(test::with_copy(test::alanine_dipeptide(), {5, 1, 2}), factor), {Held, Free});

    test::check_all_ways(model, build_torsion_state(model), 3,
                         [&](const Outcome& outcome, const TorsionState& state) {
                             CHECK((outcome.is_finite || outcome.taken == 0));
                             CHECK((outcome.is_finite || state.positions == model.reference));
                         });
}
