// The panel "Lesson": the present step at the left, and what is said of an answer; its question or
// its plot at the right.
#include "app/lesson_course.h"
#include "app/panels.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/colours.h"
#include "ui/icons.h"
#include "ui/lesson_plots.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cstddef>
#include <string>

namespace palpa {
namespace {

// The text's share of the width beside a question, a plot, a map.
constexpr float beside_question = 0.46F, beside_plot = 0.54F, beside_map = 0.6F;

void draw_action(World& app, const char* id, const char* text, bool is_next) {
    if (is_next)
        ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::SmallButton(labelled(text).c_str())) request(app, action_called(id));
    if (is_next) ImGui::PopStyleColor();
}

// Buttons at the right end of the first line, where they stay while the step changes.
void draw_buttons(World& app) {
    const Lesson& lesson = app.resource<LessonState>().lesson;
    const bool is_last = lesson.current() + 1 == lesson.steps().size();
    const bool can_go_on = lesson.can_go_on();
    const char* const goes_on = !lesson.is_step_done() ? for_translation("Skip")
                                : is_last              ? for_translation("Finish (Enter)")
                                                       : for_translation("Next (Enter)");
    const char* const restarts = for_translation("From the start");
    const ImGuiStyle& style = ImGui::GetStyle();
    const auto width_of = [&](const char* text) {
        return ImGui::CalcTextSize(translated(text)).x + 2 * style.FramePadding.x;
    };
    const float width = width_of(goes_on) + width_of(restarts) + style.ItemSpacing.x;
    ImGui::SameLine(std::max(0.0F, ImGui::GetWindowContentRegionMax().x - width));
    draw_action(app, "restart-lesson", restarts, false);
    ImGui::SameLine();
    ImGui::BeginDisabled(lesson.is_step_done() && !can_go_on);  // there is time to read
    draw_action(app, lesson.is_step_done() ? "next-step" : "skip-step", goes_on, can_go_on);
    ImGui::EndDisabled();
}

// How near the person is to the goal, as a bar; filled again by the time for which it must be kept.
void draw_goal(const Lesson& lesson) {
    const std::optional<double> value = lesson.value();
    if (!value) return;
    const LessonStepDescription& step = lesson.steps()[lesson.current()];
    const LessonGoal goal = describe_goal(step, *value, lesson.start().value_or(*value));
    write_wrapped(goal.now + "; " + goal.goal);
    const bool is_kept = goal.share >= 1 && step.for_s > 0;
    const double share = lesson.is_step_done() ? 1 : is_kept ? lesson.share() : goal.share;
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram,
                          lesson.is_step_done() || is_kept ? colours().done : colours().task);
    ImGui::ProgressBar(static_cast<float>(share), {-1, scaled(6)}, "");
    ImGui::PopStyleColor();
}

void draw_text(const Lesson& lesson) {
    const LessonStepDescription& step = lesson.steps()[lesson.current()];
    write_wrapped(step.text);
    ImGui::PushStyleColor(ImGuiCol_Text, lesson.is_step_done() ? colours().done : colours().task);
    write_wrapped((lesson.is_step_done() ? translated("Done: ") : "") + step.task);
    ImGui::PopStyleColor();
    draw_goal(lesson);
    if (step.question && lesson.chosen()) write_explanation(*step.question, *lesson.chosen());
}

float share_of_text(const LessonStepDescription& step) {
    if (step.question) return beside_question;
    if (step.plot == LessonPlot::Map) return beside_map;
    return step.plot == LessonPlot::None ? 1 : beside_plot;
}

void draw_beside(World& app) {
    LessonState& state = app.write<LessonState>();
    const LessonStepDescription& step = state.lesson.steps()[state.lesson.current()];
    if (step.question) {
        const auto pressed = draw_lesson_question(*step.question, state.lesson.chosen());
        if (pressed) state.lesson.answer(*pressed);
    } else if (step.plot == LessonPlot::Map) {
        draw_lesson_map(frame_of(app).readout.lesson);
    } else {
        state.curve.draw(step.plot, std::max(scaled(80), ImGui::GetContentRegionAvail().y));
    }
}

// Each in a window of its own, so that every step begins above.
void draw_step(World& app) {
    const Lesson& lesson = app.resource<LessonState>().lesson;
    const LessonStepDescription& step = lesson.steps()[lesson.current()];
    const float share = share_of_text(step), width = share * ImGui::GetContentRegionAvail().x;
    ImGui::BeginChild(fmt::format("text {}", lesson.current()).c_str(), {width, 0});
    draw_text(lesson);
    ImGui::EndChild();
    if (share == 1) return;
    ImGui::SameLine();
    ImGui::BeginChild(fmt::format("beside {}", lesson.current()).c_str());
    draw_beside(app);
    ImGui::EndChild();
}

// Says what was learned, and where to go on.
void draw_end(World& app) {
    const SceneDescription& scene = scene_of(app);
    const std::string& learned =
        scene.lesson_learned.empty() ? scene.lesson_goal : scene.lesson_learned;
    ImGui::PushStyleColor(ImGuiCol_Text, colours().done);
    ImGui::TextUnformatted(format_translated("Well done: all {} steps of \"{}\".",
                                             app.resource<LessonState>().lesson.steps().size(),
                                             scene.title)
                               .c_str());
    ImGui::PopStyleColor();
    if (!learned.empty()) ImGui::TextWrapped("%s", learned.c_str());
    ImGui::Spacing();
    if (const std::optional<NextLesson>& next = options_of(app).lesson.next) {
        const std::string text = format_translated("Next lesson: {} (Enter)", next->title);
        if (ImGui::Button(text.c_str())) request(app, action_called("next-step"));
        ImGui::SameLine();
    }
    if (ImGui::Button(labelled("All lessons").c_str())) request(app, action_called("open"));
    ImGui::SameLine();
    if (ImGui::Button(labelled("From the start").c_str()))
        request(app, action_called("restart-lesson"));
}

void draw_lesson(World& app) {
    const Lesson& lesson = app.resource<LessonState>().lesson;
    if (lesson.is_done()) return draw_end(app);
    ImGui::TextDisabled(
        "%s",
        format_translated("Step {} of {}", lesson.current() + 1, lesson.steps().size()).c_str());
    draw_buttons(app);
    draw_step(app);
}

bool is_lesson_there(const World& app) {
    return !app.resource<LessonState>().lesson.steps().empty();
}

// Letters of answers, while there is a question, do nothing else.
bool press_in_lesson(World& app, const KeyPress& press) {
    Lesson& lesson = app.write<LessonState>().lesson;
    if (!is_panel_seen(app, "lesson") || lesson.is_done() || press.control || types_text())
        return false;
    const auto& question = lesson.steps()[lesson.current()].question;
    if (!question || press.key < Key::A) return false;
    const auto answer = static_cast<std::size_t>(press.key) - static_cast<std::size_t>(Key::A);
    if (answer >= question->answers.size()) return false;
    lesson.answer(answer);
    return true;
}

}  // namespace

extern const Panel lesson_panel{.id = "lesson",
                                .title = for_translation("Lesson"),
                                .explains = for_translation("The present step of the lesson."),
                                .icon = icon_lesson,
                                .side = Side::Bottom,
                                .draw = draw_lesson,
                                .is_there = is_lesson_there,
                                .press = press_in_lesson};

}  // namespace palpa
