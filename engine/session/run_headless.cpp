#include "session/run_headless.h"

#include "core/assertion.h"
#include "core/load_error.h"
#include "core/repeatable.h"
#include "core/units.h"
#include "haptics/hand.h"
#include "haptics/plant.h"
#include "loading/edit.h"
#include "molecule/coincident_atoms.h"
#include "session/edit_player.h"
#include "session/undo_history.h"
#include "simulation/components.h"
#include "simulation/grip_queries.h"
#include "simulation/playback.h"
#include "simulation/remote_engine.h"
#include "simulation/resources.h"
#include "simulation/select_in_world.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "simulation/systems/pull_by_clients.h"

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

DeviceSpec describe_emulated_device(const SceneDescription& scene, std::size_t slot) {
    return {.name = "emulated device of the scene",
            .viscosity_N_s_per_m = device_of(scene, slot).viscosity_N_s_per_m,
            .half_workspace_m = Vec3::Constant(0.1),
            .is_real = false};
}

ServoSettings build_servo_settings(const SceneDescription& scene, const World& world,
                                   std::size_t slot) {
    return build_servo_settings(scene, world, slot, describe_emulated_device(scene, slot));
}

ServoSettings build_servo_settings(const SceneDescription& scene, const World& world,
                                   std::size_t slot, const DeviceSpec& device) {
    const Coupling& coupling = coupling_of(world, hand_at(world, slot));
    const CouplingDescription& c = coupling.description;
    const DeviceDescription& own = device_of(scene, slot);
    ServoSettings settings{coupling.laws.force,
                           {.clamp_newton = c.clamp_N, .is_full = coupling.is_guarded},
                           static_cast<int>(own.servo_delay_ticks)};
    settings.safety.starts_engaged = c.engage == Engage::AtOnce;
    // Friction is lost twice on turning round, and the rest has to show (haptics/safety.h).
    settings.safety.frozen_newton = 2 + 2 * own.friction_N;
    settings.half_workspace_m = device.half_workspace_m;
    if (device.is_real) {
        settings.safety.is_full = true;
        settings.safety.starts_engaged = false;
        limit_to(device, settings.safety);
    }
    if (!coupling.is_guarded) return settings;
    GuardedSettings& guarded = settings.guarded.emplace();
    guarded.force_law = coupling.laws.force;
    guarded.displacement_law = coupling.laws.displacement;
    guarded.gain_shape = c.gain_shape;
    guarded.workspace = build_workspace(c.workspace);
    guarded.half_workspace_m = device.half_workspace_m;
    guarded.damping_N_s_per_m =
        guarded_damping(c.damping_N_s_per_m, own.inertia_kg, settings.delay_ticks);
    // Take the scene's viscosity for a device that does not state its own.
    DeviceSpec known = device;
    if (known.viscosity_N_s_per_m == 0) known.viscosity_N_s_per_m = own.viscosity_N_s_per_m;
    guarded.device_cap_N_per_m = guarded.cap_N_per_m =
        guarded_cap(known, guarded.damping_N_s_per_m, settings.delay_ticks);
    // Where the scene says what must be felt, no tick feels more than the cap. Of 60 closed paths
    // in space with 50 to 400 pN none outruns its limits with this A_d, one does by 12.5 mJ with
    // half of it.
    if (c.feel_pN) {
        guarded.cap_N_per_m /= most_of_cap;
        guarded.least_A_d_per_newton = 0.2e9;
    }
    guarded.stop_newton = c.stop_nN * 1e-9;
    guarded.horizon_s = guarded_horizon(guarded.cap_N_per_m, guarded.damping_N_s_per_m,
                                        own.inertia_kg, settings.delay_ticks);
    return settings;
}

void check_period(const DeviceSpec& device, double period_s) {
    if (supports_period(device, period_s)) return;
    throw LoadError({"run.period_ms"},
                    fmt::format("is {:.6g} ms, so {} would render a force of this age; expected at "
                                "most {:.6g} ms with a device that has motors",
                                1e3 * period_s, device.name, 1e3 * longest_real_period_s));
}

