#include "ui/hand_sign.h"

#include "core/translate.h"
#include "render/renderer.h"
#include "ui/colours.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>

namespace palpa {
namespace {

constexpr ImU32 bar_empty = IM_COL32(200, 205, 212, 255),
                arrow_colour = IM_COL32(196, 84, 12, 255);    // of the arrow of the force
constexpr float above = 110, bar_width = 84, bar_height = 9;  // pixels at the usual text
constexpr float sign_pad = 5;

struct Bar {
    const char* name;
    double value, most;
    ImU32 colour;
    std::string text;
};

struct BarLayout {
    float names = 0, line = 0;  // width of the names, height of a line
    ImVec2 size{};
};

BarLayout lay_out(std::span<const Bar> bars) {
    const float pad = scaled(sign_pad);
    BarLayout layout{.line = ImGui::GetFontSize() + 0.6F * pad};
    float texts = 0;
    for (const Bar& bar : bars) {
        layout.names = std::max(layout.names, ImGui::CalcTextSize(bar.name).x);
        texts = std::max(texts, ImGui::CalcTextSize(bar.text.c_str()).x);
    }
    layout.size = {layout.names + scaled(bar_width) + texts + 4 * pad,
                   layout.line * static_cast<float>(bars.size()) + pad};
    return layout;
}

// Draws them one below the other, names at the left and values at the right, on one ground.
void draw_bars(ImDrawList& list, const ImVec2& at, std::span<const Bar> bars,
               const BarLayout& layout) {
    const float width = scaled(bar_width), height = scaled(bar_height), pad = scaled(sign_pad);
    const float names = layout.names, line = layout.line;
    list.AddRectFilled(at, {at.x + layout.size.x, at.y + layout.size.y}, colours().ground, pad);
    ImVec2 corner{at.x + pad, at.y + 0.5F * pad};
    for (const Bar& bar : bars) {
        const double share = bar.most > 0 ? std::clamp(bar.value / bar.most, 0.0, 1.0) : 0;
        const ImVec2 from{corner.x + names + pad, corner.y + 0.5F * (line - height)};
        list.AddText(corner, colours().ink, bar.name);
        list.AddRectFilled({from.x - 1, from.y - 1}, {from.x + width + 1, from.y + height + 1},
                           colours().ink);
        list.AddRectFilled(from, {from.x + width, from.y + height}, bar_empty);
        list.AddRectFilled(from, {from.x + static_cast<float>(share) * width, from.y + height},
                           bar.colour);
        list.AddText({from.x + width + pad, corner.y}, colours().ink, bar.text.c_str());
        corner.y += line;
    }
}

}  // namespace

void draw_hand_sign(const HandSign& sign, const FrameCamera& camera, const ScreenArea& area) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const glm::vec3 seen =
        project(camera, sign.place, static_cast<std::uint32_t>(std::max(screen.x, 1.0F)),
                static_cast<std::uint32_t>(std::max(screen.y, 1.0F)));
    if (!(seen.z > camera.near) || area.width() <= 0) return;
    std::string felt = fmt::format("{:.2f} N", sign.newton);
    if (!sign.reason.empty()) felt += ", " + sign.reason;
    const std::array bars{Bar{translated("molecule"), sign.molecule_nN, sign.most_nN, arrow_colour,
                              fmt::format("{:.2f} nN", sign.molecule_nN)},
                          Bar{translated("your hand"), sign.newton, sign.most_newton,
                              colours().hand, std::move(felt)}};
    const BarLayout layout = lay_out(bars);
    const float edge = panel_edge();
    const float right = std::max(area.left + edge, area.right - edge - layout.size.x);
    const float bottom = std::max(area.top + edge, area.bottom - edge - layout.size.y);
    const ImVec2 at{std::clamp(seen.x - 1.2F * scaled(bar_width), area.left + edge, right),
                    std::clamp(seen.y - scaled(above), area.top + edge, bottom)};
    draw_bars(*ImGui::GetBackgroundDrawList(), at, bars, layout);
}

}  // namespace palpa
