#include "session/run_headless.h"

#include "core/units.h"
#include "haptics/hand.h"
#include "session/lockstep.h"
#include "simulation/components.h"
#include "simulation/probe.h"
#include "simulation/step.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>

namespace palpa {
namespace {

constexpr double tick_s = 1e-3;
constexpr std::uint64_t ticks_between_progress = 100;

}  // namespace

ServoSettings build_servo_settings(const SceneDescription& scene, const Simulation& simulation) {
    return {simulation.laws.force, scene.coupling.clamp_N,
            static_cast<int>(scene.device.servo_delay_ticks)};
}

std::vector<std::string> find_warnings(const SceneDescription& scene,
                                       const Simulation& simulation) {
    double stiffest = 0, where = 0;
    for (double distance = 2; distance < 12; distance += 0.002) {
        const LineForce line = force_along_line_at(simulation, distance);
        const double F_m = line.force * units::newton_per_kcal_per_mol_angstrom;
        if (F_m > scene.hand.peak_nN * 1e-9) continue;  // further in than the hand goes
        const double K = hand_force_slope(simulation.laws.force, F_m) * line.stiffness *
                         units::newton_per_metre_per_kcal_per_mol_angstrom2 /
                         displacement_gain(simulation.laws.displacement, F_m);
        if (K > stiffest) {
            stiffest = K;
            where = distance;
        }
    }
    const std::optional<HandModel> hand = hand_model(static_cast<Grip>(scene.hand.grip));
    const double damping = scene.device.viscosity_N_s_per_m + (hand ? hand->damping_N_s_per_m : 0);
    const double limit = damping / (1.5 * simulation.period_s);
    if (stiffest <= limit) return {};
    return {
        fmt::format("this setting may vibrate: at {:.2f} Å the hand feels {:.0f} N/m, and {} "
                    "Ns/m of damping calm no more than B/(1.5 T_s) = {:.0f} N/m",
                    where, stiffest, damping, limit)};
}

Summary run_headless(const SceneDescription& scene, Simulation& simulation, Device& device,
                     Recording* recording, const ProgressFunction& progress) {
    const auto ticks = static_cast<std::uint64_t>(std::ceil(scene.seconds / tick_s - 1e-9));
    const auto ticks_per_step =
        static_cast<std::uint64_t>(std::lround(simulation.period_s / tick_s));
    Statistics statistics(tick_s, ticks);

    const auto step = [&](const HandPose& hand, const TouchModel& felt) {
        const auto begin = std::chrono::steady_clock::now();
        const StepReport report = step_simulation(simulation, hand, felt);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        statistics.add_step(took.count(), report.finite);
        return report.touch;
    };
    std::uint64_t done = 0;
    const auto on_tick = [&](const ServoTick& tick) {
        statistics.add(tick);
        if (recording) recording->add(tick);
        if (progress && ++done % ticks_between_progress == 0) {
            progress(static_cast<double>(done) / static_cast<double>(ticks));
        }
    };
    const std::vector<std::string> warnings = find_warnings(scene, simulation);
    run_lockstep({ticks, ticks_per_step}, build_servo_settings(scene, simulation), device,
                 build_touch_model(simulation, {}), step, on_tick);

    Summary summary = statistics.summary();
    summary.warnings = warnings;
    if (summary.stopped) {
        summary.warnings.emplace_back("a force was not finite: the device was stopped");
    }
    if (recording) recording->finish(summary);
    return summary;
}

}  // namespace palpa
