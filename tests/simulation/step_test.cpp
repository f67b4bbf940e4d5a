#include "simulation/step.h"
#include "simulation/systems/publish_contact.h"

#include "core/units.h"
#include "loading/load.h"
#include "simulation/probe.h"
#include "tests/support/step_once.h"
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
    World world = load_world(test::water_scene({"mode=2"}));
    ContactModel felt = build_local_contact(world, hand_at(world, 0), {}).model;

    // 25 mm / 0.25e9 = 1 Å; travel counts from the last step, across the axis it does nothing.
    felt = test::step_once(world, hand_at(-0.025), felt);
    CHECK(felt.molecule.place_angstrom.x() == Approx(6));
    HandPose aside = hand_at(-0.025);
    aside.travel_m.y() = 1;
    felt = test::step_once(world, aside, felt);
    CHECK(felt.molecule.place_angstrom.x() == Approx(6));
    const StepReport& back = step_world(world, hand_at(0), felt);
    CHECK(contact_at(world, 0).model.molecule.place_angstrom.x() == Approx(7));
    CHECK(back.moves.front().angstrom == Approx(1));
}

TEST_CASE("A_d follows the force that is felt, not the one just computed", "[simulation][step]") {
    World world = load_world(test::water_scene({"mode=1"}));
    ContactModel felt;
    felt.force_newton = Vec3(20e-12, 0, 0);  // A_d = 1.2552e8 whatever the molecule is at

    (void)step_world(world, hand_at(-0.012552), felt);

    CHECK(contact_at(world, 0).model.displacement_gain == Approx(1.2552e8).epsilon(1e-4));
    CHECK(contact_at(world, 0).model.molecule.place_angstrom.x() == Approx(6).margin(1e-4));
}

TEST_CASE("a contact model has force, stiffness and energy of the line in SI",
          "[simulation][step]") {
    World world = load_world(test::water_scene());
    move_grabbed(world, 3.1);

    const ContactModel contact = build_local_contact(world, hand_at(world, 0), {}).model;

    CHECK(contact.force_newton.x() == Approx(-0.322e-9).epsilon(0.005));
    CHECK(contact.force_newton.y() == 0);
    CHECK(contact.molecule.place_angstrom.x() == Approx(3.1));
    CHECK(contact.active_freedom == 1);
    CHECK(contact.period_s == Approx(1e-3));
    // Stiffness against the difference of forces, energy against their integral from far away.
    const auto newton = [&](double r) {
        return force_along_line_at(world, r).force * units::newton_per_kcal_per_mol_angstrom;
    };
    CHECK(contact.stiffness_N_per_m ==
          Approx(-(newton(3.1 + 1e-5) - newton(3.1 - 1e-5)) / 2e-15).epsilon(1e-5));
    double work = 0;
    for (double r = 3.1 + 5e-4; r < 200; r += 1e-3)
        work += force_along_line_at(world, r).force * 1e-3;
    CHECK(contact.potential_kcal_per_mol == Approx(work).epsilon(1e-4));
}

TEST_CASE("a hand pose that is no number moves nothing and is reported", "[simulation][step]") {
    World world = load_world(test::water_scene());
    const ContactModel felt = build_local_contact(world, hand_at(world, 0), {}).model;

    const StepReport report =
        step_world(world, hand_at(std::numeric_limits<double>::quiet_NaN()), felt);

    CHECK_FALSE(report.finite);
    CHECK(contact_at(world, 0).model.molecule.place_angstrom.x() == 7);
    CHECK(force_along_line(world).energy == Approx(felt.potential_kcal_per_mol));
}

TEST_CASE("a contact force that is not finite stays until a step is finite again, for the servo",
          "[simulation][step]") {
    World world = load_world(test::water_scene({"mode=4"}));
    const AtomRange held = held_range(world, hand_at(world, 0));
    const std::vector<Vec3> before = world.resource<AtomTable>().positions;
    const double charge = world.resource<AtomTable>().charge[held.first];
    world.write<AtomTable>().charge.write()[held.first] = std::numeric_limits<double>::quiet_NaN();

    CHECK_FALSE(step_world(world, HandPose{}, contact_at(world, 0).model).finite);
    CHECK_FALSE(contact_at(world, 0).model.force_newton.allFinite());
    CHECK(world.resource<AtomTable>().positions == before);

    world.write<AtomTable>().charge.write()[held.first] = charge;
    CHECK(step_world(world, HandPose{}, {}).finite);
    CHECK(contact_at(world, 0).model.force_newton.allFinite());
}
