// The panel at the right: the laws of the coupling, and what happened.
#include "core/omni.h"
#include "core/translate.h"
#include "haptics/gains.h"
#include "session/run_headless.h"
#include "simulation/coupling.h"
#include "ui/layout.h"
#include "ui/overlay.h"
#include "ui/plot.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace palpa {
namespace {

constexpr ImU32 molecule_colour = IM_COL32(190, 40, 40, 255);
constexpr ImU32 hand_colour = IM_COL32(20, 90, 190, 255);
constexpr ImU32 gain_colour = IM_COL32(20, 130, 70, 255);
constexpr ImU32 now_colour = IM_COL32(250, 170, 0, 255);

// What the hand is to feel best: the weakest and the strongest force on the molecule.
struct Touch {
    const char* name;
    double weakest_pN, strongest_pN;
    const char* explanation;
};
constexpr std::array touches{
    Touch{for_translation("waters"), 20, 1e3,
          for_translation("20 pN to 1 nN: dispersion and single hydrogen bonds; all strong "
                          "contacts feel the same")},
    Touch{for_translation("pockets"), 100, 5e3,
          for_translation("100 pN to 5 nN: forces that bind a ligand")},
    Touch{for_translation("walls"), 1e3, 5e4,
          for_translation(
              "1 to 50 nN: the shape of repulsive walls; hydrogen bonds are too weak to feel")}};

// What laws and ways to reach places may be called in scenes, for translators.
[[maybe_unused]] constexpr std::array law_names{
    for_translation("printed"),    for_translation("calibrated"), for_translation("constant"),
    for_translation("perceptual"), for_translation("repaired"),   for_translation("clutch"),
    for_translation("bubble"),     for_translation("drift"),      for_translation("scalar"),
    for_translation("tensor")};

template <class Names, class Choice>
const char* shown_law(const Names& names, Choice choice) {
    return translated(names[static_cast<std::size_t>(choice)].data());
}

constexpr double touch_ratio = 50;  // of the strongest to the weakest

// Pixels between the axes, at the usual size of text.
constexpr float least_plot = 70, largest_plot = 240;

}  // namespace

void Overlay::draw_right_panel(std::vector<Command>& commands) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float column = panel_column(screen.x), edge = panel_edge();
    ImGui::SetNextWindowPos({screen.x - column - edge, edge});
    ImGui::SetNextWindowSize({column, screen.y - 2 * edge});
    fold_in_small_window(right_folds_);
    const bool is_open = ImGui::Begin(labelled("Coupling").c_str(), nullptr, fixed_panel);
    right_covered_ = is_open ? column + edge : 0;
    if (is_open && ImGui::BeginTabBar("right")) {
        if (ImGui::BeginTabItem(labelled("gains").c_str())) {
            ImGui::BeginDisabled(is_replay_);
            draw_gains(commands);
            ImGui::EndDisabled();
            ImGui::EndTabItem();
        }
        if (ImGui::BeginTabItem(labelled("over time").c_str())) {
            draw_over_time();
            ImGui::EndTabItem();
        }
        if (ImGui::BeginTabItem(labelled("over separation").c_str())) {
            draw_over_separation();
            ImGui::EndTabItem();
        }
        ImGui::EndTabBar();
    }
    ImGui::End();
}

