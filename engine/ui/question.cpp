#include "ui/question.h"

#include "ui/layout.h"

#include <imgui.h>
#include <imgui_internal.h>

namespace palpa {
namespace {

// Over everything, so that nothing behind it can be clicked.
void draw_shade(const ImVec2& screen) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(screen);
    ImGui::SetNextWindowBgAlpha(0.35F);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0, 0, 0, 1));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("##shade", nullptr,
                 fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar |
                     ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::BringWindowToDisplayFront(ImGui::GetCurrentWindow());
    ImGui::End();
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
}

}  // namespace

const Answer* find_answer(const Question& question, Key key) {
    for (const Answer& answer : question.answers) {
        if (answer.key == key) return &answer;
    }
    return nullptr;
}

const Answer* draw_question(const Question& question) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    draw_shade(screen);
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