double gain_where(const ServoSettings& servo, const CouplingLaws& laws, const Vec3& force_newton,
                  const Mat3& stiffness) noexcept {
    if (servo.guarded) return guarded_gain(*servo.guarded, force_newton, stiffness).A_d;
    return displacement_gain(laws.displacement, force_newton.norm());
}

double gain_where(const ServoSettings& servo, const CouplingLaws& laws,
                  const LineForce& line) noexcept {
    Mat3 stiffness = Mat3::Zero();
    stiffness(0, 0) = line.stiffness * units::newton_per_metre_per_kcal_per_mol_angstrom2;
    return gain_where(servo, laws, Vec3(line.force * units::newton_per_kcal_per_mol_angstrom, 0, 0),
                      stiffness);
}

FeltStiffness stiffest_place(const SceneDescription& scene, const World& world,
                             const StageFunction& on_stage, std::size_t slot) {
    const Entity hand = find_hands(world).at(slot);
    const double peak_nN = list_hands(scene).at(slot).hand.peak_nN;
    if (!world.find<Grip>(hand)) return {};
    const Grip& grip = grip_of(world, hand);
    const ServoSettings servo = build_servo_settings(scene, world, slot);
    const CouplingLaws& laws = coupling_of(world, hand).laws;
    FeltStiffness stiffest;
    if (const ModelSpring* const spring = spring_of(world, hand)) {
        const double k = spring->k * units::newton_per_metre_per_kcal_per_mol_angstrom2;
        const double A_d = gain_where(servo, laws, Vec3::Zero(), k * Mat3::Identity());
        return {force_gain(laws.force, 0) * k / A_d, grabbed_distance(world, hand)};
    }
    // False where the hand does not go: further in than its peak.
    const auto look_at = [&](double distance) {
        const FieldSum field = field_on_grabbed_at(world, distance, hand);
        const Vec3 force = grip.projector * field.force * units::newton_per_kcal_per_mol_angstrom;
        const double F_m = force.norm();
        const bool pulls_outward = grip.freedom == 1 && force.x() < 0;
        if (F_m > peak_nN * 1e-9 && !pulls_outward) return false;
        const Mat3 stiffness = grip.projector * field.stiffness * grip.projector *
                               units::newton_per_metre_per_kcal_per_mol_angstrom2;
        const double A_d = gain_where(servo, laws, force, stiffness);
        const double K = largest_felt(laws.force, force, stiffness) / A_d;
        if (K > stiffest.newton_per_metre) stiffest = {K, distance};
        return true;
    };
    if (grip.freedom == 1) {
        for (double distance = 2; distance < 12; distance += 0.002) look_at(distance);
        // Eq. 3 makes the rest place the stiffest, in a notch narrower than the scan.
        if (const auto rest = equilibrium_distance(world, hand)) look_at(*rest);
        return stiffest;
    }
    // In space from the start both ways; outward all gets soft soon.
    const double start = grabbed_distance(world, hand);
    for (double in = 0; in < 60 && look_at(start - in); in += 0.05) {
        if (on_stage)
            on_stage(fmt::format("searching for the stiffest place: {:.1f} Å in", in), {});
    }
    for (double out = 0.05; out < 2 && look_at(start + out);) out += 0.05;
    return stiffest;
}

