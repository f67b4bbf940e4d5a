// A small plot in an overlay: axes with round numbers, lines, points.
#pragma once
#include <imgui.h>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

struct PlotRange {
    double low = 0, high = 1;
};

// A range that contains all values with a margin, at least `least` wide; around 0 without values.
PlotRange range_around(std::span<const double> values, double least);

// About `count` round numbers inside the range, with steps of 1, 2 or 5 times a power of ten.
std::vector<double> round_ticks(PlotRange range, int count);

struct PlotLine {
    std::span<const double> x, y;  // of one length
    ImU32 colour = 0;
    std::string_view name;  // name in the legend; empty: no entry
};

struct PlotPoint {
    double x = 0, y = 0;
    ImU32 colour = 0;
};

struct Plot {
    std::string_view x_label, y_label;  // with unit; without x_label the x axis has no numbers
    PlotRange x, y;
    std::span<const PlotLine> lines;
    std::span<const PlotPoint> points{};
};

// Height of the labels of a plot, pixels.
float plot_label_height(bool has_x_label);

// Draws the plot at the cursor, `height` pixels high including labels and as wide as the window.
void draw_plot(const char* id, const Plot& plot, float height);

}  // namespace palpa
