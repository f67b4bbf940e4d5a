#include "ui/plot.h"

#include "ui/layout.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

ImU32 faded(ImGuiCol colour, float alpha) { return ImGui::GetColorU32(colour, alpha); }

// The plot's area in pixels, and where a value falls in it.
struct Area {
    ImVec2 low, high;
    PlotRange x, y;

    ImVec2 place(double at_x, double at_y) const {
        const double right = (at_x - x.low) / (x.high - x.low),
                     up = (at_y - y.low) / (y.high - y.low);
        return {low.x + static_cast<float>(right) * (high.x - low.x),
                high.y - static_cast<float>(std::clamp(up, -1.0, 2.0)) * (high.y - low.y)};
    }
};

void draw_axes(ImDrawList& list, const Area& area, const Plot& plot) {
    const float line = ImGui::GetTextLineHeight();
    for (const double tick : round_ticks(plot.x, 5)) {
        const ImVec2 at = area.place(tick, plot.y.low);
        const std::string text = fmt::format("{:.6g}", tick);
        list.AddLine({at.x, area.low.y}, {at.x, area.high.y}, faded(ImGuiCol_Text, 0.10F));
        if (plot.x_label.empty()) continue;
        list.AddText({at.x - ImGui::CalcTextSize(text.c_str()).x / 2, area.high.y + 1},
                     faded(ImGuiCol_Text, 0.75F), text.c_str());
    }
    const int rows = std::max(2, static_cast<int>((area.high.y - area.low.y) / (1.8F * line)));
    for (const double tick : round_ticks(plot.y, rows)) {
        const ImVec2 at = area.place(plot.x.low, tick);
        const std::string text = fmt::format("{:.6g}", tick);
        list.AddLine({area.low.x, at.y}, {area.high.x, at.y},
                     faded(ImGuiCol_Text, tick == 0 ? 0.35F : 0.10F));
        list.AddText({area.low.x - ImGui::CalcTextSize(text.c_str()).x - 4, at.y - line / 2},
                     faded(ImGuiCol_Text, 0.75F), text.c_str());
    }
    list.AddRect(area.low, area.high, faded(ImGuiCol_Text, 0.30F));
    const std::string x_label(plot.x_label), y_label(plot.y_label);
    list.AddText({area.high.x - ImGui::CalcTextSize(x_label.c_str()).x, area.high.y + line + 1},
                 faded(ImGuiCol_Text, 1), x_label.c_str());
    list.AddText({area.low.x, area.low.y - line - 2}, faded(ImGuiCol_Text, 1), y_label.c_str());
}

void draw_legend(ImDrawList& list, const Area& area, const Plot& plot) {
    float right = area.high.x;
    // Where there is no room beside the label, the curve is known by it.
    const float label = area.low.x + ImGui::CalcTextSize(std::string(plot.y_label).c_str()).x;
    for (auto line = plot.lines.rbegin(); line != plot.lines.rend(); ++line) {
        if (line->name.empty()) continue;
        const std::string name(line->name);
        right -= ImGui::CalcTextSize(name.c_str()).x + 10;
        if (right < label) return;
        list.AddText({right, area.low.y - ImGui::GetTextLineHeight() - 2}, line->colour,
                     name.c_str());
    }
}

}  // namespace

PlotRange range_around(std::span<const double> values, double least) {
    if (values.empty()) return {-least / 2, least / 2};
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double middle = 0.5 * (*low + *high);
    const double half = std::max(0.55 * (*high - *low), 0.5 * least);
    return {middle - half, middle + half};
}

std::vector<double> round_ticks(PlotRange range, int count) {
    const double rough = (range.high - range.low) / count;
    if (!(rough > 0) || !std::isfinite(rough)) return {};
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double lead = rough / power;
    const double step = power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
    std::vector<double> ticks;
    for (double i = std::ceil(range.low / step); i * step <= range.high; ++i) {
        ticks.push_back(i * step + 0.0);  // no -0
    }
    return ticks;
}

float plot_label_height(bool has_x_label) {
    const float line = ImGui::GetTextLineHeight();
    return line + 4 + (has_x_label ? 2 * line + 3 : 4);
}

void draw_plot(const char* id, const Plot& plot, float height) {
    const float line = ImGui::GetTextLineHeight();
    const ImVec2 from = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::InvisibleButton(id, {std::max(width, 80.0F), height});
    // The margin has room for the widest number.
    float margin = 2 * line;
    for (const double tick : round_ticks(plot.y, 5))
        margin = std::max(margin, ImGui::CalcTextSize(fmt::format("{:.6g}", tick).c_str()).x + 8);
    const ImVec2 low{from.x + margin, from.y + line + 4};
    const float axes = height - plot_label_height(!plot.x_label.empty());
    const Area area{low, {from.x + std::max(width, 80.0F) - 8, low.y + axes}, plot.x, plot.y};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    draw_axes(list, area, plot);
    draw_legend(list, area, plot);
    list.PushClipRect(area.low, area.high, true);
    std::vector<ImVec2> places;
    for (const PlotLine& curve : plot.lines) {
        places.clear();
        for (std::size_t i = 0; i < curve.x.size(); ++i) {
            places.push_back(area.place(curve.x[i], curve.y[i]));
        }
        list.AddPolyline(places.data(), static_cast<int>(places.size()), curve.colour, 0,
                         scaled(1.6F));
    }
    for (const PlotPoint& point : plot.points) {
        const ImVec2 at = area.place(std::clamp(point.x, plot.x.low, plot.x.high),
                                     std::clamp(point.y, plot.y.low, plot.y.high));
        list.AddCircleFilled(at, scaled(4.5F), point.colour);
        list.AddCircle(at, scaled(4.5F), faded(ImGuiCol_Text, 1));
    }
    list.PopClipRect();
}

}  // namespace palpa
