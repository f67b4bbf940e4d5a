#include "session/run_headless.h"

#include "core/load_error.h"
#include "core/units.h"
#include "haptics/hand.h"
#include "haptics/plant.h"
#include "molecule/coincident_atoms.h"
#include "simulation/components.h"
#include "simulation/step.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>

namespace palpa {
namespace {

constexpr std::uint64_t ticks_between_progress = 100;

WorkspaceMap build_workspace(WorkspaceChoice choice) {
    switch (choice) {
        case WorkspaceChoice::Bubble:
            return BubbleMap{};
        case WorkspaceChoice::Drift:
            return DriftMap{};
        case WorkspaceChoice::Clutch:
            break;
    }
    return ClutchMap{};
}

}  // namespace

std::uint64_t count_ticks(const SceneDescription& scene) noexcept {
    return static_cast<std::uint64_t>(std::ceil(scene.seconds / servo_tick_s - 1e-9));
}

ServoSettings build_servo_settings(const SceneDescription& scene, const Simulation& simulation,
                                   const Vec3& half_workspace_m) {
    const CouplingDescription& c = scene.coupling;
    ServoSettings settings{simulation.laws.force,
                           {.clamp_newton = c.clamp_N, .is_full = simulation.is_guarded},
                           static_cast<int>(scene.device.servo_delay_ticks)};
    settings.safety.starts_engaged = c.engage == Engage::AtOnce;
    // Friction is lost twice on turning round, and the rest has to show (haptics/safety.h).
    settings.safety.frozen_newton = 2 + 2 * scene.device.friction_N;
    if (!simulation.is_guarded) return settings;
    GuardedSettings& guarded = settings.guarded.emplace();
    guarded.force_law = simulation.laws.force;
    guarded.displacement_law = simulation.laws.displacement;
    guarded.gain_shape =
        c.gain_shape == GainShapeChoice::Tensor ? GainShape::Tensor : GainShape::Scalar;
    guarded.workspace = build_workspace(c.workspace);
    guarded.half_workspace_m = half_workspace_m;
    guarded.damping_N_s_per_m =
        guarded_damping(c.damping_N_s_per_m, scene.device.inertia_kg, settings.delay_ticks);
    guarded.cap_N_per_m = guarded_cap(scene.device.viscosity_N_s_per_m, guarded.damping_N_s_per_m,
                                      settings.delay_ticks);
    // Where the scene says what must be felt, no tick feels more than the cap. Of 60 loops in space
    // with 50 to 400 pN none outruns its limits with this A_d, one does by 12.5 mJ with half of it.
    if (c.feel_pN) {
        guarded.cap_N_per_m /= most_of_cap;
        guarded.least_A_d_per_newton = 0.2e9;
    }
    guarded.stop_newton = c.stop_nN * 1e-9;
    guarded.late_s = guarded_lateness(guarded.cap_N_per_m, guarded.damping_N_s_per_m,
                                      scene.device.inertia_kg, settings.delay_ticks);
    return settings;
}

ServoSettings build_servo_settings(const SceneDescription& scene, const Simulation& simulation,
                                   const DeviceSpec& device) {
    ServoSettings settings = build_servo_settings(scene, simulation, device.half_workspace_m);
    if (!device.is_real) return settings;
    settings.safety.is_full = true;
    settings.safety.starts_engaged = false;
    limit_to(device, settings.safety);
    return settings;
}

void check_period(const DeviceSpec& device, double period_s) {
    if (bears_period(device, period_s)) return;
    throw LoadError({"run.period_ms"},
                    fmt::format("is {:.6g} ms, and {} would play a force that is as old; expected "
                                "at most {:.6g} ms with a device that has motors",
                                1e3 * period_s, device.name, 1e3 * longest_real_period_s));
}

double gain_where(const ServoSettings& servo, const Simulation& simulation,
                  const Vec3& force_newton, const Mat3& stiffness) noexcept {
    if (servo.guarded) return guarded_gain(*servo.guarded, force_newton, stiffness).A_d;
    return displacement_gain(simulation.laws.displacement, force_newton.norm());
}

double gain_where(const ServoSettings& servo, const Simulation& simulation,
                  const LineForce& line) noexcept {
    Mat3 stiffness = Mat3::Zero();
    stiffness(0, 0) = line.stiffness * units::newton_per_metre_per_kcal_per_mol_angstrom2;
    return gain_where(servo, simulation,
                      Vec3(line.force * units::newton_per_kcal_per_mol_angstrom, 0, 0), stiffness);
}

FeltStiffness stiffest_place(const SceneDescription& scene, const Simulation& simulation,
                             const StageFunction& on_stage) {
    const Grab& grab = *simulation.world.find<Grab>(simulation.hand);
    const Guide& guide = *simulation.world.find<Guide>(grab.molecule);
    const ServoSettings servo = build_servo_settings(scene, simulation);
    FeltStiffness stiffest;
    if (simulation.flexible && simulation.flexible->state.tether) {
        const double k = simulation.flexible->state.tether->k *
                         units::newton_per_metre_per_kcal_per_mol_angstrom2;
        const double A_d = gain_where(servo, simulation, Vec3::Zero(), k * Mat3::Identity());
        return {force_gain(simulation.laws.force, 0) * k / A_d, grabbed_distance(simulation)};
    }
    // False where the hand does not go: further in than its peak.
    const auto look_at = [&](double distance) {
        const FieldSum field = field_on_grabbed_at(simulation, distance);
        const Vec3 force = guide.projector * field.force * units::newton_per_kcal_per_mol_angstrom;
        const double F_m = force.norm();
        const bool pulls_outward = guide.freedom == 1 && force.x() < 0;
        if (F_m > scene.hand.peak_nN * 1e-9 && !pulls_outward) return false;
        const Mat3 stiffness = guide.projector * field.stiffness * guide.projector *
                               units::newton_per_metre_per_kcal_per_mol_angstrom2;
        const double A_d = gain_where(servo, simulation, force, stiffness);
        const double K = largest_felt(simulation.laws.force, force, stiffness) / A_d;
        if (K > stiffest.newton_per_metre) stiffest = {K, distance};
        return true;
    };
    if (guide.freedom == 1) {
        for (double distance = 2; distance < 12; distance += 0.002) look_at(distance);
        // Eq. 3 makes the rest place the stiffest, in a notch narrower than the scan.
        if (const auto rest = equilibrium_distance(simulation)) look_at(*rest);
        return stiffest;
    }
    // In space from the start both ways; outward all gets soft soon.
    const double start = grabbed_distance(simulation);
    for (double in = 0; in < 60 && look_at(start - in); in += 0.05) {
        if (on_stage) on_stage(fmt::format("looking for the stiffest place: {:.1f} Å in", in), {});
    }
    for (double out = 0.05; out < 2 && look_at(start + out);) out += 0.05;
    return stiffest;
}

double calm_stiffness(const SceneDescription& scene, const std::optional<HandModel>& hand,
                      double period_s) {
    DeviceDynamics device{scene.device.inertia_kg, scene.device.viscosity_N_s_per_m};
    if (scene.coupling.mode == CouplingMode::Guarded) {
        device.viscosity_N_s_per_m +=
            guarded_damping(scene.coupling.damping_N_s_per_m, device.inertia_kg,
                            static_cast<int>(scene.device.servo_delay_ticks));
        period_s = servo_tick_s;
    }
    return critical_stiffness(build_plant(device, hand), period_s,
                              static_cast<double>(scene.device.servo_delay_ticks) * servo_tick_s);
}

namespace {

// The least change of a force that a hand notices.
constexpr double noticed_newton = 0.05;

// By how much the force that guarded coupling sends changes at once where the position sensor goes
// on by one step: by the stiffest spring that it lets through, and by its damping of the velocity
// that this looks like. Of 360 handles that nobody holds, of all steps, dampings, delays, masses
// and viscosities, none below 0.05 N had a ripple above 0.02 N or gained 1 mJ, and most above 0.1 N
// did.
double encoder_jump(const GuardedSettings& guarded, double step_m) noexcept {
    const double m_per_s = filtered_velocity(Vec3::Zero(), Vec3(step_m, 0, 0)).x();
    return guarded.cap_N_per_m * step_m + guarded.damping_N_s_per_m * m_per_s;
}

void warn_of_resolution(const SceneDescription& scene, const Simulation& simulation,
                        std::vector<std::string>& warnings) {
    const ServoSettings servo = build_servo_settings(scene, simulation);
    if (!servo.guarded) return;
    const double step_mm = scene.device.encoder_step_mm;
    const double jump = encoder_jump(*servo.guarded, 1e-3 * step_mm);
    if (jump > noticed_newton) {
        warnings.push_back(fmt::format(
            "this device vibrates or gains energy unless friction holds it: a step of its position "
            "sensor of {:.3g} mm changes the force by {:.2g} N at once (at {:.3g} N/m and {:.3g} N "
            "s/m); expected at most {} N, so steps of {:.2g} mm or less, or less damping "
            "(device.encoder_step_mm, coupling.damping_N_s_per_m)",
            step_mm, jump, servo.guarded->cap_N_per_m, servo.guarded->damping_N_s_per_m,
            noticed_newton, step_mm * noticed_newton / jump));
    }
    // What sums of forces in single precision leave of some nanonewtons.
    constexpr double finest_newton = 2e-15;
    const double slope = force_gain(servo.guarded->force_law, 0);
    if (slope * finest_newton > noticed_newton) {
        warnings.push_back(fmt::format(
            "this force law plays rounding errors: at rest its gain is {:.2g}, so that forces of "
            "{:.2g} N are felt as {:.2g} N; expected a gain of at most {:.2g}",
            slope, finest_newton, std::min(slope * finest_newton, scene.coupling.clamp_N),
            noticed_newton / finest_newton));
    }
}

}  // namespace

std::vector<std::string> list_warnings(const SceneDescription& scene, const Simulation& simulation,
                                       const HandScript& script, const StageFunction& on_stage) {
    std::vector<std::string> warnings;
    const FeltStiffness stiffest = stiffest_place(scene, simulation, on_stage);
    const std::optional<HandModel> hand = hand_model(static_cast<Grip>(scene.hand.grip));
    const double limit = calm_stiffness(scene, hand, simulation.period_s);
    if (stiffest.newton_per_metre > limit) {
        warnings.push_back(
            fmt::format("this setting vibrates unless friction holds it: at {:.2f} Å the hand "
                        "feels {:.3g} N/m, "
                        "and this hand on this device is calm up to {:.3g} N/m at T_s = {} ms",
                        stiffest.angstrom, stiffest.newton_per_metre, limit, scene.period_ms));
    }
    if (script.release_s) {
        const double relaxed_limit = calm_stiffness(scene, relaxed(hand), simulation.period_s);
        if (stiffest.newton_per_metre > relaxed_limit && stiffest.newton_per_metre <= limit) {
            warnings.push_back(fmt::format(
                "once the hand lets go this setting vibrates unless friction holds it: the relaxed "
                "hand is calm up to {:.3g} N/m at T_s = {} ms, and feels up to {:.3g} N/m",
                relaxed_limit, scene.period_ms, stiffest.newton_per_metre));
        }
    }
    warn_of_resolution(scene, simulation, warnings);
    if (const auto closest = describe_coincident_atoms(
            simulation.atoms.names, simulation.atoms.positions, nearest_single_precision)) {
        warnings.push_back(fmt::format("atoms are on each other at the start: {}", *closest));
    }
    if (simulation.flexible && simulation.flexible->relaxed.end != RelaxEnd::Converged) {
        const JointRelaxReport& relaxed = simulation.flexible->relaxed;
        warnings.push_back(fmt::format(
            "not at rest at the start: an rms force of {:.3g} kcal/mol per radian and Å is left "
            "after {} steps (statics.relax_steps, statics.rest_kcal_per_mol; palpa relax)",
            relaxed.rms_force, relaxed.steps));
    }
    if (simulation.is_guarded && scene.hand.peak_nN > scene.coupling.stop_nN) {
        warnings.push_back(
            fmt::format("the hand is to feel {:.6g} nN (hand.peak_nN), and the molecule is held "
                        "back from {:.6g} "
                        "nN on (coupling.stop_nN)",
                        scene.hand.peak_nN, scene.coupling.stop_nN));
    }
    const double last_move = script.path.empty() ? 0 : script.path.back().time_s;
    if (last_move > scene.seconds) {
        warnings.push_back(
            fmt::format("the stroke takes {:.6g} s, the run only {:.6g} s (run.seconds)", last_move,
                        scene.seconds));
    }
    return warnings;
}

void warn_of_outcome(Summary& summary) {
    if (summary.safety_share > 0) {
        summary.warnings.push_back(fmt::format("for {:.1f} % of the time: {}",
                                               100 * summary.safety_share, words(summary.gravest)));
    }
    if (summary.went_through) {
        summary.warnings.emplace_back("the hand pushed the molecule through the other one");
    }
    if (summary.stopped) {
        summary.warnings.emplace_back("a force was not finite: the device was stopped");
    }
    if (summary.steps_not_finite > 0) {
        summary.warnings.push_back(fmt::format("{} of {} steps were not finite and moved nothing",
                                               summary.steps_not_finite, summary.steps));
    }
    if (summary.sums_in_double > 0) {
        summary.warnings.push_back(fmt::format(
            "{} of {} sums of forces were in double and took longer: atoms were within {} Å of "
            "each other, or {} Å away",
            summary.sums_in_double, summary.sums, nearest_single_precision,
            farthest_single_precision));
    }
}

// What was active, step by step.
class ActivityLog {
public:
    void add(const SettleReport& settled, double took_us, const std::optional<double>& budget_us) {
        steps_ += 1;
        sum_.active += static_cast<double>(settled.active);
        if (!budget_us || took_us <= *budget_us) within_ += 1;
        if (!settled.is_chosen) return;
        ++sum_.choices;
        if (settled.total > 0) sum_.neglected_share += settled.neglected / settled.total;
    }

