// Guarded coupling with a molecule that moves in space, knocked and pushed from every side.
#include "haptics/device.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/guarded_loop.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace palpa;
using namespace palpa::test;

namespace {

// The emulated Omni, its x turned into another direction.
class TurnedOmni final : public Device {
public:
    TurnedOmni(const GuardedCase& c, const Vec3& x)
        : omni_(guarded_omni(c)),
          turn_(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), x).toRotationMatrix()) {}

    const DeviceSpec& spec() const noexcept override { return omni_.spec(); }
    DeviceReading read() noexcept override {
        DeviceReading reading = omni_.read();
        reading.position_m = turn_ * reading.position_m;
        return reading;
    }
    void write(const Vec3& force_newton) noexcept override {
        omni_.write(turn_.transpose() * force_newton);
    }

private:
    EmulatedOmni omni_;
    Mat3 turn_;
};

struct InSpace {
    double ripple_N = 0;  // of the last 4 s, along the axis where it is most
    double off_angstrom = 0, largest_nN = 0, energy_J = 0;
    SafetyStage stage = SafetyStage::None;
};

InSpace run_in_space(const GuardedCase& c, const Vec3& x) {
    const SceneDescription scene =
        water_scene({"mode=guarded", "stroke=hold", "period_ms=" + std::to_string(c.period_ms),
                     "molecules.moved.motion=translate"});
    World world = load_world(scene);
    const Vec3 start = contact_at(world, 0).model.molecule.place_angstrom;
    TurnedOmni omni(c, x);
    InSpace result;
    std::array<std::vector<double>, 3> sent;
    const auto step = [&](const HandPose& hand, const ContactModel& felt) {
        (void)step_world(world, hand, felt);
        return contact_at(world, 0);
    };
    const auto on_tick = [&](const ServoTick& tick) {
        result.off_angstrom = (tick.contact.molecule.place_angstrom - start).norm();
        result.largest_nN = std::max(result.largest_nN, 1e9 * tick.contact.force_newton.norm());
        result.energy_J = tick.hand_energy_J;
        result.stage = std::max(result.stage, tick.stage);
        for (std::size_t axis = 0; axis < sent.size(); ++axis)
            sent[axis].push_back(tick.sent_newton(static_cast<Eigen::Index>(axis)));
    };
    ServoSettings servo = build_servo_settings(scene, world, 0);
    servo.safety.thermal_limit_newton = c.thermal_limit_newton;
    const auto ticks = static_cast<std::uint64_t>(c.seconds * servo_rate_hz);
    run_lockstep({ticks, c.period_ms}, servo, omni, contact_at(world, 0), step, on_tick);
    for (const std::vector<double>& axis : sent) {
        const std::span<const double> end(
            axis.end() - std::min<std::ptrdiff_t>(std::ssize(axis), 4000), axis.end());
        result.ripple_N = std::max(result.ripple_N, measure_ripple(end, servo_tick_s).value().rms);
    }
    return result;
}

// Along the axes, across, and nearly at the other water.
const std::array<Vec3, 10> directions{
    Vec3(1, 0, 0),  Vec3(-1, 0, 0), Vec3(0, 1, 0),   Vec3(0, -1, 0),   Vec3(0, 0, 1),
    Vec3(0, 0, -1), Vec3(1, 1, 1),  Vec3(-1, 1, -1), Vec3(-1, 0.2, 0), Vec3(-1, 0, 0.2)};

std::string words_of(const GuardedCase& c, const Vec3& x) {
    return fmt::format("{}, {} ms, friction {} N, along {} {} {}",
                       grip_names[static_cast<std::size_t>(c.grip)], c.period_ms, c.friction_newton,
                       x.x(), x.y(), x.z());
}

}  // namespace

TEST_CASE("guarded in space, a hand knocked from any side stays at rest without a ripple",
          "[session][coupling]") {
    for (const HandGrip grip : {HandGrip::None, HandGrip::Medium})
        for (const std::uint64_t period_ms : {14, 83})
            for (const double friction : {0.0, 0.26})
                for (const Vec3& x : directions) {
                    const GuardedCase c = held(grip, friction, period_ms);
                    INFO(words_of(c, x));

                    const InSpace result = run_in_space(c, x);

                    CHECK(result.ripple_N < 0.02);
                    CHECK(result.off_angstrom < 0.3);
                    CHECK(result.stage <= SafetyStage::Slewed);
                }
}

TEST_CASE("guarded in space, no push goes through the wall or gives the hand energy",
          "[session][coupling]") {
    for (const double stroke_s : {0.5, 2.0})
        for (const std::uint64_t period_ms : {1, 14, 83})
            for (const Vec3& x : directions) {
                GuardedCase c = stroke(HandGrip::Firm, 0, period_ms, stroke_s, -0.09, 0.5);
                // What slid behind the other water is pulled back with all force, for long.
                c.thermal_limit_newton = std::numeric_limits<double>::infinity();
                INFO(words_of(c, x) << ", " << stroke_s << " s");

                const InSpace result = run_in_space(c, x);

                // But for single precision.
                CHECK(result.largest_nN < 10.001);
                CHECK(result.energy_J <= 0.001);
                CHECK(result.stage <= SafetyStage::Clamped);
            }
}
