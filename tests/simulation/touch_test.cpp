// How much of what a frozen environment foretold came true. The environment is made to follow the
// molecule by a known share of its move, so what comes is the rest.
#include "simulation/touch.h"

#include "core/units.h"
#include "simulation/probe.h"
#include "tests/support/water_scene.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

using namespace palpa;

namespace {

constexpr double dimer_distance = 2.6, dimer_step = 0.002;  // Å; the force is steep there

// The guarded dimer, with a touch of where it stands.
Simulation dimer() {
    Simulation simulation = load_simulation(test::water_scene({"mode=guarded"}));
    move_grabbed(simulation, dimer_distance);
    simulation.touch = build_touch(simulation, {});
    return simulation;
}

// The molecule goes in by a step, and everything else by `followed` of that.
void step_in(Simulation& simulation, double followed) {
    const std::size_t own = grabbed_points(simulation).positions.size();
    const Vec3 place = grabbed_place(simulation);
    for (std::size_t i = own; i < simulation.atoms.positions.size(); ++i)
        simulation.atoms.positions[i].x() -= followed * dimer_step;
    move_grabbed(simulation, grabbed_distance(simulation) - dimer_step);
    REQUIRE((grabbed_place(simulation) - place).norm() == Approx(dimer_step));
    update_touch({}, simulation);
}

double newton_at(const Simulation& simulation, double at) {
    return force_along_line_at(simulation, at).force * units::newton_per_kcal_per_mol_angstrom;
}

}  // namespace

TEST_CASE("half of the way to what came true is gone in each step", "[simulation][touch]") {
    const double followed = GENERATE(0.0, 0.3, 0.8, 1.0);
    Simulation simulation = dimer();

    // 1/2 (1 + share), then halfway on again. Forces bend by less than a hundredth on the way.
    const double share = 1 - followed;
    step_in(simulation, followed);
    CHECK(simulation.touch.model.confirmed == Approx(0.5 + 0.5 * share).margin(0.01));
    step_in(simulation, followed);
    CHECK(simulation.touch.model.confirmed == Approx(0.25 + 0.75 * share).margin(0.01));
    // Whoever sees that the environment moves does not trust its field far away.
    CHECK(simulation.touch.model.gives_way == (followed > 0));
}

TEST_CASE("more than was foretold counts as all, and the opposite as nothing",
          "[simulation][touch]") {
    Simulation simulation = dimer();
    step_in(simulation, -2);  // the environment comes towards the molecule
    CHECK(simulation.touch.model.confirmed == 1);

    simulation = dimer();
    step_in(simulation, 3);  // it flees, so the force falls instead of rising
    CHECK(simulation.touch.model.confirmed == Approx(0.5));
}

TEST_CASE("what was foretold less than 2 pN of confirms and denies nothing",
          "[simulation][touch]") {
    Simulation simulation = load_simulation(test::water_scene({"mode=guarded"}));
    const double far = GENERATE(4.0, 12.0);
    move_grabbed(simulation, far);
    simulation.touch = build_touch(simulation, {});
    simulation.touch.model.confirmed = 0.6;
    const bool is_foretold =
        std::abs(newton_at(simulation, far - 0.2) - newton_at(simulation, far)) > 2e-12;
    REQUIRE(is_foretold == (far == 4));

    move_grabbed(simulation, far - 0.2);
    update_touch({}, simulation);

    CHECK(simulation.touch.model.confirmed == Approx(is_foretold ? 0.8 : 0.6).margin(1e-3));
}

TEST_CASE("a touch without atoms keeps what was confirmed before", "[simulation][touch]") {
    Simulation simulation = dimer();
    simulation.touch.model.confirmed = 0.6;
    simulation.touch.model.confirmed_torque = 0.7;
    simulation.touch.field.has_atoms = false;

    step_in(simulation, 1);

    CHECK(simulation.touch.model.confirmed == 0.6);
    CHECK(simulation.touch.model.confirmed_torque == 0.7);
}

TEST_CASE("torques are confirmed by themselves", "[simulation][touch]") {
    const double followed = GENERATE(0.0, 0.4, 1.0);
    constexpr double turn = 0.05;  // rad
    Simulation simulation = dimer();
    const Vec3 pivot = grabbed_place(simulation);
    const std::size_t own = grabbed_points(simulation).positions.size();
    const auto about = [&](double angle) {
        return Eigen::AngleAxisd(angle, Vec3(0.3, 1, -0.5).normalized());
    };

    for (std::size_t i = own; i < simulation.atoms.positions.size(); ++i) {
        Vec3& place = simulation.atoms.positions[i];
        place = pivot + about(followed * turn) * (place - pivot);
    }
    for (std::size_t i = 0; i < own; ++i) {
        Vec3& place = simulation.atoms.positions[i];
        place = pivot + about(turn) * (place - pivot);
    }
    update_touch({}, simulation);

    CHECK(simulation.touch.model.confirmed_torque == Approx(1 - 0.5 * followed).margin(0.03));
}
