// The panel "Keys and mouse": what every key and use of the mouse does.
#include "app/actions.h"
#include "app/panels.h"
#include "core/translate.h"
#include "ui/icons.h"

#include <imgui.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

namespace palpa {
namespace {

struct HelpLine {
    std::string keys, does;
};

std::vector<HelpLine> list_lines() {
    std::vector<HelpLine> lines;
    for (const Gesture& gesture : list_gestures())
        lines.push_back({translated(gesture.name), translated(gesture.does)});
    for (const Action& action : list_actions())
        if (std::string keys = keys_of(action); !keys.empty())
            lines.push_back({std::move(keys), translated(action.text)});
    return lines;
}

// Keys and what they do, twice beside each other.
struct HelpTable {
    static constexpr std::size_t columns = 4;
    std::vector<std::array<std::string, columns>> rows;
    std::array<float, columns> widths{};  // pixels, unbroken

    static float gaps() { return 2 * columns * ImGui::GetStyle().CellPadding.x; }
    float width() const { return std::accumulate(widths.begin(), widths.end(), gaps()); }
    // Narrow columns stay; wide ones share what is left, and their words are broken.
    void shrink(float widest) {
        std::array<float*, columns> ascending{&widths[0], &widths[1], &widths[2], &widths[3]};
        std::ranges::sort(ascending, {}, [](const float* width) { return *width; });
        float left = widest - gaps();
        for (std::size_t i = 0; i < columns; ++i) {
            float& width = *ascending[i];
            width = std::min(width, left / static_cast<float>(columns - i));
            left -= width;
        }
    }
};

HelpTable lay_out_help() {
    HelpTable table;
    std::vector<HelpLine> lines = list_lines();
    const std::size_t half = (lines.size() + 1) / 2;
    lines.resize(2 * half);
    for (std::size_t i = 0; i < half; ++i) {
        const HelpLine &left = lines[i], &right = lines[half + i];
        table.rows.push_back({left.keys, left.does, right.keys, right.does});
        for (std::size_t k = 0; k < HelpTable::columns; ++k) {
            const float width = ImGui::CalcTextSize(table.rows.back()[k].c_str()).x;
            table.widths[k] = std::max(table.widths[k], width);
        }
    }
    for (float& width : table.widths) width += scaled(6);
    return table;
}

void draw_keys(World& app) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float edge = panel_edge();
    HelpTable table = lay_out_help();
    const float widest = screen.x - 2 * edge - ImGui::GetStyle().ScrollbarSize -
                         2 * ImGui::GetStyle().WindowPadding.x;
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {screen.x - 2 * edge, screen.y - 2 * edge});
    ImGui::SetNextWindowFocus();
    ImGui::SetNextWindowBgAlpha(1);
    bool stays = true;
    ImGui::Begin(labelled("Keys and mouse").c_str(), &stays,
                 fixed_panel | ImGuiWindowFlags_AlwaysAutoResize);
    const bool fits = table.width() <= widest;
    if (!fits) table.shrink(widest);
    constexpr ImGuiTableFlags tight = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoPadOuterX;
    if (ImGui::BeginTable("keys", HelpTable::columns, tight, {table.width(), 0})) {
        for (const float width : table.widths)
            ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, width);
        for (const auto& row : table.rows) {
            for (const std::string& cell : row) {
                ImGui::TableNextColumn();
                ImGui::PushTextWrapPos(fits ? -1.0F : 0.0F);
                ImGui::TextUnformatted(cell.c_str());
                ImGui::PopTextWrapPos();
            }
        }
        ImGui::EndTable();
    }
    ImGui::End();
    if (!stays) close_panel(app, "keys");
}

}  // namespace

extern const Panel keys_panel{.id = "keys",
                              .title = for_translation("Keys and mouse"),
                              .explains = for_translation("All keys and uses of the mouse."),
                              .icon = icon_keys,
                              .side = Side::Over,
                              .draw = draw_keys,
                              .is_open = false};

}  // namespace palpa
