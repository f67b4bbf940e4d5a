// A handle that turns the molecule as well as moving it.
#include "core/units.h"
#include "scene/read_scene.h"
#include "session/continuous_law.h"
#include "session/lockstep.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "simulation/step.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace palpa;

namespace {

SceneDescription space_scene(const std::vector<std::string>& settings) {
    return read_scene(test::in_project("scenes/water/space.toml"), settings);
}

// A handle that is where it is told at every tick, whatever pushes it.
class Rail final : public Device {
public:
    using Way = std::function<DeviceReading(double time_s)>;

    explicit Rail(Way way) : way_(std::move(way)) { spec_.half_workspace_m.setConstant(0.5); }
    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override {
        DeviceReading reading = way_(time_s_);
        reading.time_s = time_s_;
        reading.valid = true;
        return reading;
    }
    void write(const Vec3& /*force_newton*/) noexcept override { time_s_ += servo_tick_s; }

private:
    Way way_;
    DeviceSpec spec_;
    double time_s_ = 0;
};

struct Run {
    Simulation simulation;
    std::vector<ServoTick> ticks;
};

Run run(const SceneDescription& scene, const Rail::Way& way) {
    Run result{load_simulation(scene), {}};
    Rail rail(way);
    Simulation& simulation = result.simulation;
    run_lockstep(
        {static_cast<std::uint64_t>(scene.seconds * servo_rate_hz),
         static_cast<std::uint64_t>(scene.period_ms)},
        build_servo_settings(scene, simulation), rail, simulation.touch,
        [&](const HandPose& hand, const TouchModel& felt) {
            (void)step_simulation(simulation, hand, felt);
            return simulation.touch;
        },
        [&](const ServoTick& tick) { result.ticks.push_back(tick); });
    return result;
}

// Half a turn about y within a second, smoothly.
Quat half_turn(double time_s) {
    return turn_of(Vec3(0, std::numbers::pi * minimum_jerk(time_s), 0));
}

}  // namespace

TEST_CASE("the molecule turns as the handle does, in the servo and in the simulation",
          "[session][coupling]") {
    const std::string mode = GENERATE("guarded", "2");
    const SceneDescription scene =
        space_scene({"mode=" + mode, "run.seconds=1.2", "start_offset_angstrom=[6, 0, 0]"});
    const Quat expected = half_turn(1);

    const Run turned =
        run(scene, [](double t) { return DeviceReading{0, Vec3::Zero(), 0, true, half_turn(t)}; });

    const TouchModel& last = turned.ticks.back().touch;
    CHECK(last.molecule.orientation.angularDistance(expected) < 1e-6);
    // The hydrogens have gone to the other side of the oxygen, which stays.
    const AtomTable& atoms = turned.simulation.atoms;
    const Simulation before = load_simulation(scene);
    const Vec3 hydrogen = atoms.positions[1] - atoms.positions[0];
    const Vec3 was = before.atoms.positions[1] - before.atoms.positions[0];
    CHECK((hydrogen - expected * was).norm() < 1e-6);
    CHECK((atoms.positions[0] - before.atoms.positions[0]).norm() < 1e-6);
}

TEST_CASE("a turn with the clutch pressed does not reach the molecule", "[session][coupling]") {
    const SceneDescription scene =
        space_scene({"run.seconds=1.2", "start_offset_angstrom=[6, 0, 0]"});

    const Run turned = run(scene, [](double t) {
        return DeviceReading{0, Vec3::Zero(), static_cast<std::uint32_t>(Button::Clutch), true,
                             half_turn(t)};
    });

    CHECK(turned.ticks.back().touch.molecule.orientation.angularDistance(Quat::Identity()) < 1e-12);
}

