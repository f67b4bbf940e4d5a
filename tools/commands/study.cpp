#include "tools/commands/study.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "experiments/study.h"
#include "experiments/study_operators.h"
#include "tools/commands/choice.h"
#include "tools/commands/command.h"
#include "tools/commands/progress.h"
#include "tools/commands/study_files.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpa {
namespace {

// "1,2,guarded" as modes, each once. Throws LoadError.
std::vector<CouplingMode> modes_called(const std::string& names) {
    std::vector<CouplingMode> modes;
    for (std::size_t begin = 0; begin <= names.size();) {
        const std::size_t end = std::min(names.find(',', begin), names.size());
        const std::string name(trimmed(names.substr(begin, end - begin)));
        const auto mode =
            static_cast<CouplingMode>(choice_called("--modes", name, coupling_mode_names));
        if (std::ranges::find(modes, mode) != modes.end()) {
            throw LoadError({"--modes " + names},
                            fmt::format("names {} twice; expected each mode once", name));
        }
        modes.push_back(mode);
        begin = end + 1;
    }
    return modes;
}

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

std::string format_study_json(const StudyOptions& options, const std::vector<StudyRow>& rows) {
    nlohmann::ordered_json json = describe_study(options);
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
    const StudyOptions& options = command.choice.study;
    if (command.is_choice) return forced_choice_command(command);
    check_study(options);
    if (options.operators == 0) return study_in_window(command);
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

void add_study(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& study = *program.add_subcommand(
        "study", "Repeat the paper's experiment: find the place without force in each mode");
    StudyCommand& command = own_options<StudyCommand>(study, chosen, run_study);
    ForcedChoiceOptions& choice = command.choice;
    StudyOptions& options = choice.study;
    describe(study, "Experiments",
             {"palpa study scenes/water --operators 20", "palpa study scenes/water -o people",
              "palpa study scenes/water --operators 20 --hand firm --modes 2,4,guarded -o study",
              "palpa study scenes/water --operators 5 --forced-choice attracts-more --modes 2,4"});
    study.add_option("scene", options.scene, "scene folder or file of one axis")->required();
    options.operators = 0;
    CLI::Option* const operators =
        study
            .add_option(
                "--operators", options.operators,
                "number of emulated operators, headless (default: a person takes part in a window)")
            ->check(in_range(1, 1e6));
    CLI::Option* const rounds =
        study
            .add_option("--rounds", options.rounds,
                        "number of rounds, each with every mode once (default 3)")
            ->check(in_range(1, 999));
    study.add_option_function<std::string>(
        "--modes", [&options](const std::string& names) { options.modes = modes_called(names); },
        "modes 1 to 5 and guarded, separated by commas (default: all)");
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
    question->excludes(rounds)->excludes(manner)->needs(operators);
    manner->needs(operators);
    study.add_option("--repeats", choice.repeats, "repetitions of each pair (default 10)")
        ->check(in_range(1, 1e6))
        ->needs(question);
    study.add_option("--limit", options.limit_s, "time limit of a trial, s (default 90)")
        ->check(in_range(1, 3600))
        ->needs(operators)
        ->excludes(question);
    add_seed_option(study, options.seed);
    study.add_option("-o,--output", command.folder,
                     "new folder for the results: trials.csv, summary.json and line.csv; for "
                     "forced choices choices.csv and summary.json; for people (each adds to it) "
                     "trials.csv, session.json and line.csv");
    study.add_flag("--json", command.json, "print the summary as JSON")->needs(operators);
    study
        .add_flag("--validation", command.validation,
                  "check the window's drawing by the Vulkan validation layer")
        ->excludes(operators);
    add_setting(study, "--period-ms", "declared period of the simulation, ms (default 14)",
                options.settings);
    add_setting(study, "--hand",
                "grip of the emulated hand: light, slack, medium, firm or firm-grip",
                options.settings);
    add_setting(study, "--friction", "Coulomb friction of the device", options.settings);
    add_set_option(study, options.settings);
}

}  // namespace palpa