double calm_stiffness(const SceneDescription& scene, std::size_t slot,
                      const std::optional<HandModel>& hand, double period_s) {
    const DeviceDescription& own = device_of(scene, slot);
    const CouplingDescription& coupling = coupling_of(scene, slot);
    DeviceDynamics device{own.inertia_kg, own.viscosity_N_s_per_m};
    if (coupling.mode == CouplingMode::Guarded) {
        device.viscosity_N_s_per_m += guarded_damping(coupling.damping_N_s_per_m, device.inertia_kg,
                                                      static_cast<int>(own.servo_delay_ticks));
        period_s = servo_tick_s;
    }
    return critical_stiffness(build_plant(device, hand), period_s,
                              static_cast<double>(own.servo_delay_ticks) * servo_tick_s);
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

void warn_of_resolution(const SceneDescription& scene, const World& world, std::size_t slot,
                        std::vector<std::string>& warnings) {
    const ServoSettings servo = build_servo_settings(scene, world, slot);
    if (!servo.guarded) return;
    const double step_mm = device_of(scene, slot).encoder_step_mm;
    const double jump = encoder_jump(*servo.guarded, 1e-3 * step_mm);
    if (jump > noticed_newton) {
        warnings.push_back(fmt::format(
            "without friction this device vibrates or generates energy: one step of its position "
            "sensor ({:.3g} mm) changes the force by {:.2g} N at once (at {:.3g} N/m and {:.3g} N "
            "s/m); expected at most {} N: a sensor step of {:.2g} mm or less, or less damping "
            "(device.encoder_step_mm, coupling.damping_N_s_per_m)",
            step_mm, jump, servo.guarded->cap_N_per_m, servo.guarded->damping_N_s_per_m,
            noticed_newton, step_mm * noticed_newton / jump));
    }
    // What sums of forces in single precision leave of some nanonewtons.
    constexpr double finest_newton = 2e-15;
    const double slope = force_gain(servo.guarded->force_law, 0);
    if (slope * finest_newton > noticed_newton) {
        warnings.push_back(fmt::format(
            "this force law makes rounding errors felt: at rest its gain is {:.2g} N/N, so forces "
            "of {:.2g} N are felt as {:.2g} N; expected a gain of at most {:.2g} N/N",
            slope, finest_newton, std::min(slope * finest_newton, coupling_of(scene, slot).clamp_N),
            noticed_newton / finest_newton));
    }
}

// Warns of a spring that is too stiff for the hand, whether it holds the handle or not.
void warn_of_stiffness(const SceneDescription& scene, const World& world, const HandScript& script,
                       std::size_t slot, const StageFunction& on_stage,
                       std::vector<std::string>& warnings) {
    const FeltStiffness stiffest = stiffest_place(scene, world, on_stage, slot);
    const std::optional<HandModel> hand = hand_model(list_hands(scene).at(slot).hand.grip);
    const double limit = calm_stiffness(scene, slot, hand, world.resource<Clock>().period_s);
    if (stiffest.newton_per_metre > limit) {
        warnings.push_back(
            fmt::format("without friction this setting vibrates: at {:.2f} Å the hand feels {:.3g} "
                        "N/m, but this hand on this device is stable only up to {:.3g} N/m at T_s "
                        "= {} ms; shorten the period, raise A_d or lower the force gain",
                        stiffest.angstrom, stiffest.newton_per_metre, limit, scene.period_ms));
    }
    if (script.release_s) {
        const double relaxed_limit =
            calm_stiffness(scene, slot, relaxed(hand), world.resource<Clock>().period_s);
        if (stiffest.newton_per_metre > relaxed_limit && stiffest.newton_per_metre <= limit) {
            warnings.push_back(fmt::format(
                "without friction this setting vibrates after the hand lets go: the relaxed hand "
                "is stable up to {:.3g} N/m at T_s = {} ms, but feels up to {:.3g} N/m",
                relaxed_limit, scene.period_ms, stiffest.newton_per_metre));
        }
    }
}

// Warns of a stroke beyond what the coupling allows, or longer than the run.
void warn_of_stroke(const SceneDescription& scene, const World& world, const HandScript& script,
                    std::size_t slot, std::vector<std::string>& warnings) {
    const HandTables tables = list_hands(scene).at(slot);
    const double stop_nN = coupling_of(scene, slot).stop_nN;
    const bool is_guarded = coupling_of(world, hand_at(world, slot)).is_guarded;
    if (is_guarded && tables.hand.peak_nN > stop_nN) {
        warnings.push_back(
            fmt::format("the hand should reach {:.6g} nN ({}.peak_nN), but the molecule stops at "
                        "{:.6g} nN (coupling.stop_nN)",
                        tables.hand.peak_nN, tables.hand_key, stop_nN));
    }
    const double last_move = script.path.empty() ? 0 : script.path.back().time_s;
    if (last_move > scene.seconds) {
        warnings.push_back(
            fmt::format("the stroke takes {:.6g} s, but the run only {:.6g} s (run.seconds)",
                        last_move, scene.seconds));
    }
}

}  // namespace

