#include "ui/legend_panel.h"

#include "render/picture.h"

#include <imgui.h>

namespace palpa {

void draw_legend_panel(std::span<const LegendEntry> legend, const ScreenArea& area) {
    if (legend.empty()) return;
    ImGui::SetNextWindowPos({area.left + panel_edge(), area.bottom - panel_edge()},
                            ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowBgAlpha(0.6F);
    ImGui::Begin("##legend", nullptr,
                 fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoInputs);
    const float side = ImGui::GetFontSize();
    for (const LegendEntry& entry : legend) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const ImU32 colour = IM_COL32(srgb_code(entry.colour.r), srgb_code(entry.colour.g),
                                      srgb_code(entry.colour.b), 255);
        list.AddRectFilled(corner, {corner.x + side, corner.y + side}, colour);
        list.AddRect(corner, {corner.x + side, corner.y + side}, ImGui::GetColorU32(ImGuiCol_Text));
        ImGui::Dummy({side, side});
        ImGui::SameLine();
        ImGui::TextUnformatted(entry.text.c_str());
    }
    ImGui::End();
}

}  // namespace palpa