void Overlay::draw_gains(std::vector<Command>& commands) {
    // The curves have what the sliders leave.
    const float left = ImGui::GetContentRegionAvail().y - sliders_height_;
    const float labels = plot_label_height(true);
    plot_height_ = std::clamp(0.5F * left - ImGui::GetStyle().ItemSpacing.y - labels,
                              scaled(least_plot), scaled(largest_plot));
    const float height = plot_height_ + labels;
    const CouplingLaws laws = build_coupling_laws(settings_.coupling);
    const double now_nN = last_.molecular_nN;
    const PlotRange forces{std::min(-1.0, 1.1 * now_nN), std::max(3.0, 1.1 * now_nN)};
    constexpr int count = 241;
    x_.resize(count);
    y_.resize(count);
    z_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        x_[i] = forces.low + (forces.high - forces.low) * static_cast<double>(i) / (count - 1);
        y_[i] = hand_force(laws.force, x_[i] * 1e-9);
        z_[i] = cm_per_angstrom(displacement_gain(laws.displacement, x_[i] * 1e-9));
    }
    const std::array force_lines{PlotLine{x_, y_, hand_colour, "F_h"}};
    const std::array force_points{
        PlotPoint{now_nN, hand_force(laws.force, now_nN * 1e-9), now_colour}};
    draw_plot("force gain",
              {"F_m (nN)",
               translated("force on the hand (N)"),
               forces,
               {-3.2, 3.2},
               force_lines,
               force_points},
              height);
    tip(
        translated("Eq. 2: F_h = a1 atan(d1 F) + a2 [atan(d2 (F - F_0)) + atan(d2 (F + F_0))]; the "
                   "point shows the present force. The curve is steep for weak forces and flat for "
                   "strong ones, without clipping."));
    const std::array gain_lines{PlotLine{x_, z_, gain_colour, "A_d"}};
    const std::array gain_points{PlotPoint{
        now_nN,
        cm_per_angstrom(is_guarded() ? last_.displacement_gain
                                     : displacement_gain(laws.displacement, now_nN * 1e-9)),
        now_colour}};
    PlotRange gains = range_around(z_, 1);
    gains.low = 0;
    if (is_guarded())
        gains.high = std::max(gains.high, 1.1 * cm_per_angstrom(last_.displacement_gain));
    draw_plot("displacement gain",
              {"F_m (nN)", translated("handle per molecule (cm/Å)"), forces, gains, gain_lines,
               gain_points},
              height);
    tip(translated(
        "Eq. 3: A_d = A_dmin + b [atan((|F| - F_off) g) - atan(-F_off g)]: far from other atoms a "
        "small move of the handle moves the molecule far; in contact the molecule moves slowly."));
    const LiveSettings before = settings_;
    const float top = ImGui::GetCursorPosY();
    draw_gain_sliders();
    sliders_height_ = ImGui::GetCursorPosY() - top;
    if (!(settings_ == before)) change_settings(settings_, commands);
}