std::vector<std::string> list_warnings(const SceneDescription& scene, const World& world,
                                       const HandScript& script, const StageFunction& on_stage) {
    std::vector<std::string> warnings = scene.notes;
    warn_of_stiffness(scene, world, script, 0, on_stage, warnings);
    warn_of_resolution(scene, world, 0, warnings);
    if (const auto closest = describe_coincident_atoms(world.resource<AtomTable>().names,
                                                       world.resource<AtomTable>().positions,
                                                       nearest_single_precision)) {
        warnings.push_back(fmt::format("atoms overlap at the start: {}", *closest));
    }
    const std::optional<JointRelaxReport>& relaxed = world.resource<StartReport>().joints_at_rest;
    if (scene.statics.relaxes_start && relaxed && relaxed->end != RelaxEnd::Converged) {
        warnings.push_back(fmt::format(
            "the molecules are not at rest at the start: an rms force of {:.3g} kcal/mol per "
            "radian and Å remains after {} steps; raise statics.relax_steps or run palpa relax",
            relaxed->rms_force, relaxed->steps));
    }
    warn_of_stroke(scene, world, script, 0, warnings);
    for (const std::string& empty : find_empty_selections(scene.view, world))
        warnings.push_back(empty + " selects no atoms");
    if (scene.engine && scene.engine->program == EngineProgram::Unknown &&
        scene.engine->rate == 1) {
        warnings.emplace_back(
            "engine.rate is 1, but LAMMPS accepts forces only if it sends every second step or "
            "fewer");
    }
    return warnings;
}

std::vector<std::string> list_hand_warnings(const SceneDescription& scene, const World& world,
                                            const HandScript& script, std::size_t slot,
                                            const StageFunction& on_stage) {
    std::vector<std::string> warnings;
    warn_of_stiffness(scene, world, script, slot, on_stage, warnings);
    const HandDescription& hand = scene.hands.at(slot);
    if (hand.device || hand.coupling) warn_of_resolution(scene, world, slot, warnings);
    warn_of_stroke(scene, world, script, slot, warnings);
    for (std::string& warning : warnings)
        warning = fmt::format("{} hand: {}", edit_hand_names.at(slot), warning);
    return warnings;
}

namespace {

// Adds the warnings of one hand, each behind `whose`.
void warn_of_hand(const Summary& hand, std::string_view whose, std::vector<std::string>& warnings) {
    if (hand.safety_share > 0) {
        warnings.push_back(fmt::format("{}for {:.1f} % of the time: {}", whose,
                                       100 * hand.safety_share, describe(hand.gravest)));
    }
    if (hand.went_through) {
        warnings.push_back(
            fmt::format("{}the hand pushed the molecule through the other one", whose));
    }
    if (hand.stopped) {
        warnings.push_back(fmt::format("{}a force was not finite: the device was stopped", whose));
    }
}

}  // namespace