TEST_CASE("what the servo finds of a turned molecule is what the simulation finds",
          "[session][coupling]") {
    // So long a period that the whole turn is the servo's own.
    const SceneDescription scene = space_scene({"run.seconds=1.2", "period_ms=5000"});
    const Run turned =
        run(scene, [](double t) { return DeviceReading{0, Vec3::Zero(), 0, true, half_turn(t)}; });
    const TouchModel& servo = turned.ticks.back().touch;

    Simulation there = load_simulation(scene);
    place_grabbed(there, servo.molecule);
    const FieldSum field = field_on_grabbed(there);

    const Vec3 force = units::newton_per_kcal_per_mol_angstrom * field.force;
    REQUIRE(force.norm() > 20e-12);
    CHECK((servo.force_newton - force).norm() < 1e-4 * force.norm());
    const Vec3 centre = centre_of_mass(there.atoms, {0, 3});
    const Vec3 torque = units::joule_per_kcal_per_mol * field.torque_about(centre);
    CHECK((servo.torque_newton_metre - torque).norm() < 1e-4 * torque.norm());
}

TEST_CASE("a turn that would push an atom beyond the stop is not followed", "[session][coupling]") {
    // Bound, and in one tick's turn the hydrogens would be in the other water.
    const SceneDescription scene =
        space_scene({"run.seconds=3", "start_offset_angstrom=[-0.3, 0, 0]", "coupling.stop_nN=3"});

    const Run turned = run(scene, [](double t) {
        return DeviceReading{0, Vec3(-0.02 * t, 0, 0), 0, true, half_turn(t / 3)};
    });

    for (const ServoTick& tick : turned.ticks) CHECK(tick.touch.force_newton.norm() < 3.01e-9);
}

TEST_CASE("the continuous law is the static law along a line", "[session][coupling]") {
    const SceneDescription scene =
        read_scene(test::in_project("scenes/water"), std::vector<std::string>{});
    const Simulation simulation = load_simulation(scene);
    const ServoSettings servo = build_servo_settings(scene, simulation);
    ContinuousLaw law(*servo.guarded, load_simulation(scene));
    const double from = law.pose().place_angstrom.x();

    for (int i = 0; i < 1000; ++i) law.follow({Vec3(-0.09e-3, 0, 0)});
    const double inside = law.pose().place_angstrom.x(), way_in_J = law.work_joule();
    for (int i = 0; i < 1000; ++i) law.follow({Vec3(0.09e-3, 0, 0)});

    REQUIRE(inside < 3);
    CHECK(law.pose().place_angstrom.x() == Approx(from).margin(1e-4));
    CHECK(std::abs(law.work_joule()) < 1e-3 * std::abs(way_in_J));
    // The integral of f(F) A_d over the way.
    double work = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const LineForce line =
            force_along_line_at(simulation, from + (i + 0.5) / steps * (inside - from));
        work += hand_force(simulation.laws.force,
                           line.force * units::newton_per_kcal_per_mol_angstrom) *
                gain_where(servo, simulation, line) * (inside - from) / steps *
                units::metre_per_angstrom;
    }
    CHECK(way_in_J == Approx(work).epsilon(1e-3));
}

TEST_CASE("the continuous law turns what turns with the handle, and nothing else",
          "[session][coupling]") {
    const bool turns = GENERATE(true, false);
    const SceneDescription scene = space_scene(
        {turns ? "molecules.moved.motion=with-handle" : "molecules.moved.motion=translate",
         "start_offset_angstrom=[6, 0, 0]"});
    const Simulation simulation = load_simulation(scene);
    const ServoSettings servo = build_servo_settings(scene, simulation);
    ContinuousLaw law(*servo.guarded, load_simulation(scene));
    const MoleculePose start = law.pose();
    const Quat turned = turn_of(Vec3(0.3, -0.2, 0.1));

    law.follow({Vec3(0, 0.01, 0), turned});

    CHECK(law.pose().orientation.angularDistance(turns ? Quat(turned * start.orientation)
                                                       : start.orientation) < 1e-9);
    CHECK((law.pose().place_angstrom - start.place_angstrom).norm() > 0.01);
}
