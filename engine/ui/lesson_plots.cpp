#include "ui/lesson_plots.h"

#include "core/translate.h"
#include "ui/colours.h"
#include "ui/layout.h"
#include "ui/plot.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

constexpr ImU32 visited_colour = IM_COL32(60, 130, 210, 170);
constexpr ImU32 map_line_colour = IM_COL32(120, 120, 120, 255);
constexpr ImU32 here_colour = IM_COL32(210, 60, 40, 255);

// In the order of LessonQuantity.
struct QuantityWords {
    const char* name;
    std::string_view unit;
};
constexpr std::array<QuantityWords, lesson_quantity_names.size()> quantity_words{
    {{for_translation("distance"), " Å"},
     {for_translation("force on the molecule"), " nN"},
     {for_translation("push on your hand"), " N"},
     {for_translation("mode"), ""},
     {for_translation("the force shakes by"), " N"},
     {for_translation("distance"), " Å"},
     {for_translation("angle"), "°"},
     {for_translation("hydrogen bonds"), ""},
     {for_translation("fields visited"), ""},
     {for_translation("way"), " Å"},
     {for_translation("your work"), " kcal/mol"},
     {for_translation("energy"), " kcal/mol"}}};

std::string letter_of(std::size_t answer) {
    return std::string(1, static_cast<char>('A' + static_cast<int>(answer)));
}

}  // namespace

LessonGoal describe_goal(const LessonStepDescription& step, double value, double start) {
    std::optional<double> least = step.at_least, most = step.at_most;
    const auto& [name, unit] = quantity_words[static_cast<std::size_t>(step.quantity)];
    std::string title = translated(name);
    // A force that must be below 0 attracts: it is a pull of so many newtons.
    const bool is_force =
        step.quantity == LessonQuantity::Force || step.quantity == LessonQuantity::FeltForce;
    if (is_force && most && *most <= 0) {
        value = -value;
        start = -start;
        std::swap(least, most);
        if (least) *least = -*least;
        if (most) *most = -*most;
        title = step.quantity == LessonQuantity::Force ? translated("pull on the molecule")
                                                       : translated("pull on your hand");
    }
    constexpr double rounding = 1e-3;
    LessonGoal goal;
    const double shown = std::abs(value) < rounding ? 0 : value;
    goal.now = fmt::format("{}: {:.3g}{}", title, shown, unit);
    if (least && most && *least == *most)
        goal.goal = format_translated("goal: {:.4g}{}", *least, unit);
    else if (least && most)
        goal.goal = format_translated("goal: {:.4g} to {:.4g}{}", *least, *most, unit);
    else if (least)
        goal.goal = format_translated("goal: {:.4g}{} or more", *least, unit);
    else if (most)
        goal.goal = format_translated("goal: {:.4g}{} or less", *most, unit);
    const double nearest = least && value < *least ? *least : most && value > *most ? *most : value;
    const double way = std::abs(nearest - start), left = std::abs(nearest - value);
    goal.share = left == 0 ? 1 : way == 0 ? 0 : std::clamp(1 - left / way, 0.0, 1.0);
    return goal;
}

std::optional<std::size_t> draw_lesson_question(const LessonQuestion& question,
                                                std::optional<std::size_t> chosen) {
    std::optional<std::size_t> pressed;
    write_wrapped(question.text);
    for (std::size_t i = 0; i < question.answers.size(); ++i) {
        const std::string text = fmt::format("{}  {}", letter_of(i), question.answers[i]);
        const ImVec2 pad{scaled(6), scaled(3)};
        const ImVec2 corner = ImGui::GetCursorPos();
        const float width = ImGui::GetContentRegionAvail().x;
        const float high = ImGui::CalcTextSize(text.c_str(), nullptr, false, width - 2 * pad.x).y;
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable("##answer", chosen == i, 0, {width, high + 2 * pad.y})) pressed = i;
        ImGui::PopID();
        const ImVec2 after = ImGui::GetCursorPos();
        ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                            ImGui::GetColorU32(ImGuiCol_Border));
        ImGui::SetCursorPos({corner.x + pad.x, corner.y + pad.y});
        ImGui::PushTextWrapPos(corner.x + width - pad.x);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::SetCursorPos(after);
    }
    return pressed;
}

void write_explanation(const LessonQuestion& question, std::size_t answer) {
    if (answer >= question.why.size()) return;
    const bool is_right = answer + 1 == static_cast<std::size_t>(question.right);
    ImGui::PushStyleColor(ImGuiCol_Text, is_right ? colours().done : colours().wrong);
    write_wrapped(fmt::format("{}: {} {}", letter_of(answer),
                              is_right ? translated("Right.") : translated("Not correct."),
                              question.why[answer]));
    ImGui::PopStyleColor();
}

void draw_lesson_map(const LessonMeasures& measures) {
    if (measures.map.empty()) return;
    const float side = scaled(144), cell = side / static_cast<float>(lesson_map_side);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy({side, side});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < measures.map.size(); ++i) {
        if (measures.map[i] == 0) continue;
        const float x = at.x + cell * static_cast<float>(i % lesson_map_side);
        const float y = at.y + side - cell * static_cast<float>(1 + i / lesson_map_side);
        list.AddRectFilled({x, y}, {x + cell, y + cell}, visited_colour);
    }
    list.AddRect(at, {at.x + side, at.y + side}, map_line_colour);
    list.AddLine({at.x + side / 2, at.y}, {at.x + side / 2, at.y + side}, map_line_colour);
    list.AddLine({at.x, at.y + side / 2}, {at.x + side, at.y + side / 2}, map_line_colour);
    const auto along = [&](double angle_deg) {
        return side * static_cast<float>((angle_deg + 180) / 360);
    };
    list.AddCircleFilled({at.x + along(measures.phi_deg), at.y + side - along(measures.psi_deg)},
                         scaled(3.5F), here_colour);
    ImGui::SameLine();
    ImGui::TextDisabled("%s", fmt::format("across: φ {:+.0f}°\nup: ψ {:+.0f}°\nboth from -180° to "
                                          "180°\nblue: visited",
                                          measures.phi_deg, measures.psi_deg)
                                  .c_str());
}

void LessonCurve::add(const Reading& reading, const Vec3& place_angstrom,
                      std::uint32_t grip_number) {
    constexpr double least_way = 0.05;  // Å
    constexpr std::size_t most = 4000;
    if (start_ && grip_number != grip_number_) clear();
    if (nN_.size() >= most) {
        distance_angstrom_.clear();
        way_angstrom_.clear();
        nN_.clear();
    }
    const bool is_first = !start_;
    if (is_first) start_ = place_angstrom;
    grip_number_ = grip_number;
    if (!is_first && (place_angstrom - last_).norm() < least_way) return;
    last_ = place_angstrom;
    distance_angstrom_.push_back(reading.distance_angstrom);
    way_angstrom_.push_back((place_angstrom - *start_).norm());
    nN_.push_back(reading.molecular_nN);
}

void LessonCurve::draw(LessonPlot plot, float height) const {
    if (nN_.empty()) return;
    const bool is_way = plot == LessonPlot::Way;
    const std::vector<double>& angstrom = is_way ? way_angstrom_ : distance_angstrom_;
    const std::array lines{PlotLine{angstrom, nN_, colours().molecule, {}}};
    const std::array points{PlotPoint{angstrom.back(), nN_.back(), here_colour}};
    draw_plot("lesson force",
              {is_way ? translated("way (Å)") : translated("distance (Å)"),
               translated("force on the molecule (nN)"), range_around(angstrom, 1),
               range_around(nN_, 0.2), lines, points},
              height);
}

}  // namespace palpa
