// TL-3 in HIV-1 protease against a sum by an independent program (tests/data/README.md), and what a
// rigid body in space must do.
#include "core/files.h"
#include "core/text.h"
#include "core/units.h"
#include "field/pair_field.h"
#include "scene/read_scene.h"
#include "simulation/components.h"
#include "simulation/probe.h"
#include "simulation/relax.h"
#include "simulation/simulation.h"
#include "simulation/step.h"
#include "simulation/touch.h"
#include "tests/support/paths.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
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
    Simulation simulation = load_simulation(hiv_scene());
    std::vector<Vec3> places;
    Vec3 centre = Vec3::Zero();

    Shipped() {
        const std::string text = read_text_file(test::in_project("scenes/hiv/system.crd"));
        double mass = 0;
        for (const std::string_view line : split_lines(text)) {
            const std::vector<std::string_view> words = split_words(line);
            if (words.size() != 10 || words[7] != "TL3C") continue;
            const double m = simulation.atoms.mass.at(places.size());
            places.emplace_back(*find_real(words[4]), *find_real(words[5]), *find_real(words[6]));
            centre += m * places.back();
            mass += m;
        }
        centre /= mass;
    }

    FieldSum field(const std::vector<Vec3>& moved) const {
        FieldPoints group = grabbed_points(simulation);
        group.positions = moved;
        return evaluate_pair_field(group, environment_points(simulation), pair_rule(simulation));
    }
};

}  // namespace

TEST_CASE("energy, force and torque on TL-3 are those of an independent sum", "[simulation][hiv]") {
    const Shipped shipped;
    REQUIRE(shipped.places.size() == 130);
    REQUIRE(environment_points(shipped.simulation).positions.size() == 3145);
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
    const Simulation simulation = load_simulation(hiv_scene());
    const RelaxReport& report = simulation.relaxed.value();

    CHECK(report.force * pN < 20);
    CHECK(report.energy_after < report.energy_before);
    CHECK(report.displacement < 0.5);
    const TouchModel touch = build_touch(simulation, {}).model;
    CHECK(touch.force_newton.norm() < 20e-12);
    CHECK(touch.torque_newton_metre.norm() < 20e-12 * 10e-10);  // 20 pN at its ends
    CHECK(touch.active_freedom == 3);
    // At rest every direction pulls back, and the stiffness told is the largest.
    const FieldSum field = field_on_grabbed(simulation);
    const Vec3 stiffness = Eigen::SelfAdjointEigenSolver<Mat3>(field.stiffness).eigenvalues() *
                           units::newton_per_metre_per_kcal_per_mol_angstrom2;
    CHECK(stiffness.minCoeff() > 0);
    CHECK(touch.stiffness_N_per_m == Approx(stiffness.maxCoeff()));
    // The same again, to the last bit.
    CHECK(load_simulation(hiv_scene()).atoms.positions == simulation.atoms.positions);
}

TEST_CASE("a rigid body finds back to its rest from a little beside it", "[simulation][hiv]") {
    const Simulation simulation = load_simulation(hiv_scene());
    const FieldPoints group = grabbed_points(simulation);
    std::vector<Vec3> places(group.positions.begin(), group.positions.end());
    const std::vector<Vec3> rest = places;
    const Vec3 centre = places[0];
    const Eigen::AngleAxisd turn(0.02, Vec3(1, 2, -1).normalized());
    for (Vec3& place : places) place = centre + turn * (place - centre) + Vec3(0.05, -0.05, 0.03);

    const RelaxReport report = relax_rigid(places, centre, group, environment_points(simulation),
                                           pair_rule(simulation), 0.01 / pN);

    CHECK(report.force * pN < 0.01);
    for (std::size_t i = 0; i < places.size(); ++i) CHECK((places[i] - rest[i]).norm() < 1e-3);
}

TEST_CASE("the hand moves TL-3 in space without turning it", "[simulation][hiv]") {
    Simulation simulation = load_simulation(hiv_scene({"A_d=1e9"}));
    const std::vector<Vec3> before = simulation.atoms.positions;
    TouchModel felt = build_touch(simulation, {}).model;
    const Vec3 rest = felt.molecule.place_angstrom;
    const double energy = felt.potential_kcal_per_mol;

    // 10 mm / 1e9 = 0.1 Å.
    const Vec3 travel(0.010, -0.005, 0.002);
    const StepReport report = step_simulation(simulation, {0, travel}, felt);

    CHECK(report.finite);
    CHECK((report.touch.molecule.place_angstrom - rest - 10 * travel).norm() < 1e-12);
    CHECK(report.move == Approx(10 * travel.norm()));
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 moved = simulation.atoms.positions[i] - before[i];
        CHECK((moved - (i < 130 ? Vec3(10 * travel) : Vec3(Vec3::Zero()))).norm() < 1e-12);
    }
    // Whatever way it is moved, it is pushed back.
    CHECK(report.touch.force_newton.dot(travel) < 0);
    CHECK(report.touch.potential_kcal_per_mol > energy);
}

TEST_CASE("a step is finite wherever the hand pushes TL-3, through the protein too",
          "[simulation][hiv]") {
    Simulation simulation = load_simulation(hiv_scene({"A_d=1e9"}));
    TouchModel felt = build_touch(simulation, {}).model;

    for (int step = 0; step < 60; ++step) {
        const double angle = 0.7 * step, far = 0.05 * step;
        const StepReport report = step_simulation(
            simulation, {0, far * Vec3(std::cos(angle), std::sin(angle), std::sin(2 * angle))},
            felt);
        felt = report.touch;
        REQUIRE(report.finite);
        REQUIRE(std::isfinite(felt.potential_kcal_per_mol));
        REQUIRE(std::isfinite(felt.stiffness_N_per_m));
    }
}

TEST_CASE("a start beside the place of rest is measured from it", "[simulation][hiv]") {
    const Simulation inside = load_simulation(hiv_scene());
    const Simulation outside =
        load_simulation(hiv_scene({"hand.start_offset_angstrom=[30, 1, -2]"}));

    const Vec3 moved = build_touch(outside, {}).model.molecule.place_angstrom -
                       build_touch(inside, {}).model.molecule.place_angstrom;

    CHECK((moved - Vec3(30, 1, -2)).norm() < 1e-12);
    CHECK(grabbed_distance(inside) == 0);
    CHECK(grabbed_distance(outside) == Approx(30));
    const double wall = repulsion_distance(outside, 1e3 / pN, grabbed_distance(outside)).value();
    CHECK(wall > 20);
    CHECK(force_along_line_at(outside, wall).force * pN == Approx(1000).epsilon(1e-6));
}