void warn_of_outcome(Summary& summary) {
    std::vector<std::string>& warnings = summary.warnings;
    warn_of_hand(summary, "", warnings);
    for (std::size_t i = 0; i < summary.other_hands.size(); ++i)
        warn_of_hand(summary.other_hands[i], fmt::format("{} hand: ", edit_hand_names.at(i + 1)),
                     warnings);
    if (summary.steps_not_finite > 0) {
        warnings.push_back(
            fmt::format("{} of {} steps gave results that were not finite and were discarded",
                        summary.steps_not_finite, summary.steps));
    }
    if (summary.sums_in_double > 0) {
        warnings.push_back(
            fmt::format("{} of {} force sums were computed in double precision and took longer, "
                        "because atoms were closer than {} Å or farther than {} Å",
                        summary.sums_in_double, summary.sums, nearest_single_precision,
                        farthest_single_precision));
    }
}

// A log of the active degrees of freedom, step by step.
class ActivityLog {
public:
    void add(const RelaxStepReport& relaxed, double took_us,
             const std::optional<double>& budget_us) {
        steps_ += 1;
        sum_.active += static_cast<double>(relaxed.active);
        if (!budget_us || took_us <= *budget_us) within_ += 1;
        if (!relaxed.is_chosen) return;
        ++sum_.choices;
        if (relaxed.total > 0) sum_.neglected_share += relaxed.neglected / relaxed.total;
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

// How far the force was from complete relaxation, in as much memory however long the run is.
class RelaxationLog {
public:
    void add(const RelaxStepReport& relaxed, double took_us) {
        if (relaxed.model_age) {
            if (relaxed.is_renewed) ++sum_.renewals;
            (relaxed.is_renewed ? renewing_ : between_).add(1e-6 * took_us);
        }
        if (relaxed.released > least_snap) {
            ++sum_.snaps;
            sum_.released += relaxed.released;
        }
        if (!relaxed.estimated_error_pN) return;
        ++sum_.estimates;
        ++counts_[bin_of(*relaxed.estimated_error_pN)];
    }

    RelaxationSummary summary() const {
        RelaxationSummary result = sum_;
        result.error_median_pN = quantile_of(0.5);
        result.error_90_pN = quantile_of(0.9);
        result.between_median_us = between_.quantile_us(0.5);
        result.between_90_us = between_.quantile_us(0.9);
        result.between_99_us = between_.quantile_us(0.99);
        result.renewal_median_us = renewing_.quantile_us(0.5);
        return result;
    }

private:
    static constexpr double least = 0.001;  // pN, of the first bin
    static constexpr double width = 0.02;   // of a bin, of the logarithm

    std::size_t bin_of(double pN) const {
        const double bin = repeatable::log(std::max(pN, least) / least) / width;
        return std::min(counts_.size() - 1, static_cast<std::size_t>(bin));
    }
    double quantile_of(double share) const {
        double left = share * static_cast<double>(sum_.estimates);
        for (std::size_t bin = 0; bin < counts_.size(); ++bin) {
            left -= static_cast<double>(counts_[bin]);
            if (left <= 0) return least * repeatable::exp(width * static_cast<double>(bin));
        }
        return 0;
    }

    RelaxationSummary sum_;
    StepTimes between_, renewing_;
    std::array<std::uint64_t, 1200> counts_{};  // up to 1e7 pN
};

// Lists what the model of a flexible scene leaves out.
std::vector<std::string> list_neglected(const SceneDescription& scene, const World& world) {
    std::vector<std::string> neglected;
    if (!has_mobile(world)) return neglected;
    const StaticsDescription& s = scene.statics;
    const auto coordinates = static_cast<std::int64_t>(model_of(world).coordinates);
    if (s.cutoff_angstrom)
        neglected.push_back(fmt::format("pairs beyond {} A", *s.cutoff_angstrom));
    if (joint_activity(world) == JointActivity::Active && s.active < coordinates)
        neglected.push_back(fmt::format("motion of all but {} of {} degrees of freedom at a time",
                                        s.active, coordinates));
    if (const std::size_t held = world.resource<StartReport>().joints_held; held > 0)
        neglected.push_back(fmt::format("motion of {} joints outside of the region", held));
    neglected.emplace_back(scene.force_field.solvent == Solvent::None
                               ? "solvent"
                               : "salt, surface tension and viscosity of EEF1-SB's implicit water");
    neglected.emplace_back("changes of bond lengths and angles");
    return neglected;
}

// A log of what a run gathers beside its recording.
class RunLog {
public:
    RunLog(const SceneDescription& scene, const World& world, std::span<const LockstepHand> hands)
        : scene_(scene) {
        for (std::size_t i = 0; i < hands.size(); ++i) {
            statistics_.emplace_back(servo_tick_s);
            accuracy_.emplace_back(scene, i, hands[i].servo);
        }
        // It goes by atoms' numbers, which edits change.
        if (has_mobile(world) && scene.edits.empty()) unbinding_.emplace(world);
    }

    // Atoms may have other numbers from now on.
    void note_edit() { unbinding_.reset(); }

    void add_step(const World& world) {
        const StepReport& report = world.resource<StepReport>();
        for (Statistics& each : statistics_) each.add_step(1e-6 * report.took_us, report.finite);
        const Clock& clock = world.resource<Clock>();
        if (unbinding_) unbinding_->add(world, static_cast<double>(clock.steps) * clock.period_s);
        client_pulls_ += is_pulled_by_clients(world) ? 1 : 0;
        const std::vector<Entity> hands = find_hands(world);
        for (std::size_t i = 0; i < accuracy_.size(); ++i) {
            if (report.relaxed)
                accuracy_[i].add_step(*report.relaxed, find_error_estimate(world, hands[i]));
            else
                accuracy_[i].add_model(contact_of(world, hands[i]).sent.model);
        }
        if (!report.relaxed) return;
        relaxation_.add(*report.relaxed, report.took_us);
        activity_.add(*report.relaxed, report.took_us, scene_.statics.budget_us);
    }

    void add_ticks(std::span<const ServoTick> ticks) {
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            statistics_[i].add(ticks[i]);
            accuracy_[i].add(ticks[i]);
        }
    }

    Summary summary(const World& world, std::span<const LockstepHand> hands) const {
        Summary summary = statistics_.front().summary();
        summary.device = hands.front().device.spec().name;
        summary.client_pulls = client_pulls_;
        for (std::size_t i = 1; i < hands.size(); ++i) {
            summary.other_hands.push_back(statistics_[i].summary());
            summary.other_hands.back().device = hands[i].device.spec().name;
            summary.other_hands.back().accuracy = accuracy_[i].report(summary.step_median_us);
        }
        summary.accuracy = accuracy_.front().report(summary.step_median_us);
        if (unbinding_) summary.unbinding = unbinding_->unbinding();
        summary.engine = report_engine(world);
        if (!has_mobile(world)) return summary;
        // Where molecules make room for each other, one may well be on either side of another.
        constexpr double on_top = 1;  // Å
        summary.went_through = summary.unbinding && summary.unbinding->closest < on_top;
        if (joint_activity(world) == JointActivity::Active) summary.activity = activity_.activity();
        summary.relaxation = relaxation_.summary();
        summary.neglected = list_neglected(scene_, world);
        const ForceCount sums = count_forces(world);
        summary.sums = sums.all;
        summary.sums_in_double = sums.in_double;
        return summary;
    }

private:
    const SceneDescription& scene_;
    std::vector<Statistics> statistics_;  // of each hand
    std::vector<AccuracyLog> accuracy_;   // of each hand
    ActivityLog activity_;
    RelaxationLog relaxation_;
    std::optional<UnbindingLog> unbinding_;
    std::uint64_t client_pulls_ = 0;  // steps
};

namespace {

std::vector<LockstepHand> build_hands(const SceneDescription& scene, const World& world,
                                      std::span<Device* const> devices) {
    const std::vector<Entity> entities = find_hands(world);
    PALPA_ASSERT(entities.size() >= devices.size());
    std::vector<LockstepHand> hands;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        check_period(devices[i]->spec(), world.resource<Clock>().period_s);
        hands.push_back({*devices[i], build_servo_settings(scene, world, i, devices[i]->spec()),
                         contact_of(world, entities[i]).sent});
    }
    return hands;
}

}  // namespace

