#include "ui/layout.h"

#include "core/text.h"
#include "core/translate.h"

#include <imgui_internal.h>
#include <utility>

namespace palpa {

bool icon_button(const char* icon, const char* id, const ImVec2& size, bool is_on) {
    const ImVec4 none{0, 0, 0, 0};
    ImGui::PushStyleColor(ImGuiCol_Button,
                          is_on ? ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive) : none);
    const bool is_pressed = ImGui::Button((std::string(icon) + "##" + id).c_str(), size);
    ImGui::PopStyleColor();
    return is_pressed;
}

void tip(const char* text) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(scaled(360));
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

std::string labelled(const char* english) {
    return std::string(translated(english)) + "###" + english;
}

void write_wrapped(std::string_view text) {
    const float width = ImGui::GetContentRegionAvail().x;
    std::string lines;
    for (const std::string_view paragraph : split_lines(text)) {
        std::string line;
        for (const std::string_view word : split_words(paragraph)) {
            std::string longer = line.empty() ? std::string(word) : line + ' ' + std::string(word);
            if (!line.empty() && ImGui::CalcTextSize(longer.c_str()).x > width) {
                lines += line + '\n';
                longer = word;
            }
            line = std::move(longer);
        }
        lines += line + '\n';
    }
    if (!lines.empty()) lines.pop_back();
    ImGui::TextUnformatted(lines.c_str());
}

void same_line_if_it_fits(const char* text) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = ImGui::CalcTextSize(text).x + 2 * style.FramePadding.x;
    const float right = ImGui::GetItemRectMax().x + style.ItemSpacing.x + width;
    if (right <= ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
}

void draw_shade() {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
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

}  // namespace palpa
