#include "ui/study_panel.h"

#include "ui/layout.h"

#include <imgui.h>
#include <algorithm>

namespace palpa {

void draw_study_panel(const StudyCourse& course) {
    const float edge = panel_edge(), widest = scaled(560);
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({screen.x / 2, screen.y - edge}, ImGuiCond_Always, {0.5F, 1});
    ImGui::SetNextWindowSize({std::min(screen.x - 2 * edge, widest), 0});
    ImGui::Begin("Study", nullptr,
                 fixed_panel | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoNav);
    ImGui::TextWrapped("%s", course.text().c_str());
    ImGui::End();
}

}  // namespace palpa