void renew_servos(const SceneDescription& scene, const World& world,
                  std::span<LockstepHand> hands) {
    for (std::size_t slot = 0; slot < hands.size(); ++slot) {
        LockstepHand& hand = hands[slot];
        const std::uint32_t revision = hand.servo.guarded ? hand.servo.guarded->revision : 0;
        hand.servo = build_servo_settings(scene, world, slot, hand.device.spec());
        if (hand.servo.guarded) hand.servo.guarded->revision = revision + 1;
    }
}

namespace {

std::vector<LocalContactModel> list_contacts(const World& world) {
    std::vector<LocalContactModel> contacts;
    world.each<Hand, Contact>(
        [&](Entity, const Hand&, const Contact& contact) { contacts.push_back(contact.sent); });
    return contacts;
}

}  // namespace

Summary run_headless(const SceneDescription& scene, World& world, Device& device,
                     const std::vector<std::string>& warnings, Recording* recording,
                     const ProgressFunction& progress, const FrameClock& frames,
                     const TickFunction& watch, const EndFunction& is_over) {
    Device* const devices[] = {&device};
    HandTicksFunction watch_first;
    if (watch) watch_first = [&](std::span<const ServoTick> ticks) { watch(ticks.front()); };
    return run_headless(scene, world, devices, warnings, recording, progress, frames, watch_first,
                        is_over);
}

