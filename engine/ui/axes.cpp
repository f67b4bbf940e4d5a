#include "ui/axes.h"

#include "ui/colours.h"

#include <imgui.h>
#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace palpa {

void draw_axes(const OrbitCamera& camera, const ScreenArea& area) {
    constexpr float length = 26, least_area = 200;  // pixels at the usual size of text
    if (area.width() < scaled(least_area) || area.height() < scaled(least_area)) return;
    struct Axis {
        const char* name;
        glm::vec3 direction;
        ImU32 colour;
    };
    std::array axes{Axis{"x", {1, 0, 0}, IM_COL32(205, 60, 50, 255)},
                    Axis{"y", {0, 1, 0}, IM_COL32(60, 160, 70, 255)},
                    Axis{"z", {0, 0, 1}, IM_COL32(60, 110, 215, 255)}};
    const glm::vec3 eye = backward(camera);
    // The nearest is drawn last.
    std::ranges::sort(axes, {}, [&](const Axis& axis) { return glm::dot(axis.direction, eye); });
    const float reach = scaled(length), room = 1.7F * reach;
    const ImVec2 centre{area.right - room, area.top + room};
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    for (const Axis& axis : axes) {
        const float right = glm::dot(axis.direction, rightward(camera));
        const float up = glm::dot(axis.direction, upward(camera));
        const ImVec2 end{centre.x + reach * right, centre.y - reach * up};
        list.AddLine(centre, end, axis.colour, scaled(2));
        const ImVec2 size = ImGui::CalcTextSize(axis.name);
        list.AddText({centre.x + 1.35F * reach * right - 0.5F * size.x,
                      centre.y - 1.35F * reach * up - 0.5F * size.y},
                     colours().ink, axis.name);
    }
}

}  // namespace palpa
