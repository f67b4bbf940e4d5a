#include "tools/lab/commands/study.h"

#include "core/files.h"
#include "core/load_error.h"
#include "experiments/study.h"
#include "tools/commands/choice.h"
#include "tools/commands/progress.h"
#include "tools/commands/study.h"
#include "tools/lab/commands/commands.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpa {
namespace {

OperatorManner manner_called(const std::string& name) {
    return static_cast<OperatorManner>(choice_called("--operator", name, operator_manner_names));
}

Question question_called(const std::string& name) {
    return static_cast<Question>(choice_called("--forced-choice", name, question_names));
}

nlohmann::ordered_json as_json(const Spread& spread) {
    nlohmann::ordered_json json{
        {"mean", spread.mean}, {"median", spread.median}, {"deviation", nullptr}};
    if (spread.deviation) json["deviation"] = *spread.deviation;
    return json;
}

std::string format_study_json(const OperatorStudyOptions& options,
                              const std::vector<StudyRow>& rows) {
    nlohmann::ordered_json json = describe_study(options);
    json["operators"] = options.operators;
    json["operator"] = operator_manner_names[static_cast<std::size_t>(options.manner)];
    json["rounds"] = options.rounds;
    json["limit_s"] = options.limit_s;
    for (const StudyRow& row : rows) {
        json["modes"].push_back({{"mode", coupling_mode_names[static_cast<std::size_t>(row.mode)]},
                                 {"trials", row.trials},
                                 {"distance_angstrom", as_json(row.distance_angstrom)},
                                 {"off_angstrom", as_json(row.off_angstrom)},
                                 {"time_s", as_json(row.time_s)},
                                 {"finished_share", row.finished_share},
                                 {"through_share", row.through_share}});
    }
    return json.dump(2) + "\n";
}

int run_study(const StudyCommand& command) {
    const OperatorStudyOptions& options = command.choice.study;
    if (command.is_choice) return forced_choice_command(command);
    check_study(options);
    std::unique_ptr<FolderLock> lock;
    if (command.folder) {
        lock = make_study_folder(*command.folder, {"trials.csv", "summary.json", "line.csv"});
    }
    CountLine count;
    const std::vector<StudyResult> results =
        play_study(options, [&](std::size_t done, std::size_t of) {
            count.show(fmt::format("{} of {} trials", done, of));
        });
    count.wipe();
    const std::vector<StudyRow> rows = summarise_study(options.modes, results);
    const std::string summary = format_study_json(options, rows);
    if (command.folder) {
        write_text_files(std::vector<TextFile>{
            {*command.folder / "trials.csv", trial_names() + format_trials(results)},
            {*command.folder / "summary.json", summary},
            {*command.folder / "line.csv", format_line(options)}});
    }
    fmt::print("{}", command.json ? summary : format_study_table(rows));
    return 0;
}

}  // namespace

void add_operator_study(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& study = *program.add_subcommand(
        "study", "Emulated operators search for the place without force in each mode");
    StudyCommand& command = own_options<StudyCommand>(study, chosen, run_study);
    ForcedChoiceOptions& choice = command.choice;
    OperatorStudyOptions& options = choice.study;
    describe(study,
             {"palpa-lab study scenes/water --operators 20",
              "palpa-lab study scenes/water --hand firm --modes 2,4,guarded -o study",
              "palpa-lab study scenes/water --forced-choice attracts-more --modes 2,4"},
             "People: palpa study.");
    study.add_option("--operators", options.operators, "number of emulated operators (default 5)")
        ->check(in_range(1, 1e6));
    CLI::Option* const rounds = add_rounds_option(study, options);
    CLI::Option* const manner = study.add_option_function<std::string>(
        "--operator", [&options](const std::string& name) { options.manner = manner_called(name); },
        "rule of the operators: naive follows the force; careful then takes the middle of the "
        "range without force (default naive)");
    CLI::Option* const question = study.add_option_function<std::string>(
        "--forced-choice",
        [&command](const std::string& name) {
            command.choice.question = question_called(name);
            command.is_choice = true;
        },
        "instead: a forced choice, stiffer or attracts-more, between two molecules of which one "
        "has larger forces");
    question->excludes(rounds)->excludes(manner);
    study.add_option("--repeats", choice.repeats, "repetitions of each pair (default 10)")
        ->check(in_range(1, 1e6))
        ->needs(question);
    study.add_option("--limit", options.limit_s, "time limit of a trial, s (default 90)")
        ->check(in_range(1, 3600))
        ->excludes(question);
    study.add_option("-o,--output", command.folder,
                     "new folder for the results: trials.csv, summary.json and line.csv; for "
                     "forced choices choices.csv and summary.json");
    study.add_flag("--json", command.json, "print the summary as JSON");
    add_study_options(study, options);
}

}  // namespace palpa
