#include "ui/view_labels.h"

#include "render/renderer.h"
#include "ui/colours.h"
#include "ui/layout.h"

#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace palpa {
namespace {

constexpr float below = 12;  // pixels from the place to the text, at the usual size of text

constexpr int most_lines_down = 5;

struct TextBox {
    ImVec2 low, high;
};

bool overlap(const TextBox& a, const TextBox& b) {
    return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

void draw_text(ImDrawList& list, const ImVec2& at, const char* text) {
    for (const float x : {-1.5F, 0.0F, 1.5F}) {
        for (const float y : {-1.5F, 0.0F, 1.5F})
            list.AddText({at.x + x, at.y + y}, colours().halo, text);
    }
    list.AddText(at, colours().ink, text);
}

}  // namespace

void draw_view_labels(std::span<const ViewLabel> labels, const FrameCamera& camera) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    std::vector<TextBox> taken;
    const auto draw = [&](const ViewLabel& label) {
        const glm::vec3 seen =
            project(camera, label.place, static_cast<std::uint32_t>(std::max(screen.x, 1.0F)),
                    static_cast<std::uint32_t>(std::max(screen.y, 1.0F)));
        if (!(seen.z > camera.near)) return;
        const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
        ImVec2 at{std::round(seen.x - size.x / 2), std::round(seen.y + scaled(below))};
        const auto is_taken = [&] {
            const TextBox box{at, {at.x + size.x, at.y + size.y}};
            return std::ranges::any_of(taken,
                                       [&](const TextBox& other) { return overlap(box, other); });
        };
        if (label.is_tick && is_taken()) return;
        for (int line = 0; line < most_lines_down && is_taken(); ++line) at.y += size.y;
        taken.push_back({at, {at.x + size.x, at.y + size.y}});
        draw_text(list, at, label.text.c_str());
    };
    for (const ViewLabel& label : labels) {
        if (!label.is_tick) draw(label);
    }
    for (const ViewLabel& label : labels) {
        if (label.is_tick) draw(label);
    }
}

}  // namespace palpa
