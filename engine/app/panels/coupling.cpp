// The panel "Coupling": the laws between molecule and hand, for those who want them.
#include "simulation/coupling.h"
#include "app/panels.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/omni.h"
#include "core/translate.h"
#include "haptics/gains.h"
#include "ui/choose.h"
#include "ui/colours.h"
#include "ui/icons.h"
#include "ui/plot.h"
#include "ui/readings.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace palpa {
namespace {

constexpr std::array<const char*, 6> mode_texts{
    for_translation("1  variable force, variable displacement"),
    for_translation("2  variable force, constant displacement"),
    for_translation("3  constant force, variable displacement"),
    for_translation("4  constant force, constant displacement"),
    for_translation("5  no force"),
    for_translation("6  guarded")};

// A range of forces on the molecule that the hand is to feel best.
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

// Names of laws and of ways to reach places in scenes, for translators.
[[maybe_unused]] constexpr std::array law_names{
    for_translation("printed"),    for_translation("calibrated"), for_translation("constant"),
    for_translation("perceptual"), for_translation("repaired"),   for_translation("clutch"),
    for_translation("bubble"),     for_translation("drift"),      for_translation("scalar"),
    for_translation("tensor")};

constexpr double touch_ratio = 50;  // of the strongest to the weakest

// Centimetres of handle travel per Å of the molecule.
double cm_per_angstrom(double displacement_gain) { return displacement_gain * 1e-8; }

void slide(const char* label, double& value, double low, double high, const char* format,
           bool logarithmic, const char* explanation) {
    ImGui::SetNextItemWidth(-scaled(75));
    ImGui::SliderScalar(
        labelled(label).c_str(), ImGuiDataType_Double, &value, &low, &high, format,
        ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
    tip(translated(explanation));
}

void choose_mode_and_period(LiveSettings& settings) {
    ImGui::SetNextItemWidth(-1);
    (void)choose("##mode", mode_texts.size(), settings.coupling.mode, [](CouplingMode mode) {
        return translated(mode_texts[static_cast<std::size_t>(mode)]);
    });
    tip(
        translated("The paper's five modes (keys 1 to 5) and guarded coupling (6), in which the 1 "
                   "kHz servo itself moves the molecule in the force field around it. The force "
                   "gain is F_h/F_m, the displacement gain A_d = dx_handle/dx_molecule."));
    int period = static_cast<int>(std::lround(settings.period_ms));
    ImGui::SetNextItemWidth(-scaled(75));
    if (ImGui::SliderInt(labelled("period").c_str(), &period, 1, 100, "%d ms",
                         ImGuiSliderFlags_Logarithmic))
        settings.period_ms = std::clamp(period, 1, 1000);
    tip(
        translated("T_s, ms: time between two simulation steps. In the paper's modes the force on "
                   "the hand is one period old and stays constant for one period: the longer the "
                   "period, the more it vibrates."));
}

// The force law and the displacement law as curves, with the present point.
void draw_curves(World& app) {
    constexpr float usual_plot = 95;  // pixels between the axes, at the usual size of text
    const SettingsState& settings = app.resource<SettingsState>();
    const Reading& last = app.resource<Readings>().last;
    const float height = scaled(usual_plot) + plot_label_height(true);
    const CouplingLaws laws = build_coupling_laws(settings.now.coupling);
    const double now_nN = last.molecular_nN;
    const PlotRange forces{std::min(-1.0, 1.1 * now_nN), std::max(3.0, 1.1 * now_nN)};
    constexpr std::size_t count = 241;
    std::vector<double> force_nN(count), hand_N(count), gain(count);
    for (std::size_t i = 0; i < count; ++i) {
        force_nN[i] =
            forces.low + (forces.high - forces.low) * static_cast<double>(i) / (count - 1);
        hand_N[i] = hand_force(laws.force, force_nN[i] * 1e-9);
        gain[i] = cm_per_angstrom(displacement_gain(laws.displacement, force_nN[i] * 1e-9));
    }
    const std::array force_lines{PlotLine{force_nN, hand_N, colours().hand, "F_h"}};
    const std::array force_points{
        PlotPoint{now_nN, hand_force(laws.force, now_nN * 1e-9), colours().now}};
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
    const double gain_now = cm_per_angstrom(
        settings.is_guarded() ? last.displacement_gain
                              : displacement_gain(laws.displacement, now_nN * 1e-9));
    const std::array gain_lines{PlotLine{force_nN, gain, colours().gain, "A_d"}};
    const std::array gain_points{PlotPoint{now_nN, gain_now, colours().now}};
    PlotRange gains = range_around(gain, 1);
    gains.low = 0;
    if (settings.is_guarded()) gains.high = std::max(gains.high, 1.1 * gain_now);
    draw_plot("displacement gain",
              {"F_m (nN)", translated("handle per molecule (cm/Å)"), forces, gains, gain_lines,
               gain_points},
              height);
    tip(translated(
        "Eq. 3: A_d = A_dmin + b [atan((|F| - F_off) g) - atan(-F_off g)]: far from other atoms a "
        "small move of the handle moves the molecule far; in contact the molecule moves slowly."));
}

void choose_touch(CouplingDescription& c, const CouplingDescription& scene) {
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
    if (ImGui::SmallButton(labelled("as the scene").c_str())) set(scene.feel_pN);
    tip(translated("the force range of the scene file, or its force law if it has no range"));
    if (!c.feel_pN) return;
    double weakest = (*c.feel_pN)[0];
    slide(for_translation("touch"), weakest, touches.front().weakest_pN, touches.back().weakest_pN,
          translated("from %.0f pN"), true,
          for_translation(
              "left: weak forces are felt; right: only strong ones; up to 50 times as strong"));
    if (weakest != (*c.feel_pN)[0]) c.feel_pN = {weakest, touch_ratio * weakest};
}

void choose_laws(CouplingDescription& c) {
    if (!ImGui::TreeNode(labelled("laws").c_str())) return;
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

void choose_range(CouplingDescription& c) {
    constexpr double lowest_pN = 1, highest_pN = 1e5, least_ratio = 1.1;
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

void draw_gain_sliders(CouplingDescription& c, const CouplingDescription& scene) {
    const bool is_guarded = c.mode == CouplingMode::Guarded;
    if (is_guarded) choose_touch(c, scene);
    if (is_guarded) choose_laws(c);
    const bool has_range = is_guarded && c.feel_pN.has_value();
    const bool is_perceptual = is_guarded && c.force_law == ForceLawChoice::Perceptual;
    const bool variable_force =
        is_guarded
            ? c.force_law == ForceLawChoice::Printed || c.force_law == ForceLawChoice::Calibrated
            : c.mode == CouplingMode::VariableForceVariableDisplacement ||
                  c.mode == CouplingMode::VariableForceConstantDisplacement;
    const bool variable_displacement =
        is_guarded ? c.displacement_law != DisplacementLawChoice::Constant
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
    if (is_guarded) choose_range(c);
}

void draw_gains_now(World& app) {
    if (!begin_readings("gains")) return;
    const SettingsState& settings = app.resource<SettingsState>();
    const Readings& readings = app.resource<Readings>();
    add_reading(translated("stiffness felt"),
                format_translated("{:.4g} of {:.4g} N/m", find_felt_stiffness(app),
                                  settings.stiffness_limit),
                translated("K = (dF_h/dF_m) k / A_d, N/m, and its limit. Guarded coupling: the "
                           "limit is the cap of the device in use, half of its stability limit; "
                           "A_d is raised until K is below it. Other modes: the limit is the "
                           "largest stable K of this hand, about B/(1.5 T_s), from the eigenvalues "
                           "for hand, device, period and delay."));
    add_reading(translated("displ. gain"),
                fmt::format("{:.2f} cm/Å", cm_per_angstrom(readings.last.displacement_gain)),
                translated("A_d = dx_handle/dx_molecule, centimetres of the handle for an Å of the "
                           "molecule; 1 cm/Å is 1e8. Eq. 3 of the paper in modes 1 and 3"));
    add_reading(translated("force gain"), fmt::format("{:.3g}", readings.tick.force_gain),
                translated("A_f = F_h/F_m, N/N"));
    if (settings.is_guarded()) {
        add_reading(
            translated("overtravel"),
            fmt::format("{:.1f} mm", 1e3 * readings.tick.overtravel_m.norm()),
            format_translated("The contact force reached {:.3g} nN (coupling.stop_nN), so the "
                              "molecule stopped. Move back by this much before it follows again.",
                              settings.now.coupling.stop_nN)
                .c_str());
        const HandTravel& travel = app.resource<WindowHands>().by_mouse().statistics.travel();
        add_reading(
            translated("travel lost"),
            format_translated("{:.1f} of {:.0f} cm", 100 * travel.lost_m, 100 * travel.handle_m),
            translated("Handle travel that the molecule will never follow, and the travel so "
                       "far. While the molecule waits for its model, up to 2 cm are kept."));
    }
    ImGui::EndTable();
}

void draw_coupling(World& app) {
    const SettingsState& settings = app.resource<SettingsState>();
    LiveSettings changed = settings.now;
    ImGui::BeginDisabled(is_replay(app));
    choose_mode_and_period(changed);
    ImGui::EndDisabled();
    draw_gains_now(app);
    draw_curves(app);
    ImGui::BeginDisabled(is_replay(app));
    draw_gain_sliders(changed.coupling, coupling_of(scene_of(app), settings.now.hand));
    ImGui::EndDisabled();
    if (!(changed == settings.now)) change_settings(app, changed);
}

}  // namespace

extern const Panel coupling_panel{
    .id = "coupling",
    .title = for_translation("Coupling"),
    .explains = for_translation(
        "The laws between molecule and hand: modes, period, gain curves and their numbers."),
    .icon = icon_sliders,
    .side = Side::Right,
    .draw = draw_coupling};

}  // namespace palpa
