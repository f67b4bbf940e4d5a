#include "ui/question.h"

#include "ui/layout.h"

#include <imgui.h>
#include <imgui_internal.h>

namespace palpa {

const Answer* find_answer(const Question& question, Key key) {
    for (const Answer& answer : question.answers) {
        if (answer.key == key) return &answer;
    }
    return nullptr;
}

const Answer* draw_question(const Question& question) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    draw_shade();
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowFocus();
    ImGui::SetNextWindowBgAlpha(1);
    ImGui::Begin("##question", nullptr,
                 fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    ImGui::PushTextWrapPos(scaled(420));
    ImGui::TextUnformatted(question.text.c_str());
    ImGui::PopTextWrapPos();
    const Answer* given = nullptr;
    for (const Answer& answer : question.answers) {
        if (&answer != question.answers.data()) ImGui::SameLine();
        if (ImGui::Button(answer.text.c_str())) given = &answer;
    }
    ImGui::End();
    return given;
}

}  // namespace palpa
