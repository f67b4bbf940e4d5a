#include "ui/lesson_plots.h"

#include "ui/colours.h"
#include "ui/layout.h"
#include "ui/plot.h"

#include <fmt/format.h>
#include <imgui.h>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace palpa {
namespace {

constexpr ImU32 visited_colour = IM_COL32(60, 130, 210, 170);
constexpr ImU32 map_line_colour = IM_COL32(120, 120, 120, 255);
constexpr ImU32 here_colour = IM_COL32(210, 60, 40, 255);

// In the order of LessonQuantity.
struct QuantityWords {
    std::string_view name, unit;
};
constexpr std::array<QuantityWords, lesson_quantity_names.size()> quantity_words{
    {{"distance", " Å"},
     {"force on the molecule", " nN"},
     {"force on the hand", " N"},
     {"mode", ""},
     {"ripple", " N"},
     {"distance", " Å"},
     {"dihedral", "°"},
     {"hydrogen bonds", ""},
     {"cells visited", ""},
     {"way", " Å"},
     {"work", " kcal/mol"},
     {"energy", " kcal/mol"}}};

}  // namespace

std::string describe_value(const LessonStepDescription& step, double value) {
    const auto& [name, unit] = quantity_words[static_cast<std::size_t>(step.quantity)];
    std::string wanted;
    if (step.at_least) wanted = fmt::format("at least {:.4g}", *step.at_least);
    if (step.at_most)
        wanted += fmt::format("{}at most {:.4g}", step.at_least ? ", " : "", *step.at_most);
    return fmt::format("{} {:.3g}{} ({})", name, value, unit, wanted);
}

std::optional<std::size_t> draw_lesson_question(const LessonQuestion& question,
                                                std::optional<std::size_t> chosen) {
    std::optional<std::size_t> pressed;
    ImGui::TextWrapped("%s", question.text.c_str());
    for (std::size_t i = 0; i < question.answers.size(); ++i) {
        const std::string button =
            fmt::format("{}##answer", static_cast<char>('A' + static_cast<int>(i)));
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Button(button.c_str())) pressed = i;
        ImGui::PopID();
        ImGui::SameLine();
        ImGui::TextWrapped("%s", question.answers[i].c_str());
    }
    if (!chosen || *chosen >= question.why.size()) return pressed;
    const bool is_right = *chosen + 1 == static_cast<std::size_t>(question.right);
    ImGui::PushStyleColor(ImGuiCol_Text, is_right ? colours().done : colours().wrong);
    ImGui::TextWrapped("%c: %s %s", static_cast<char>('A' + static_cast<int>(*chosen)),
                       is_right ? "Right." : "Not correct.", question.why[*chosen].c_str());
    ImGui::PopStyleColor();
    return pressed;
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

void LessonCurve::add(const Reading& reading) {
    constexpr double least_way = 0.05;  // Å
    constexpr std::size_t most = 4000;
    const double way = reading.distance_angstrom;
    if (!angstrom_.empty() && std::abs(way - angstrom_.back()) < least_way) return;
    if (angstrom_.size() >= most) clear();
    angstrom_.push_back(way);
    nN_.push_back(reading.molecular_nN);
}

void LessonCurve::draw() const {
    if (angstrom_.empty()) return;
    const std::array lines{PlotLine{angstrom_, nN_, colours().molecule, {}}};
    const std::array points{PlotPoint{angstrom_.back(), nN_.back(), here_colour}};
    draw_plot("lesson force",
              {"distance (Å)", "force (nN)", range_around(angstrom_, 1), range_around(nN_, 0.2),
               lines, points},
              scaled(90) + plot_label_height(true));
}

}  // namespace palpa