    Activity activity() const {
        Activity result = sum_;
        if (steps_ > 0) result.active /= steps_;
        if (result.choices > 0) result.neglected_share /= static_cast<double>(result.choices);
        result.within_budget = steps_ > 0 ? within_ / steps_ : 1;
        return result;
    }

private:
    Activity sum_;
    double steps_ = 0, within_ = 0;
};

Summary run_headless(const SceneDescription& scene, Simulation& simulation, Device& device,
                     const std::vector<std::string>& warnings, Recording* recording,
                     const ProgressFunction& progress, const FrameClock& frames,
                     const TickFunction& watch, const EndFunction& is_over) {
    const std::uint64_t ticks = count_ticks(scene);
    const auto ticks_per_step =
        static_cast<std::uint64_t>(std::lround(simulation.period_s / servo_tick_s));
    Statistics statistics(servo_tick_s);
    ActivityLog activity;
    check_period(device.spec(), simulation.period_s);
    const ServoSettings servo = build_servo_settings(scene, simulation, device.spec());
    FeelLog feel(scene, servo);
    std::optional<JourneyLog> journey;
    if (simulation.flexible) journey.emplace(simulation);

    const auto step = [&](const HandPose& hand, const TouchModel& felt) {
        const auto begin = std::chrono::steady_clock::now();
        const StepReport report = step_simulation(simulation, hand, felt);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        statistics.add_step(took.count(), report.finite);
        if (journey) journey->add(simulation);
        if (!report.settled) {
            feel.add_answer(report.touch);
            return simulation.touch;
        }
        feel.add_step(*report.settled);
        activity.add(*report.settled, 1e6 * took.count(), scene.statics.budget_us);
        return simulation.touch;
    };
    std::uint64_t done = 0, drawn = 0;
    const auto on_tick = [&](const ServoTick& tick) {
        const double now_s = static_cast<double>(done) * servo_tick_s;
        if (frames.draw && now_s >= static_cast<double>(drawn) / frames.per_second - 1e-9) {
            frames.draw();
            ++drawn;
        }
        statistics.add(tick);
        feel.add(tick);
        if (recording) recording->add(tick);
        if (watch) watch(tick);
        ++done;
        if (progress && done % ticks_between_progress == 0 && done < ticks) {
            progress(static_cast<double>(done) / static_cast<double>(ticks));
        }
    };
    run_lockstep({ticks, ticks_per_step}, servo, device, simulation.touch, step, on_tick, is_over);

    if (progress) progress(1);
    Summary summary = statistics.summary();
    summary.device = device.spec().name;
    summary.warnings = warnings;
    summary.feel = feel.feel(summary.step_median_us);
    if (journey && simulation.flexible) {
        // Where molecules make room for each other, one may well be on either side of another.
        constexpr double on_top = 1;  // Å
        summary.journey = journey->journey();
        summary.went_through = summary.journey->closest < on_top;
        const Flexible& flexible = *simulation.flexible;
        const ForceMemory& memory =
            flexible.adaptive ? flexible.adaptive->statics.memory : flexible.statics.memory;
        if (flexible.adaptive) summary.activity = activity.activity();
        summary.sums = memory.evaluations;
        summary.sums_in_double = memory.fast_pairs.in_double;
    }
    warn_of_outcome(summary);
    if (recording) recording->finish(summary);
    return summary;
}

}  // namespace palpa
