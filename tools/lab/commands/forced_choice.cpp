// palpa-lab study --forced-choice: answers and fits, as files and as a table.
#include "tools/lab/experiments/forced_choice.h"
#include "core/files.h"
#include "tools/commands/progress.h"
#include "tools/commands/study.h"
#include "tools/lab/commands/study.h"
#include "tools/lab/experiments/psychometric.h"

#include <fmt/format.h>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

std::string_view name_of_mode(CouplingMode mode) {
    return coupling_mode_names[static_cast<std::size_t>(mode)];
}

std::string_view unit_of(Question question) {
    return question == Question::Stiffer ? "N_per_m" : "N";
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
        text +=
            fmt::format("{},{},{:.4f},{:.4f},{:.4f},{:d}\n", c.participant, name_of_mode(c.mode),
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
            {"mode", name_of_mode(row.mode)},
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
        text += fmt::format("| {} | {} | ", name_of_mode(row.mode), answers);
        switch (row.fit.end) {
            case PsychometricEnd::Found:
                // The error of the ratio: its logarithm's, times the ratio.
                text += fmt::format("{:.1f} ± {:.1f} | {:.2f} | {:+.3f} ± {:.3f} |\n",
                                    per_cent(curve.threshold()),
                                    100 * std::exp(curve.threshold()) * row.fit.threshold_error,
                                    curve.slope(), curve.middle, row.fit.middle_error);
                break;
            case PsychometricEnd::TooSteep:
                text += "not found: below the smallest ratio | | |\n";
                break;
            case PsychometricEnd::TooFlat:
                text += "not found: the answers hardly depend on the ratio | | |\n";
                break;
        }
    }
    return text;
}

}  // namespace

int forced_choice_command(const StudyCommand& command) {
    const ForcedChoiceOptions& options = command.choice;
    check_study(options.study);
    std::unique_ptr<FolderLock> lock;
    if (command.folder) {
        lock = make_study_folder(*command.folder, {"choices.csv", "summary.json"});
    }
    CountLine count;
    const std::vector<Choice> choices =
        play_choices(options, [&](std::size_t done, std::size_t of) {
            count.show(fmt::format("{} of {} pairs", done, of));
        });
    count.wipe();
    std::vector<FitRow> rows;
    for (const CouplingMode mode : options.study.modes) {
        FitRow row{.mode = mode, .levels = count_answers(mode, choices), .fit = {}};
        row.fit = fit_psychometric(row.levels);
        rows.push_back(row);
    }
    const std::string summary = format_choices_json(options, rows);
    if (command.folder) {
        const std::filesystem::path& folder = *command.folder;
        write_text_files(std::vector<TextFile>{
            {folder / "choices.csv", format_choices(options.question, choices)},
            {folder / "summary.json", summary}});
    }
    fmt::print("{}", command.json ? summary : format_fit_table(rows));
    return 0;
}

}  // namespace palpa
