#include "tools/forced_choice.h"

#include "core/files.h"
#include "core/version.h"
#include "devices/emulated_omni.h"
#include "haptics/hand.h"
#include "session/lockstep.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/simulation.h"
#include "simulation/step.h"
#include "tools/choice.h"

#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

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

std::string_view name_of(CouplingMode mode) {
    return coupling_mode_names[static_cast<std::size_t>(mode)];
}

std::string_view unit_of(Question question) {
    return question == Question::Stiffer ? "N_per_m" : "N";
}

// Every force, energy and stiffness between molecules, this many times.
void scale_forces(double ratio, Simulation& simulation) {
    simulation.coulomb_constant *= ratio;
    for (double& root : simulation.atoms.sqrt_epsilon) root *= std::sqrt(ratio);
    for (ReplacedPair& pair : simulation.replaced_pairs) pair.epsilon *= ratio;
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

struct FitRow {
    CouplingMode mode = CouplingMode::Guarded;
    std::vector<AnsweredLevel> levels;
    PsychometricFit fit;
};

// A logarithm of a ratio as per cent more.
double per_cent(double level) noexcept { return 100 * std::expm1(level); }

std::string format_choices(Question question, const std::vector<Choice>& choices) {
    std::string text = fmt::format("participant,mode,ratio,reference_{0},comparison_{0},is_more\n",
                                   unit_of(question));
    for (const Choice& c : choices) {
        text += fmt::format("{},{},{:.4f},{:.4f},{:.4f},{:d}\n", c.participant, name_of(c.mode),
                            std::exp(c.level), c.reference, c.comparison, c.is_more);
    }
    return text;
}

std::string format_choices_json(const ForcedChoiceOptions& options,
                                const std::vector<FitRow>& rows) {
    nlohmann::ordered_json json = describe_study(options.study);
    json["question"] = question_names[static_cast<std::size_t>(options.question)];
    json["repeats"] = options.repeats;
    for (const FitRow& row : rows) {
        nlohmann::ordered_json mode{
            {"mode", name_of(row.mode)},
            {"end", psychometric_end_names[static_cast<std::size_t>(row.fit.end)]}};
        if (row.fit.end == PsychometricEnd::Found) {
            mode["threshold_log"] = row.fit.curve.threshold();
            mode["threshold_error_log"] = row.fit.threshold_error;
            mode["threshold_per_cent"] = per_cent(row.fit.curve.threshold());
            mode["slope_per_log"] = row.fit.curve.slope();
            mode["bias_log"] = row.fit.curve.middle;
            mode["bias_error_log"] = row.fit.middle_error;
        }
        for (const AnsweredLevel& at : row.levels)
            mode["levels"].push_back(
                {{"ratio", std::exp(at.level)}, {"answers", at.answers}, {"more", at.more}});
        json["modes"].push_back(mode);
    }
    return json.dump(2) + "\n";
}

std::string format_fit_table(const std::vector<FitRow>& rows) {
    std::string text =
        "| mode | answers | three of four are right from (%) | slope (1/ln) | bias (ln) |\n"
        "| --- | --- | --- | --- | --- |\n";
    for (const FitRow& row : rows) {
        std::size_t answers = 0;
        for (const AnsweredLevel& at : row.levels) answers += at.answers;
        const PsychometricCurve& curve = row.fit.curve;
        text += fmt::format("| {} | {} | ", name_of(row.mode), answers);
        switch (row.fit.end) {
            case PsychometricEnd::Found:
                // The error of the ratio: its logarithm's, times the ratio.
                text += fmt::format("{:.1f} ± {:.1f} | {:.2f} | {:+.3f} ± {:.3f} |\n",
                                    per_cent(curve.threshold()),
                                    100 * std::exp(curve.threshold()) * row.fit.threshold_error,
                                    curve.slope(), curve.middle, row.fit.middle_error);
                break;
            case PsychometricEnd::TooSteep:
                text += "not found: less than between two ratios | | |\n";
                break;
            case PsychometricEnd::TooFlat:
                text += "not found: the ratio hardly matters | | |\n";
                break;
        }
    }
    return text;
}

}  // namespace

Question question_called(const std::string& name) {
    return static_cast<Question>(choice_called("--forced-choice", name, question_names));
}

double noticeable_newton(double force_newton) noexcept {
    return std::max(0.09 * std::abs(force_newton), 0.05);
}

Impression feel_molecule(const ForcedChoiceOptions& options, CouplingMode mode, double rest,
                         double ratio, Draws& draws) {
    const SceneDescription scene = read_study_scene(
        options.study, {fmt::format("coupling.mode={}", name_of(mode)), "hand.stroke=hold"});
    Simulation simulation = load_simulation(scene);
    move_grabbed(simulation, rest);
    scale_forces(ratio, simulation);
    set_coupling(scene.coupling, simulation);  // for the touch of this start

    const HandScript script = plan_probe(options.question, draws);
    EmulatedOmni device(build_study_device(scene, script));
    constexpr double skin_s = 0.03;  // what is shorter is not felt
    const double side = options.question == Question::Stiffer ? 1 : -1;
    double felt_newton = 0, start_m = device.read().position_m.x();
    Impression impression;
    const auto step = [&](const HandPose& hand, const TouchModel& felt) {
        (void)step_simulation(simulation, hand, felt);
        return simulation.touch;
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
        static_cast<std::uint64_t>(std::lround(simulation.period_s / servo_tick_s));
    run_lockstep({ticks, ticks_per_step}, build_servo_settings(scene, simulation, device.spec()),
                 device, simulation.touch, step, on_tick);
    return impression;
}

std::vector<Choice> play_choices(
    const ForcedChoiceOptions& options,
    const std::function<void(std::size_t done, std::size_t of)>& on_choice) {
    const StudyOptions& study = options.study;
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

int forced_choice_command(const ForcedChoiceOptions& options) {
    check_study(options.study);
    std::unique_ptr<FolderLock> lock;
    if (options.study.folder) {
        lock = make_study_folder(*options.study.folder, {"choices.csv", "summary.json"});
    }
    const bool is_watched = isatty(STDERR_FILENO) != 0;
    const std::vector<Choice> choices =
        play_choices(options, [&](std::size_t done, std::size_t of) {
            if (is_watched) fmt::print(stderr, "\r{} of {} pairs ", done, of);
        });
    if (is_watched) fmt::print(stderr, "\r{:30}\r", "");
    std::vector<FitRow> rows;
    for (const CouplingMode mode : options.study.modes) {
        FitRow row{.mode = mode, .levels = count_answers(mode, choices), .fit = {}};
        row.fit = fit_psychometric(row.levels);
        rows.push_back(row);
    }
    const std::string summary = format_choices_json(options, rows);
    if (options.study.folder) {
        const std::filesystem::path& folder = *options.study.folder;
        write_text_files(std::vector<TextFile>{
            {folder / "choices.csv", format_choices(options.question, choices)},
            {folder / "summary.json", summary}});
    }
    fmt::print("{}", options.study.json ? summary : format_fit_table(rows));
    return 0;
}

}  // namespace palpa
