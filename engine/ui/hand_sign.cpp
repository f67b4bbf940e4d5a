#include "ui/hand_sign.h"

#include "render/renderer.h"
#include "ui/colours.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cstdint>

namespace palpa {
namespace {

constexpr ImU32 bar_empty = IM_COL32(200, 205, 212, 255), bar_full = IM_COL32(196, 84, 12, 255);
constexpr float above = 90, bar_width = 84, bar_height = 9,
                sign_pad = 5;  // pixels at the usual text

// Draws text on its ground.
void draw_sign_text(ImDrawList& list, const ImVec2& at, const std::string& text) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float gap = scaled(sign_pad);
    list.AddRectFilled({at.x - gap, at.y - 0.4F * gap},
                       {at.x + size.x + gap, at.y + size.y + 0.4F * gap}, colours().ground, gap);
    list.AddText(at, colours().ink, text.c_str());
}

}  // namespace

void draw_hand_sign(const HandSign& sign, const FrameCamera& camera, const ScreenArea& area) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const glm::vec3 seen =
        project(camera, sign.place, static_cast<std::uint32_t>(std::max(screen.x, 1.0F)),
                static_cast<std::uint32_t>(std::max(screen.y, 1.0F)));
    if (!(seen.z > camera.near) || area.width() <= 0) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float width = scaled(bar_width), height = scaled(bar_height), edge = panel_edge();
    const float right = std::max(area.left + edge, area.right - edge - 2 * width);
    const float bottom = std::max(area.top + edge, area.bottom - edge - 6 * ImGui::GetFontSize());
    ImVec2 at{std::clamp(seen.x - 0.5F * width, area.left + edge, right),
              std::clamp(seen.y - scaled(above), area.top + edge, bottom)};
    const double share =
        sign.most_newton > 0 ? std::clamp(sign.newton / sign.most_newton, 0.0, 1.0) : 0;
    list.AddRectFilled({at.x - 1, at.y - 1}, {at.x + width + 1, at.y + height + 1}, colours().ink);
    list.AddRectFilled(at, {at.x + width, at.y + height}, bar_empty);
    list.AddRectFilled(at, {at.x + static_cast<float>(share) * width, at.y + height}, bar_full);
    at.y += height + scaled(sign_pad);
    std::string text = fmt::format("{:.2f} N", sign.newton);
    if (!sign.reason.empty()) text += ", " + sign.reason;
    draw_sign_text(list, at, text);
}

}  // namespace palpa
