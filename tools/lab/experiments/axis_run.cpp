#include "tools/lab/experiments/axis_run.h"

#include "core/units.h"
#include "devices/emulated_omni.h"
#include "experiments/emulated_hand.h"
#include "haptics/gains.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "session/lockstep.h"
#include "session/ripple.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace palpa {
namespace {

constexpr std::size_t ripple_ticks = 4000;

// What the law gives at rest, by the molecule's place.
class Watch {
public:
    Watch(const World& world, const ServoSettings& servo) : world_(world), servo_(servo) {
        played_.closest_angstrom = std::numeric_limits<double>::infinity();
    }

    void add(const ServoTick& tick) {
        const double distance = tick.contact.molecule.place_angstrom.x();
        const double F_m =
            force_along_line_at(world_, distance).force * units::newton_per_kcal_per_mol_angstrom;
        // What is sent left the coupling some ticks ago, with the damping of then.
        const auto size = under_way_.size();
        under_way_[tick_ % size] = tick.damping_newton.x();
        const auto delay = static_cast<std::size_t>(servo_.delay_ticks);
        const double undamped = tick.sent_newton.x() - under_way_[(tick_ + size - delay) % size];
        ++tick_;
        const double error =
            undamped - hand_force(coupling_of(world_, hand_at(world_, 0)).laws.force, F_m);
        squares_ += error * error;
        played_.readings.push_back(read_tick(tick));
        played_.readings.back().hand_N = tick.sent_newton.x();
        sent_.push_back(tick.sent_newton.x());
        played_.closest_angstrom = std::min(played_.closest_angstrom, distance);
        played_.last_angstrom = distance;
        played_.largest_nN = std::max(played_.largest_nN, F_m * 1e9);
        played_.energy_J = tick.hand_energy_J;
        played_.attraction_N = std::max(played_.attraction_N, -undamped);
        if (std::abs(tick.sent_newton.x()) >= servo_.safety.clamp_newton - 1e-9) ++played_.at_clamp;
        played_.stage = std::max(played_.stage, tick.stage);
    }

    AxisRun played() const {
        AxisRun result = played_;
        result.error_N = std::sqrt(squares_ / static_cast<double>(sent_.size()));
        const std::size_t last = std::min(sent_.size(), ripple_ticks);
        const std::span<const double> end = std::span(sent_).last(last);
        const Ripple ripple = measure_ripple(end, servo_tick_s).value_or(Ripple{});
        result.ripple_N = ripple.rms;
        result.ripple_hertz = ripple.hertz;
        return result;
    }

private:
    const World& world_;
    const ServoSettings& servo_;
    AxisRun played_;
    std::vector<double> sent_;
    std::array<double, max_servo_delay_ticks + 1> under_way_{};
    std::size_t tick_ = 0;
    double squares_ = 0;
};

}  // namespace

AxisRun play_axis(const AxisCase& c) {
    const SceneDescription scene = read_scene(c.scene, c.settings);
    World world = load_world(scene);
    EmulatedOmniSettings device = build_emulated_omni(scene, world);
    if (c.hand) device.hand = c.hand;
    EmulatedOmni omni(device);
    ServoSettings servo = build_servo_settings(scene, world, 0, omni.spec());
    if (c.cools) servo.safety.thermal_limit_newton = std::numeric_limits<double>::infinity();
    Watch watch(world, servo);
    const auto step = [&](const HandPose& hand, const ContactModel& felt) {
        (void)step_world(world, hand, felt);
        return contact_at(world, 0);
    };
    const auto on_tick = [&](const ServoTick& tick) { watch.add(tick); };
    const LockstepSettings settings{
        static_cast<std::uint64_t>(std::lround(scene.seconds * servo_rate_hz)),
        static_cast<std::uint64_t>(std::lround(world.resource<Clock>().period_s * servo_rate_hz))};
    run_lockstep(settings, servo, omni, contact_at(world, 0), step, on_tick);
    return watch.played();
}

}  // namespace palpa
