// The panel "Lesson": the present step, its question and its plot.
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

// Buttons at the right end of the first line, where they are always seen.
void draw_buttons(World& app) {
    Lesson& lesson = app.write<LessonState>().lesson;
    const char* const restarts = for_translation("from the start");
    const bool is_last = lesson.current() + 1 == lesson.steps().size();
    const char* const goes_on = !lesson.can_go_on() ? for_translation("skip")
                                : is_last           ? for_translation("Finish (Enter)")
                                                    : for_translation("Next (Enter)");
    const ImGuiStyle& style = ImGui::GetStyle();
    float width = ImGui::CalcTextSize(translated(restarts)).x + 2 * style.FramePadding.x;
    if (!lesson.is_done())
        width += ImGui::CalcTextSize(translated(goes_on)).x + 2 * style.FramePadding.x +
                 style.ItemSpacing.x;
    ImGui::SameLine(std::max(0.0F, ImGui::GetWindowContentRegionMax().x - width));
    if (!lesson.is_done()) {
        const bool can_go_on = lesson.can_go_on();
        if (can_go_on)
            ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        const bool is_pressed = ImGui::SmallButton(labelled(goes_on).c_str());
        if (can_go_on) ImGui::PopStyleColor();
        if (is_pressed && can_go_on) lesson.go_on();
        if (is_pressed && !can_go_on) lesson.skip();
        ImGui::SameLine();
    }
    if (ImGui::SmallButton(labelled(restarts).c_str())) request(app, restart_lesson);
}

void draw_step(World& app) {
    LessonState& state = app.write<LessonState>();
    Lesson& lesson = state.lesson;
    const LessonStepDescription& step = lesson.steps()[lesson.current()];
    ImGui::TextWrapped("%s", step.text.c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, lesson.is_step_done() ? colours().done : colours().task);
    ImGui::TextWrapped("%s%s", lesson.is_step_done() ? translated("Done: ") : "",
                       step.task.c_str());
    ImGui::PopStyleColor();
    if (step.question) {
        const auto pressed = draw_lesson_question(*step.question, lesson.chosen());
        if (pressed) lesson.answer(*pressed);
    }
    if (step.plot == LessonPlot::Map) draw_lesson_map(frame_of(app).readout.lesson);
    if (step.plot == LessonPlot::Force) state.curve.draw();
    if (step.for_s > 0) ImGui::ProgressBar(static_cast<float>(lesson.share()), {-1, scaled(6)}, "");
}

void draw_lesson(World& app) {
    const Lesson& lesson = app.resource<LessonState>().lesson;
    const std::size_t count = lesson.steps().size();
    if (lesson.is_done()) {
        ImGui::TextUnformatted(
            format_translated("All {} steps are done. L hides this.", count).c_str());
        return draw_buttons(app);
    }
    const std::size_t at = lesson.current();
    std::string head = format_translated("step {} of {}", at + 1, count);
    if (const auto value = lesson.value())
        head += ": " + describe_value(lesson.steps()[at], *value);
    ImGui::TextDisabled("%s", head.c_str());
    draw_buttons(app);
    ImGui::BeginChild(fmt::format("step {}", at).c_str());  // its own, so that it begins above
    if (!lesson.is_done()) draw_step(app);
    ImGui::EndChild();
}

bool is_lesson_there(const World& app) {
    return !app.resource<LessonState>().lesson.steps().empty();
}

}  // namespace

extern const Panel lesson_panel{.id = "lesson",
                                .title = for_translation("Lesson"),
                                .explains = for_translation("The present step of the lesson."),
                                .icon = icon_lesson,
                                .side = Side::Bottom,
                                .draw = draw_lesson,
                                .is_there = is_lesson_there};

}  // namespace palpa