void Overlay::slide(const char* label, double& value, double low, double high, const char* format,
                    bool logarithmic, const char* explanation) {
    ImGui::SetNextItemWidth(-scaled(75));
    ImGui::SliderScalar(
        labelled(label).c_str(), ImGuiDataType_Double, &value, &low, &high, format,
        ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
    tip(translated(explanation));
}

void Overlay::draw_gain_sliders() {
    CouplingDescription& c = settings_.coupling;
    if (is_guarded()) choose_touch();
    if (is_guarded()) choose_laws();
    const bool has_range = is_guarded() && c.feel_pN.has_value();
    const bool is_perceptual = is_guarded() && c.force_law == ForceLawChoice::Perceptual;
    const bool variable_force =
        is_guarded()
            ? c.force_law == ForceLawChoice::Printed || c.force_law == ForceLawChoice::Calibrated
            : c.mode == CouplingMode::VariableForceVariableDisplacement ||
                  c.mode == CouplingMode::VariableForceConstantDisplacement;
    const bool variable_displacement =
        is_guarded() ? c.displacement_law != DisplacementLawChoice::Constant
                     : c.mode == CouplingMode::VariableForceVariableDisplacement ||
                           c.mode == CouplingMode::ConstantForceVariableDisplacement;
    if (has_range) {
        // Its sliders stand below.
    } else if (is_perceptual) {
        slide(
            "F_lo", c.F_lo_pN, 1, 1000, "%.0f pN", true,
            for_translation("molecular force that is felt as 0.3 N, pN; the law is linear below"));
        slide(
            "F_hi", c.F_hi_nN, 0.1, 100, "%.2f nN", true,
            for_translation(
                "molecular force that is felt as 3 N, nN; between, equally many noticeable steps a "
                "decade"));
        c.F_hi_nN = std::max(c.F_hi_nN, 2.1e-3 * c.F_lo_pN);
    } else if (variable_force) {
        slide("A_f max", c.A_f_max, 0.1e9, 50e9, "%.3g", true,
              for_translation(
                  "A_fmax of eq. 2: gain of weak forces, N on the hand per N on the molecule"));
        slide("A_f min", c.A_f_min, 0.01e9, 5e9, "%.3g", true,
              for_translation("A_fmin of eq. 2: gain of strong forces, N/N"));
        slide("F_h1", c.F_h1_N, 0.1, 2.9, "%.2f N", false,
              for_translation("F_h1 of eq. 2, N: limit of the part of the curve for weak forces"));
        slide("F_h2", c.F_h2_N, 0.2, omni_peak_newton, "%.2f N", false,
              for_translation(
                  "F_h2 of eq. 2, N: limit for the strongest forces; must be above F_h1"));
        slide("F_0", c.F_0_nN, 0.0, 10, "%.2f nN", false,
              for_translation("F_0 of eq. 2, nN: molecular force between weak and strong"));
        c.F_h2_N = std::max(c.F_h2_N, 1.05 * c.F_h1_N);
        c.A_f_max = std::max(c.A_f_max, c.A_f_min);
    } else if (c.mode != CouplingMode::NoForce) {
        slide("A_f", c.A_f, 0.01e9, 50e9, "%.3g", true,
              for_translation("constant force gain F_h/F_m, N/N"));
    }
    if (variable_displacement) {
        slide("A_d max", c.A_d_max, 0.01e9, 10e9, "%.3g", true,
              for_translation("A_dmax of eq. 3: handle metres per molecule metre in contact"));
        slide("A_d min", c.A_d_min, 0.0005e9, 1e9, "%.3g", true,
              for_translation("A_dmin of eq. 3: handle metres per molecule metre far away"));
        slide("F_off", c.F_off_pN, 1, 500, "%.0f pN", true,
              for_translation("F_off of eq. 3, pN: molecular force at which contact begins"));
        c.A_d_max = std::max(c.A_d_max, c.A_d_min);
    } else {
        slide("A_d", c.A_d, 0.005e9, 10e9, "%.3g", true,
              for_translation("constant displacement gain, handle metres per molecule metre; "
                              "0.25e9 is 2.5 cm/Å"));
    }
    if (is_guarded()) choose_range();
}

// The range that is felt, for who knows no gains.
void Overlay::choose_touch() {
    CouplingDescription& c = settings_.coupling;
    if (c.clamp_N < truncation_newton) return;
    const auto set = [&](const std::optional<std::array<double, 2>>& range) { c.feel_pN = range; };
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(translated("feel"));
    for (const Touch& touch : touches) {
        same_line_if_it_fits(translated(touch.name));
        if (ImGui::SmallButton(labelled(touch.name).c_str()))
            set({{touch.weakest_pN, touch.strongest_pN}});
        tip(translated(touch.explanation));
    }
    same_line_if_it_fits(translated("as the scene"));
    if (ImGui::SmallButton(labelled("as the scene").c_str())) set(coupling_of(scene_, 0).feel_pN);
    tip(translated("the force range of the scene file, or its force law if it has no range"));
    if (!c.feel_pN) return;
    double weakest = (*c.feel_pN)[0];
    slide(for_translation("touch"), weakest, touches.front().weakest_pN, touches.back().weakest_pN,
          translated("from %.0f pN"), true,
          for_translation(
              "left: weak forces are felt; right: only strong ones; up to 50 times as strong"));
    if (weakest != (*c.feel_pN)[0]) c.feel_pN = {weakest, touch_ratio * weakest};
}

void Overlay::choose_laws() {
    CouplingDescription& c = settings_.coupling;
    const std::string laws =
        format_translated("laws: {}, {}, {}", shown_law(force_law_names, c.force_law),
                          shown_law(displacement_law_names, c.displacement_law),
                          shown_law(workspace_names, c.workspace)) +
        "###laws";
    if (!ImGui::TreeNode(laws.c_str())) return;
    const auto choose = [&](const char* label, const auto& names, auto& choice, const char* text) {
        int i = static_cast<int>(choice);
        std::vector<const char*> items;
        for (const std::string_view name : names) items.push_back(translated(name.data()));
        ImGui::SetNextItemWidth(-scaled(75));
        if (ImGui::Combo(labelled(label).c_str(), &i, items.data(), static_cast<int>(items.size())))
            choice = static_cast<std::remove_reference_t<decltype(choice)>>(i);
        tip(translated(text));
    };
    choose(
        for_translation("force"), force_law_names, c.force_law,
        for_translation("force law: eq. 2 as printed; eq. 2 calibrated to its slopes; a constant "
                        "gain; or equally many noticeable steps for each decade of force"));
    choose(for_translation("travel"), displacement_law_names, c.displacement_law,
           for_translation("displacement law: eq. 3 with the stiffness included; eq. 3 as printed; "
                           "or a constant gain"));
    choose(for_translation("raised"), gain_shape_names, c.gain_shape,
           for_translation(
               "directions in which A_d is raised to keep the stiffness cap: all (scalar), or only "
               "the stiff ones (tensor), so that the molecule slides faster along a wall"));
    choose(for_translation("reach"), workspace_names, c.workspace,
           for_translation("how to reach distant places: with the clutch only; outside a bubble "
                           "the molecule continues to move (rate control); or the handle drifts "
                           "back to its centre while it moves"));
    ImGui::TreePop();
}

void Overlay::choose_range() {
    constexpr double lowest_pN = 1, highest_pN = 1e5, least_ratio = 1.1;
    CouplingDescription& c = settings_.coupling;
    bool has_range = c.feel_pN.has_value();
    if (c.clamp_N >= truncation_newton &&
        ImGui::Checkbox(labelled("feel a range").c_str(), &has_range)) {
        c.feel_pN.reset();
        if (has_range) c.feel_pN = {c.F_lo_pN, 1e3 * c.F_hi_nN};
    }
    tip(
        translated("a range of molecular forces in place of a force law: the weakest is felt as "
                   "0.3 N, the strongest as 2.7 N"));
    if (c.feel_pN) {
        auto& [weakest, strongest] = *c.feel_pN;
        slide(for_translation("weakest"), weakest, lowest_pN, highest_pN, "%.0f pN", true,
              for_translation("molecular force that is felt as 0.3 N or more"));
        slide(for_translation("strongest"), strongest, lowest_pN, highest_pN, "%.0f pN", true,
              for_translation("molecular force that is felt as 2.7 N"));
        strongest = std::max(strongest, least_ratio * weakest);
    }
    if (c.feel_within_pN) {
        slide(for_translation("within"), *c.feel_within_pN, lowest_pN, highest_pN, "%.0f pN", true,
              for_translation("error limit of the force against complete relaxation; the number of "
                              "active joints follows from it"));
    }
}

// Three plots, one below the other, over what `x_` holds.
void Overlay::draw_traces(std::string_view x_label, PlotRange across) {
    const float labels = plot_label_height(true) + 2 * plot_label_height(false);
    const float gaps = 3 * ImGui::GetStyle().ItemSpacing.y;
    plot_height_ =
        std::max((ImGui::GetContentRegionAvail().y - labels - gaps) / 3, scaled(least_plot));
    const auto draw = [&](const char* id, std::string_view label, std::string_view y_label,
                          double least, ImU32 colour, double (*value)(const Reading&)) {
        fill_from_history(y_, value);
        const std::array lines{PlotLine{x_, y_, colour, {}}};
        std::array points{PlotPoint{}};
        if (!x_.empty()) points[0] = {x_.back(), y_.back(), now_colour};
        draw_plot(id,
                  {label, y_label, across, range_around(y_, least), lines,
                   x_.empty() ? std::span<const PlotPoint>() : points},
                  plot_height_ + plot_label_height(!label.empty()));
    };
    draw("F_m", "", translated("force on the molecule, F_m (nN)"), 0.2, molecule_colour,
         [](const Reading& r) { return r.molecular_nN; });
    tip(translated("nN; on one axis + repels and - attracts"));
    draw("F_h", "", translated("force on the hand, F_h (N)"), 0.5, hand_colour,
         [](const Reading& r) { return r.hand_N; });
    tip(translated("N, as sent to the device"));
    draw("A_d", x_label, translated("displacement gain, A_d (cm/Å)"), 0.2, gain_colour,
         [](const Reading& r) { return cm_per_angstrom(r.displacement_gain); });
    tip(translated("A_d = dx_handle/dx_molecule; 1 cm/Å is 1e8"));
}

void Overlay::draw_over_time() {
    fill_from_history(x_, [](const Reading& r) { return r.time_s; });
    const double now = x_.empty() ? 0 : x_.back();
    draw_traces(translated("time (s)"), {now - History::seconds, now + 0.02 * History::seconds});
}

void Overlay::draw_over_separation() {
    fill_from_history(x_, [](const Reading& r) { return r.distance_angstrom; });
    draw_traces(translated("separation (Å)"), range_around(x_, 1));
}

void Overlay::fill_from_history(std::vector<double>& values, double (*value)(const Reading&)) {
    values.clear();
    for (const Reading& sample : history_.samples()) values.push_back(value(sample));
}

}  // namespace palpa
