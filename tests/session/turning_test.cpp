// A handle that turns the molecule as well as moving it.
#include "core/units.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/lockstep.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/step.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <span>
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
    World world;
    std::vector<ServoTick> ticks;
};

Run run(const SceneDescription& scene, const Rail::Way& way) {
    Run result{load_world(scene), {}};
    Rail rail(way);
    World& world = result.world;
    run_lockstep(
        {static_cast<std::uint64_t>(scene.seconds * servo_rate_hz),
         static_cast<std::uint64_t>(scene.period_ms)},
        build_servo_settings(scene, world, 0), rail, contact_at(world, 0),
        [&](const HandPose& hand, const ContactModel& felt) {
            (void)step_world(world, hand, felt);
            return contact_at(world, 0);
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

    const ContactModel& last = turned.ticks.back().contact;
    CHECK(last.molecule.orientation.angularDistance(expected) < 1e-6);
    // The hydrogens have gone to the other side of the oxygen, which stays.
    const World before = load_world(scene);
    const std::span<const Vec3> is = held_points(turned.world, hand_at(turned.world, 0)).positions,
                                was = held_points(before, hand_at(before, 0)).positions;
    CHECK((is[1] - is[0] - expected * (was[1] - was[0])).norm() < 1e-6);
    CHECK((is[0] - was[0]).norm() < 1e-6);
}

TEST_CASE("a turn with the clutch pressed does not reach the molecule", "[session][coupling]") {
    const SceneDescription scene =
        space_scene({"run.seconds=1.2", "start_offset_angstrom=[6, 0, 0]"});

    const Run turned = run(scene, [](double t) {
        return DeviceReading{0, Vec3::Zero(), static_cast<std::uint32_t>(Button::Clutch), true,
                             half_turn(t)};
    });

    CHECK(turned.ticks.back().contact.molecule.orientation.angularDistance(Quat::Identity()) <
          1e-12);
}

TEST_CASE("what the servo finds of a turned molecule is what the simulation finds",
          "[session][coupling]") {
    // So long a period that the whole turn is the servo's own.
    const SceneDescription scene = space_scene({"run.seconds=1.2", "period_ms=5000"});
    const Run turned =
        run(scene, [](double t) { return DeviceReading{0, Vec3::Zero(), 0, true, half_turn(t)}; });
    const ContactModel& servo = turned.ticks.back().contact;

    World there = load_world(scene);
    place_grabbed(there, servo.molecule);
    const FieldSum field = field_on_grabbed(there);

    const Vec3 force = units::newton_per_kcal_per_mol_angstrom * field.force;
    REQUIRE(force.norm() > 20e-12);
    CHECK((servo.force_newton - force).norm() < 1e-4 * force.norm());
    const Vec3 centre =
        centre_of_mass(there.resource<AtomTable>(), held_range(there, hand_at(there, 0)));
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

    for (const ServoTick& tick : turned.ticks) CHECK(tick.contact.force_newton.norm() < 3.01e-9);
}
