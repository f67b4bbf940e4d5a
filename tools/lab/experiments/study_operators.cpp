#include "tools/lab/experiments/study_operators.h"

#include "core/draws.h"
#include "core/units.h"
#include "devices/emulated_hand.h"
#include "devices/emulated_omni.h"
#include "haptics/hand.h"
#include "loading/load.h"
#include "session/lockstep.h"
#include "session/run_headless.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

// Who it is, by the participant's draws, and what this trial begins with, by its own.
OperatorSettings draw_operator(const OperatorStudyOptions& options, const StudyTrial& trial,
                               const SceneDescription& scene, double rest, Draws& draws) {
    Draws person(options.seed, participant_number(trial.participant));
    OperatorSettings settings;
    settings.manner = options.manner;
    settings.threshold_newton = person.between(0.05, 0.1);
    settings.approach_m_per_s = person.between(0.03, 0.06);
    settings.has_force = trial.mode != CouplingMode::NoForce;
    settings.handle_m_per_angstrom = coupling_of(scene, 0).A_d * units::metre_per_angstrom;
    // Where contact begins is seen well enough. To find the rest by the picture alone is guessing:
    // this spread is of the size that people had in the paper, and goes no nearer than molecules
    // visibly are in each other.
    settings.guess_angstrom = settings.has_force
                                  ? rest + std::abs(0.3 * draws.normal())
                                  : std::max(rest - 0.47, rest + 0.35 + 1.2 * draws.normal());
    return settings;
}

}  // namespace

StudyResult play_trial(const OperatorStudyOptions& options, const StudyTrial& trial) {
    const auto mode = coupling_mode_names[static_cast<std::size_t>(trial.mode)];
    const SceneDescription scene =
        read_study_scene(options, {fmt::format("coupling.mode={}", mode), "hand.stroke=hold"});
    World world = load_world(scene);
    const double rest = find_rest(scene, world);
    Draws draws(options.seed, trial_number(trial));
    StudyResult result{.trial = trial, .start_angstrom = rest + draw_start(draws)};
    const OperatorSettings person = draw_operator(options, trial, scene, rest, draws);
    SeekingOperator seeker(person, draws);
    const double wall = find_wall(world, result.start_angstrom);
    move_grabbed(world, result.start_angstrom);
    set_couplings(scene, world);  // for the contact model of this start

    HandOrders orders;
    EmulatedOmniSettings omni = build_study_device(scene, {});
    omni.orders = &orders;
    omni.driver = HandDriver::Operator;
    EmulatedOmni device(omni);
    const auto step = [&](const HandPose& hand, const ContactModel& felt) {
        (void)step_world(world, hand, felt);
        return contact_at(world, 0);
    };
    const auto on_tick = [&](const ServoTick& tick) {
        result.found_angstrom = tick.contact.molecule.place_angstrom.x();
        result.went_through = result.went_through || result.found_angstrom < wall;
        seeker.feel(tick.sent_newton.x(), result.found_angstrom);
        orders.post({.target_m = Vec3(seeker.wish_m(), 0, 0)});
        result.seconds += servo_tick_s;
    };
    const auto limit = static_cast<std::uint64_t>(std::ceil(options.limit_s / servo_tick_s));
    const auto ticks_per_step =
        static_cast<std::uint64_t>(std::lround(world.resource<Clock>().period_s / servo_tick_s));
    run_lockstep({limit, ticks_per_step}, build_servo_settings(scene, world, 0, device.spec()),
                 device, contact_at(world, 0), step, on_tick, [&] { return seeker.is_done(); });
    result.off_angstrom = result.found_angstrom - rest;
    result.is_finished = seeker.is_done();
    return result;
}

std::vector<StudyResult> play_study(
    const OperatorStudyOptions& options,
    const std::function<void(std::size_t done, std::size_t of)>& on_result) {
    std::vector<StudyTrial> trials;
    for (std::size_t participant = 1; participant <= options.operators; ++participant) {
        const auto own = plan_study(participant, options.rounds, options.modes, options.seed);
        trials.insert(trials.end(), own.begin(), own.end());
    }
    std::vector<StudyResult> results;
    for (const StudyTrial& trial : trials) {
        results.push_back(play_trial(options, trial));
        if (on_result) on_result(results.size(), trials.size());
    }
    return results;
}

}  // namespace palpa
