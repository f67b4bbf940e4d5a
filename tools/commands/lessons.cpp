#include "tools/commands/lessons.h"

#include "core/load_error.h"
#include "core/text.h"
#include "experiments/play_lesson.h"
#include "scene/find_scene.h"
#include "scene/read_scene.h"
#include "tools/commands/choice.h"
#include "tools/commands/command.h"
#include "tools/commands/progress.h"
#include "tools/commands/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace palpa {
namespace {

struct LessonsCommand {
    std::string action, name;
    bool headless = false, idle = false, random = false, json = false;
    LessonDevice device = LessonDevice::Omni;
    std::uint64_t seed = 1;
};

std::string minutes_of(const SceneDescription& scene) {
    return scene.minutes > 0 ? fmt::format("{:g} min", scene.minutes) : "";
}

int print_lessons(bool json) {
    const std::vector<LessonEntry> lessons = list_lessons();
    if (json) {
        nlohmann::ordered_json list = nlohmann::ordered_json::array();
        for (const auto& [name, scene] : lessons) {
            nlohmann::ordered_json entry{{"name", name}, {"title", scene.title}};
            if (scene.minutes > 0) entry["minutes"] = scene.minutes;
            entry["steps"] = scene.lesson.size();
            entry["goal"] = scene.lesson_goal;
            list.push_back(entry);
        }
        fmt::print("{}\n", list.dump(2));
        return 0;
    }
    fmt::print("Lessons\n");
    for (const auto& [name, scene] : lessons) {
        const std::string minutes = minutes_of(scene);
        fmt::print("  {:<14} {}: {} steps{}{}\n  {:<14} {}\n", printable(name),
                   printable(scene.title), scene.lesson.size(), minutes.empty() ? "" : ", ",
                   minutes, "", printable(scene.lesson_goal));
    }
    fmt::print(
        "\n  palpa lessons play water             open a lesson in a window\n  palpa lessons play "
        "water --headless  let an emulated operator do it\n");
    return 0;
}

LessonEntry find_lesson(const std::string& name) {
    std::vector<LessonEntry> lessons = list_lessons();
    const auto found = std::ranges::find(lessons, name, &LessonEntry::name);
    if (found != lessons.end()) return *found;
    std::vector<std::string> names;
    for (const LessonEntry& lesson : lessons) names.push_back(lesson.name);
    throw LoadError({"palpa lessons play"}, fmt::format("no lesson '{}'; expected one of {}",
                                                        printable(name), fmt::join(names, ", ")));
}

std::string number_of(double value) { return fmt::format("{:.4g}", value); }

std::string wanted_by(const LessonStepDescription& step) {
    if (step.question) return "the right answer";
    std::string wanted(lesson_quantity_names[static_cast<std::size_t>(step.quantity)]);
    if (step.at_least) wanted += " at least " + number_of(*step.at_least);
    if (step.at_least && step.at_most) wanted += " and";
    if (step.at_most) wanted += " at most " + number_of(*step.at_most);
    if (step.for_s > 0) wanted += fmt::format(" for {} s", number_of(step.for_s));
    return wanted;
}

std::string reached_by(const LessonStepDescription& step, const LessonStepResult& result) {
    if (!result.was_reached) return "not reached";
    if (step.question) return result.is_done ? "answered" : "not answered";
    return result.value ? number_of(*result.value) : "no value";
}

void print_steps(const SceneDescription& scene, const LessonResult& result) {
    for (std::size_t i = 0; i < result.steps.size(); ++i) {
        const LessonStepDescription& step = scene.lesson[i];
        const LessonStepResult& of = result.steps[i];
        fmt::print("  {:<14} {:<8} {:>9}  {}; wanted: {}\n", printable(step.name),
                   of.is_done ? "done" : "not done",
                   of.is_done ? fmt::format("{:.2f} s", of.at_s) : "", reached_by(step, of),
                   wanted_by(step));
    }
    const auto done = std::ranges::count_if(result.steps, &LessonStepResult::is_done);
    const HandTravel& travel = result.travel;
    fmt::print(
        "{} of {} steps done in {:.1f} s; {:.1f} cm of the handle in {} strokes, {:.1f} cm lost\n",
        done, result.steps.size(), result.seconds, 100 * travel.handle_m, travel.strokes,
        100 * travel.lost_m);
}

void print_steps_as_json(const LessonEntry& lesson, const LessonResult& result) {
    nlohmann::ordered_json report{
        {"name", lesson.name}, {"done", result.is_done()}, {"seconds", result.seconds}};
    report["travel"] = {{"handle_m", result.travel.handle_m},
                        {"lost_m", result.travel.lost_m},
                        {"strokes", result.travel.strokes}};
    for (std::size_t i = 0; i < result.steps.size(); ++i) {
        const LessonStepDescription& step = lesson.scene.lesson[i];
        const LessonStepResult& of = result.steps[i];
        nlohmann::ordered_json entry{{"step", step.name}, {"done", of.is_done}};
        if (of.was_reached) entry["at_s"] = of.at_s;
        if (of.value) entry["value"] = *of.value;
        entry["wanted"] = wanted_by(step);
        report["steps"].push_back(entry);
    }
    fmt::print("{}\n", report.dump(2));
}

int play_headless(const LessonsCommand& command, const LessonEntry& lesson) {
    LessonPlayer player = LessonPlayer::Operator;
    if (command.idle) player = LessonPlayer::Idle;
    if (command.random) player = LessonPlayer::Random;
    ProgressLine progress(!command.json);
    const LessonResult result =
        play_lesson(lesson.scene, player, command.device, command.seed, progress.shares("steps"));
    progress.wipe();
    if (command.json) {
        print_steps_as_json(lesson, result);
    } else {
        print_steps(lesson.scene, result);
    }
    return result.is_done() ? 0 : 1;
}

int lessons_command(const LessonsCommand& command) {
    if (command.action.empty()) return print_lessons(command.json);
    if (command.name.empty()) {
        throw LoadError({"palpa lessons play"},
                        "needs a lesson; expected a name that 'palpa lessons' lists");
    }
    const LessonEntry lesson = find_lesson(command.name);
    if (command.headless) return play_headless(command, lesson);
    RunOptions options;
    options.scene = lesson.scene.file;
    return run_command(options);
}

}  // namespace