Summary run_headless(const SceneDescription& scene, World& world, std::span<Device* const> devices,
                     const std::vector<std::string>& warnings, Recording* recording,
                     const ProgressFunction& progress, const FrameClock& frames,
                     const HandTicksFunction& watch, const EndFunction& is_over,
                     const BeforeStepFunction& before_step) {
    const std::uint64_t ticks = count_ticks(scene);
    const auto ticks_per_step =
        static_cast<std::uint64_t>(std::lround(world.resource<Clock>().period_s / servo_tick_s));
    std::vector<LockstepHand> hands = build_hands(scene, world, devices);
    RunLog log(scene, world, hands);
    EditPlayer edits(scene);
    UndoHistory history;

    std::uint64_t done = 0, drawn = 0, edition = 0;
    const EditFunction make = [&](const EditDescription& edit) {
        history.apply(world, edit);
        ++edition;
        log.note_edit();
        renew_servos(scene, world, hands);
    };
    const auto step = [&](std::span<const HandPose> poses, std::span<const ContactModel> felt) {
        const double now_s = static_cast<double>(done - 1) * servo_tick_s;
        for (const EditDescription& edit : edits.take_due(now_s)) make(edit);
        if (before_step) before_step(world, make);
        step_world(world, {poses, felt});
        log.add_step(world);
        return list_contacts(world);
    };
    const auto on_ticks = [&](std::span<const ServoTick> now) {
        const double now_s = static_cast<double>(done) * servo_tick_s;
        if (frames.draw && now_s >= static_cast<double>(drawn) / frames.per_second - 1e-9) {
            frames.draw();
            ++drawn;
        }
        log.add_ticks(now);
        if (recording) recording->add(now);
        if (recording) recording->sample(world, now_s, edition);
        if (watch) watch(now);
        ++done;
        if (progress && done % ticks_between_progress == 0 && done < ticks) {
            progress(static_cast<double>(done) / static_cast<double>(ticks));
        }
    };
    run_lockstep({ticks, ticks_per_step}, hands, step, on_ticks, is_over);

    if (progress) progress(1);
    Summary summary = log.summary(world, hands);
    summary.warnings = warnings;
    warn_of_outcome(summary);
    if (const std::optional<PlaybackState> played = find_playback(world);
        played && !played->problem.empty())
        summary.warnings.push_back(played->problem);
    if (recording) recording->finish(summary);
    return summary;
}

}  // namespace palpa
