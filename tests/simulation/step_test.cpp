#include "simulation/step.h"
#include "simulation/touch.h"

#include "core/units.h"
#include "simulation/probe.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace palpa;

namespace {

HandPose hand_at(double travel_m) {
    HandPose hand;
    hand.travel_m.x() = travel_m;
    return hand;
}

}  // namespace

TEST_CASE("the molecule goes the handle's travel divided by A_d, step by step",
          "[simulation][step]") {
    Simulation simulation = load_simulation(test::water_scene({"mode=2"}));
    TouchModel felt = build_touch(simulation, {}).model;

    // 25 mm / 0.25e9 = 1 Å; travel counts from the last step, across the axis it does nothing.
    felt = step_simulation(simulation, hand_at(-0.025), felt).touch;
    CHECK(felt.molecule.place_angstrom.x() == Approx(6));
    HandPose aside = hand_at(-0.025);
    aside.travel_m.y() = 1;
    felt = step_simulation(simulation, aside, felt).touch;
    CHECK(felt.molecule.place_angstrom.x() == Approx(6));
    const StepReport back = step_simulation(simulation, hand_at(0), felt);
    CHECK(back.touch.molecule.place_angstrom.x() == Approx(7));
    CHECK(back.move == Approx(1));
}

TEST_CASE("A_d follows the force that is felt, not the one just computed", "[simulation][step]") {
    Simulation simulation = load_simulation(test::water_scene({"mode=1"}));
    TouchModel felt;
    felt.force_newton = Vec3(20e-12, 0, 0);  // A_d = 1.2552e8 whatever the molecule is at

    const StepReport report = step_simulation(simulation, hand_at(-0.012552), felt);

    CHECK(report.touch.displacement_gain == Approx(1.2552e8).epsilon(1e-4));
    CHECK(report.touch.molecule.place_angstrom.x() == Approx(6).margin(1e-4));
}

TEST_CASE("a touch model tells force, stiffness and energy of the line in SI",
          "[simulation][step]") {
    Simulation simulation = load_simulation(test::water_scene());
    move_grabbed(simulation, 3.1);

    const TouchModel touch = build_touch(simulation, {}).model;

    CHECK(touch.force_newton.x() == Approx(-0.322e-9).epsilon(0.005));
    CHECK(touch.force_newton.y() == 0);
    CHECK(touch.molecule.place_angstrom.x() == Approx(3.1));
    CHECK(touch.active_freedom == 1);
    CHECK(touch.period_s == Approx(1e-3));
    // Stiffness against the difference of forces, energy against their integral from far away.
    const auto newton = [&](double r) {
        return force_along_line_at(simulation, r).force * units::newton_per_kcal_per_mol_angstrom;
    };
    CHECK(touch.stiffness_N_per_m ==
          Approx(-(newton(3.1 + 1e-5) - newton(3.1 - 1e-5)) / 2e-15).epsilon(1e-5));
    double work = 0;
    for (double r = 3.1 + 5e-4; r < 200; r += 1e-3)
        work += force_along_line_at(simulation, r).force * 1e-3;
    CHECK(touch.potential_kcal_per_mol == Approx(work).epsilon(1e-4));
}

TEST_CASE("a hand pose that is no number moves nothing and is reported", "[simulation][step]") {
    Simulation simulation = load_simulation(test::water_scene());
    const TouchModel felt = build_touch(simulation, {}).model;

    const StepReport report =
        step_simulation(simulation, hand_at(std::numeric_limits<double>::quiet_NaN()), felt);

    CHECK_FALSE(report.finite);
    CHECK(report.touch.molecule.place_angstrom.x() == 7);
    CHECK(force_along_line(simulation).energy == Approx(felt.potential_kcal_per_mol));
}
