// The panel "Plots": forces and displacement gain of the last ten seconds, over time or distance.
#include "app/panels.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/colours.h"
#include "ui/icons.h"
#include "ui/plot.h"

#include <imgui.h>
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

struct PlotsState {
    bool over_distance = false;
};

template <class Value>
std::vector<double> values_of(const World& app, const Value& value) {
    std::vector<double> values;
    for (const Reading& sample : app.resource<Readings>().history.samples())
        values.push_back(value(sample));
    return values;
}

// Draws three plots beside each other over these values.
void draw_traces(const World& app, const std::vector<double>& x, std::string_view x_label,
                 PlotRange across) {
    constexpr float least_height = 90;  // pixels at the usual size of text
    const float height =
        std::max(ImGui::GetContentRegionAvail().y - scaled(4), scaled(least_height));
    if (!ImGui::BeginTable("traces", 3)) return;
    const auto draw = [&](const char* id, std::string_view y_label, double least, ImU32 colour,
                          double (*value)(const Reading&), const char* explanation) {
        ImGui::TableNextColumn();
        const std::vector<double> y = values_of(app, value);
        const std::array lines{PlotLine{x, y, colour, {}}};
        std::array points{PlotPoint{}};
        if (!x.empty()) points[0] = {x.back(), y.back(), colours().now};
        draw_plot(id,
                  {x_label, y_label, across, range_around(y, least), lines,
                   x.empty() ? std::span<const PlotPoint>() : points},
                  height);
        tip(explanation);
    };
    draw(
        "F_m", translated("force on the molecule (nN)"), 0.2, colours().molecule,
        [](const Reading& r) { return r.molecular_nN; },
        translated("nN; on one axis + repels and - attracts"));
    draw(
        "F_h", translated("force on your hand (N)"), 0.5, colours().hand,
        [](const Reading& r) { return r.hand_N; }, translated("N, as sent to the device"));
    draw(
        "A_d", translated("handle per molecule (cm/Å)"), 0.2, colours().gain,
        [](const Reading& r) { return r.displacement_gain * 1e-8; },
        translated("A_d = dx_handle/dx_molecule; 1 cm/Å is 1e8"));
    ImGui::EndTable();
}

void draw_plots(World& app) {
    bool& over_distance = panel_state<PlotsState>(app).over_distance;
    if (ImGui::RadioButton(labelled("over time").c_str(), !over_distance)) over_distance = false;
    ImGui::SameLine();
    if (ImGui::RadioButton(labelled("over distance").c_str(), over_distance)) over_distance = true;
    if (over_distance) {
        const auto x = values_of(app, [](const Reading& r) { return r.distance_angstrom; });
        return draw_traces(app, x, translated("distance (Å)"), range_around(x, 1));
    }
    const auto x = values_of(app, [](const Reading& r) { return r.time_s; });
    const double now = x.empty() ? 0 : x.back();
    draw_traces(app, x, translated("time (s)"),
                {now - History::seconds, now + 0.02 * History::seconds});
}

}  // namespace

extern const Panel plots_panel{.id = "plots",
                               .title = for_translation("Plots"),
                               .explains = for_translation("Forces over time and over distance."),
                               .icon = icon_plot,
                               .side = Side::Bottom,
                               .draw = draw_plots,
                               .is_open = false};

}  // namespace palpa
