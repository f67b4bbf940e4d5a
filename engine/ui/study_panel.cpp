#include "ui/study_panel.h"

#include <imgui.h>
#include <algorithm>

namespace palpa {

void draw_study_panel(const StudyCourse& course) {
    constexpr float edge = 10, widest = 560;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({screen.x / 2, screen.y - edge}, ImGuiCond_Always, {0.5F, 1});
    ImGui::SetNextWindowSize({std::min(screen.x - 2 * edge, widest), 0});
    ImGui::Begin("Study", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
    ImGui::TextWrapped("%s", course.text().c_str());
    ImGui::End();
}

}  // namespace palpa