std::vector<LessonEntry> list_lessons() {
    std::vector<LessonEntry> lessons;
    for (const std::filesystem::path& folder : own_scene_folders()) {
        for (const SceneEntry& entry : list_scenes(folder)) {
            if (entry.is_to_be_made) continue;
            SceneDescription scene;
            try {
                scene = read_scene(entry.file);
            } catch (const LoadError&) {  // palpa run says what is wrong with it
                continue;
            }
            if (!scene.lesson.empty()) lessons.push_back({entry.name, std::move(scene)});
        }
        if (!lessons.empty()) break;
    }
    return lessons;
}

void add_lessons(CLI::App& program, ProgramCommand& chosen) {
    CLI::App& lessons = *program.add_subcommand(
        "lessons", "List and open guided lessons, step by step with checks");
    LessonsCommand& command = own_options<LessonsCommand>(lessons, chosen, lessons_command);
    describe(lessons,
             {"palpa lessons", "palpa lessons play water", "palpa lessons play water --headless",
              "palpa lessons play water --headless --by mouse"},
             "Exit code of --headless: 0 if every step is done, else 1.");
    lessons.add_option("action", command.action, "'play' (default: list the lessons)")
        ->check(CLI::IsMember({"play"}));
    lessons.add_option("name", command.name, "the lesson, by its name in the list");
    CLI::Option* const headless = lessons.add_flag(
        "--headless", command.headless, "without a window; an emulated operator does the lesson");
    CLI::Option* const idle =
        lessons.add_flag("--idle", command.idle, "replace the operator by a hand that holds still")
            ->needs(headless);
    lessons
        .add_flag("--random", command.random, "replace the operator by a hand that moves at random")
        ->needs(headless)
        ->excludes(idle);
    lessons
        .add_option_function<std::string>(
            "--by",
            [&command](const std::string& name) {
                command.device =
                    static_cast<LessonDevice>(choice_called("--by", name, lesson_device_names));
            },
            "device of the operator: omni (default), small (a workspace of 5 cm) or mouse")
        ->needs(headless)
        ->type_name("DEVICE");
    add_seed_option(lessons, command.seed);
    lessons.add_flag("--json", command.json, "print as JSON");
}

}  // namespace palpa
