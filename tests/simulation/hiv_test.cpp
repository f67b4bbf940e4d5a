// TL-3 in HIV-1 protease against a sum by an independent program (tests/data/README.md), and what a
// rigid body in space must do.
#include "core/files.h"
#include "core/text.h"
#include "core/units.h"
#include "field/pair_field.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/step.h"
#include "simulation/systems/publish_contact.h"
#include "statics/relax_rigid.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
using Catch::Matchers::WithinRel;

namespace {

constexpr double pN = units::newton_per_kcal_per_mol_angstrom * 1e12;

SceneDescription hiv_scene(const std::vector<std::string>& settings = {}) {
    return read_scene(test::in_project("scenes/hiv"), settings);
}

// The numbers behind a row's name.
std::vector<double> numbers(std::string_view row) {
    std::vector<double> values;
    for (std::size_t at = row.find(','); at < row.size();) {
        const std::size_t end = std::min(row.find(',', at + 1), row.size());
        values.push_back(find_real(row.substr(at + 1, end - at - 1)).value());
        at = end;
    }
    return values;
}

// The inhibitor as the file has it, before it was relaxed.
struct Shipped {
    World world;
    std::vector<Vec3> places;
    Vec3 centre = Vec3::Zero();

    explicit Shipped(const SceneDescription& scene) : world(load_world(scene)) {
        const std::string text = read_text_file(test::in_project("scenes/hiv/system.crd"));
        double mass = 0;
        const AtomRange held = held_range(world, hand_at(world, 0));
        for (const std::string_view line : split_lines(text)) {
            const std::vector<std::string_view> words = split_words(line);
            if (words.size() != 10 || words[7] != "TL3C") continue;
            const double m = world.resource<AtomTable>().mass.read().at(held.first + places.size());
            places.emplace_back(*find_real(words[4]), *find_real(words[5]), *find_real(words[6]));
            centre += m * places.back();
            mass += m;
        }
        centre /= mass;
    }

    FieldSum field(const std::vector<Vec3>& moved) const {
        FieldPoints group = held_points(world, hand_at(world, 0));
        group.positions = moved;
        return field_on(world, hand_at(world, 0), group);
    }
};

}  // namespace

TEST_CASE("energy, force and torque on TL-3 are those of an independent sum", "[simulation][hiv]") {
    const std::size_t number = GENERATE(0, 1, 2);
    const Shipped shipped(test::with_held_at(number, hiv_scene()));
    REQUIRE(shipped.places.size() == 130);
    REQUIRE(count_environment(shipped.world, hand_at(shipped.world, 0)) == 3145);
    const std::string text = read_text_file(test::test_data("hiv_poses.csv"));
    const std::vector<std::string_view> rows = split_lines(text);
    REQUIRE(rows.size() == 5);

    for (std::size_t row = 1; row < rows.size(); ++row) {
        INFO(rows[row]);
        const std::vector<double> v = numbers(rows[row]);
        REQUIRE(v.size() == 12);
        const Vec3 shift = 10 * Vec3(v[0], v[1], v[2]);
        const Eigen::AngleAxisd turn(v[3] * std::numbers::pi / 180, Vec3::UnitZ());
        std::vector<Vec3> moved;
        for (const Vec3& place : shipped.places) {
            moved.emplace_back(shipped.centre + turn * (place - shipped.centre) + shift);
        }

        const FieldSum field = shipped.field(moved);

        // The scene has charges of six decimals, the independent sum reads the same ones.
        CHECK_THAT(field.van_der_waals * 4.184, WithinRel(v[4], 1e-8));
        CHECK_THAT(field.electrostatic * 4.184, WithinRel(v[5], 1e-8));
        const Vec3 force(v[6], v[7], v[8]), torque(v[9], v[10], v[11]);
        CHECK((field.force * 41.84 - force).norm() < 1e-8 * force.norm() + 1e-4);
        CHECK((field.torque_about(shipped.centre + shift) * 4.184 - torque).norm() <
              1e-8 * torque.norm() + 1e-4);
    }
}

TEST_CASE("loading brings TL-3 to rest in all six degrees of freedom", "[simulation][hiv]") {
    const World world = load_world(hiv_scene());
    const RelaxReport& report = world.resource<StartReport>().rigid.value();

    CHECK(report.force * pN < 20);
    CHECK(report.energy_after < report.energy_before);
    CHECK(report.displacement < 0.5);
    const ContactModel contact = build_local_contact(world, hand_at(world, 0), {}).model;
    CHECK(contact.force_newton.norm() < 20e-12);
    CHECK(contact.torque_newton_metre.norm() < 20e-12 * 10e-10);  // 20 pN at its ends
    CHECK(contact.active_freedom == 3);
    // At rest every direction pulls back, and the stiffness told is the largest.
    const FieldSum field = field_on_grabbed(world);
    const Vec3 stiffness = Eigen::SelfAdjointEigenSolver<Mat3>(field.stiffness).eigenvalues() *
                           units::newton_per_metre_per_kcal_per_mol_angstrom2;
    CHECK(stiffness.minCoeff() > 0);
    CHECK(contact.stiffness_N_per_m == Approx(stiffness.maxCoeff()));
    // The same again, to the last bit.
    CHECK(load_world(hiv_scene()).resource<AtomTable>().positions ==
          world.resource<AtomTable>().positions);
}

