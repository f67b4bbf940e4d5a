#include "ui/caption.h"

#include "ui/colours.h"

#include <imgui.h>
#include <utility>

namespace palpa {

void draw_caption(const std::string& text, const ScreenArea& area) {
    constexpr float larger = 1.8F, pad = 8, rounding = 6;  // pixels at the usual size of text
    const auto [ink, ground] = std::pair(colours().ink, colours().ground);
    if (text.empty() || area.width() <= 0) return;
    ImFont* const font = ImGui::GetFont();
    float height = larger * ImGui::GetFontSize();
    const auto measure = [&] {
        return font->CalcTextSizeA(height, area.width() * 100, 0, text.c_str());
    };
    const float room = area.width() - 2 * panel_edge() - 2 * scaled(pad);
    if (measure().x > room) height *= room / measure().x;
    const ImVec2 size = measure();
    const ImVec2 at{0.5F * (area.left + area.right - size.x), area.top + 2 * panel_edge()};
    const float gap = scaled(pad);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({at.x - gap, at.y - 0.5F * gap},
                       {at.x + size.x + gap, at.y + size.y + 0.5F * gap}, ground, scaled(rounding));
    list.AddText(font, height, at, ink, text.c_str());
}

}  // namespace palpa
