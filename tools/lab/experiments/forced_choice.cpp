#include "tools/lab/experiments/forced_choice.h"

#include "devices/emulated_omni.h"
#include "haptics/hand.h"
#include "loading/load.h"
#include "platform/terminal.h"
#include "session/lockstep.h"
#include "session/run_headless.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/step.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace palpa {
namespace {

// The row of draws that is this pair's alone, whatever else is played; none that a study has.
std::uint64_t pair_number(std::size_t participant, CouplingMode mode, std::size_t pair) noexcept {
    constexpr std::uint64_t first_row = std::uint64_t{1} << 40U, most_pairs = 10'000'000;
    return first_row +
           most_pairs *
               (coupling_mode_names.size() * participant + static_cast<std::size_t>(mode)) +
           pair;
}

std::string_view mode_name(CouplingMode mode) {
    return coupling_mode_names[static_cast<std::size_t>(mode)];
}

// Every force, energy and stiffness between molecules, this many times.
void scale_forces(double ratio, World& world) {
    Interactions& interactions = world.write<Interactions>();
    interactions.coulomb_constant *= ratio;
    for (double& root : world.write<AtomTable>().sqrt_epsilon.write()) root *= std::sqrt(ratio);
    for (ReplacedPair& pair : interactions.replaced_pairs) pair.epsilon *= ratio;
}

// In or out of the rest place and back.
HandScript plan_probe(Question question, Draws& draws) {
    constexpr double rest_s = 0.2;
    const double way_m =
        question == Question::Stiffer ? -draws.between(0.008, 0.012) : draws.between(0.02, 0.03);
    const double out_s = rest_s + draws.between(0.8, 1.5);
    HandScript script;
    script.path = {{rest_s, 0}, {out_s, way_m}, {2 * out_s - rest_s, 0}};
    return script;
}

}  // namespace

double noticeable_newton(double force_newton) noexcept {
    return std::max(0.09 * std::abs(force_newton), 0.05);
}

Impression feel_molecule(const ForcedChoiceOptions& options, CouplingMode mode, double rest,
                         double ratio, Draws& draws) {
    const SceneDescription scene = read_study_scene(
        options.study, {fmt::format("coupling.mode={}", mode_name(mode)), "hand.stroke=hold"});
    World world = load_world(scene);
    move_grabbed(world, rest);
    scale_forces(ratio, world);
    set_couplings(scene, world);  // for the contact model of this start

    const HandScript script = plan_probe(options.question, draws);
    EmulatedOmni device(build_study_device(scene, script));
    constexpr double skin_s = 0.03;  // what is shorter is not felt
    const double side = options.question == Question::Stiffer ? 1 : -1;
    double felt_newton = 0, start_m = device.read().position_m.x();
    Impression impression;
    const auto step = [&](const HandPose& hand, const ContactModel& felt) {
        (void)step_world(world, hand, felt);
        return contact_at(world, 0);
    };
    const auto on_tick = [&](const ServoTick& tick) {
        felt_newton += (side * tick.sent_newton.x() - felt_newton) * servo_tick_s / skin_s;
        if (felt_newton <= impression.force_newton) return;
        const double way_m = std::abs(tick.reading.position_m.x() - start_m);
        impression.force_newton = felt_newton;
        impression.value =
            options.question == Question::Stiffer ? felt_newton / way_m : felt_newton;
    };
    const auto ticks =
        static_cast<std::uint64_t>(std::lround(script.path.back().time_s / servo_tick_s));
    const auto ticks_per_step =
        static_cast<std::uint64_t>(std::lround(world.resource<Clock>().period_s / servo_tick_s));
    run_lockstep({ticks, ticks_per_step}, build_servo_settings(scene, world, 0, device.spec()),
                 device, contact_at(world, 0), step, on_tick);
    return impression;
}

std::vector<Choice> play_choices(
    const ForcedChoiceOptions& options,
    const std::function<void(std::size_t done, std::size_t of)>& on_choice) {
    const OperatorStudyOptions& study = options.study;
    const std::size_t pairs = choice_levels.size() * options.repeats;
    const std::size_t all = study.operators * study.modes.size() * pairs;
    // Both of a pair are felt with noise; their difference is noticed right in three of four cases
    // where it is as large as what is noticeable.
    constexpr double three_of_four = 0.6744897501960817;
    const double rest = find_rest(study);
    std::vector<Choice> choices;
    for (std::size_t who = 1; who <= study.operators; ++who) {
        for (const CouplingMode mode : study.modes) {
            for (std::size_t pair = 0; pair < pairs; ++pair) {
                Draws draws(study.seed, pair_number(who, mode, pair));
                const auto compare = [&](const Impression& felt) {
                    if (felt.force_newton <= 0) return 0.0;
                    const double noise = noticeable_newton(felt.force_newton) /
                                         (three_of_four * std::sqrt(2)) * draws.normal();
                    return felt.value * (1 + noise / felt.force_newton);
                };
                Choice choice{who, mode, choice_levels[pair % choice_levels.size()]};
                const Impression reference = feel_molecule(options, mode, rest, 1, draws);
                const Impression comparison =
                    feel_molecule(options, mode, rest, std::exp(choice.level), draws);
                const double less = compare(reference), more = compare(comparison);
                choice.reference = reference.value;
                choice.comparison = comparison.value;
                const bool guesses = less == more || draws.between(0, 1) < lapse_share;
                choice.is_more = guesses ? draws.below(2) == 1 : more > less;
                choices.push_back(choice);
                if (on_choice) on_choice(choices.size(), all);
            }
        }
    }
    return choices;
}

std::vector<AnsweredLevel> count_answers(CouplingMode mode, const std::vector<Choice>& choices) {
    std::vector<AnsweredLevel> levels;
    for (const double level : choice_levels) levels.push_back({level, 0, 0});
    for (const Choice& choice : choices) {
        if (choice.mode != mode) continue;
        const auto at = std::ranges::find(levels, choice.level, &AnsweredLevel::level);
        ++at->answers;
        if (choice.is_more) ++at->more;
    }
    return levels;
}

}  // namespace palpa