TEST_CASE("TL-3 comes to the same rest wherever it stands in the table", "[simulation][hiv]") {
    const std::size_t number = GENERATE(0, 1);
    const World last = load_world(hiv_scene()),
                world = load_world(test::with_held_at(number, hiv_scene()));
    const std::span<const Vec3> expected = held_points(last, hand_at(last, 0)).positions,
                                found = held_points(world, hand_at(world, 0)).positions;

    REQUIRE(held_range(world, hand_at(world, 0)).first < held_range(last, hand_at(last, 0)).first);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) CHECK((found[i] - expected[i]).norm() < 1e-4);
}

TEST_CASE("a rigid body finds back to its rest from a little beside it", "[simulation][hiv]") {
    const World world = load_world(hiv_scene());
    const FieldPoints group = held_points(world, hand_at(world, 0));
    std::vector<Vec3> places(group.positions.begin(), group.positions.end());
    const std::vector<Vec3> rest = places;
    const Vec3 centre = places[0];
    const Eigen::AngleAxisd turn(0.02, Vec3(1, 2, -1).normalized());
    for (Vec3& place : places) place = centre + turn * (place - centre) + Vec3(0.05, -0.05, 0.03);

    const GatheredPoints environment(world.resource<AtomTable>(), test::atoms_around(world));
    const RelaxReport report =
        relax_rigid(places, centre, group, environment.view(), pair_rule(world), 0.01 / pN);

    CHECK(report.force * pN < 0.01);
    for (std::size_t i = 0; i < places.size(); ++i) CHECK((places[i] - rest[i]).norm() < 1e-3);
}

TEST_CASE("the hand moves TL-3 in space without turning it", "[simulation][hiv]") {
    World world = load_world(hiv_scene({"A_d=1e9"}));
    const std::vector<Vec3> before = world.resource<AtomTable>().positions;
    ContactModel felt = build_local_contact(world, hand_at(world, 0), {}).model;
    const Vec3 rest = felt.molecule.place_angstrom;
    const double energy = felt.potential_kcal_per_mol;

    // 10 mm / 1e9 = 0.1 Å.
    const Vec3 travel(0.010, -0.005, 0.002);
    const AtomRange held = held_range(world, hand_at(world, 0));
    const StepReport& report = step_world(world, {0, travel}, felt);

    CHECK(report.finite);
    CHECK((contact_at(world, 0).model.molecule.place_angstrom - rest - 10 * travel).norm() < 1e-12);
    CHECK(report.moves.front().angstrom == Approx(10 * travel.norm()));
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 moved = world.resource<AtomTable>().positions[i] - before[i];
        CHECK((moved - (has_atom(held, i) ? Vec3(10 * travel) : Vec3(Vec3::Zero()))).norm() <
              1e-12);
    }
    // Whatever way it is moved, it is pushed back.
    CHECK(contact_at(world, 0).model.force_newton.dot(travel) < 0);
    CHECK(contact_at(world, 0).model.potential_kcal_per_mol > energy);
}

TEST_CASE("a step is finite wherever the hand pushes TL-3, through the protein too",
          "[simulation][hiv]") {
    World world = load_world(hiv_scene({"A_d=1e9"}));
    ContactModel felt = build_local_contact(world, hand_at(world, 0), {}).model;

    for (int step = 0; step < 60; ++step) {
        const double angle = 0.7 * step, far = 0.05 * step;
        const StepReport& report = step_world(
            world, {0, far * Vec3(std::cos(angle), std::sin(angle), std::sin(2 * angle))}, felt);
        felt = contact_at(world, 0).model;
        REQUIRE(report.finite);
        REQUIRE(std::isfinite(felt.potential_kcal_per_mol));
        REQUIRE(std::isfinite(felt.stiffness_N_per_m));
    }
}

TEST_CASE("a start beside the place of rest is measured from it", "[simulation][hiv]") {
    const World inside = load_world(hiv_scene());
    const World outside = load_world(hiv_scene({"hand.start_offset_angstrom=[30, 1, -2]"}));

    const Vec3 moved =
        build_local_contact(outside, hand_at(outside, 0), {}).model.molecule.place_angstrom -
        build_local_contact(inside, hand_at(inside, 0), {}).model.molecule.place_angstrom;

    CHECK((moved - Vec3(30, 1, -2)).norm() < 1e-12);
    CHECK(grabbed_distance(inside) == 0);
    CHECK(grabbed_distance(outside) == Approx(30));
    const double wall = repulsion_distance(outside, 1e3 / pN, grabbed_distance(outside)).value();
    CHECK(wall > 20);
    CHECK(force_along_line_at(outside, wall).force * pN == Approx(1000).epsilon(1e-6));
}
