// The panel "Hand": what the hand feels, in bars and a curve, and two sliders for it.
#include "app/actions.h"
#include "app/hands.h"
#include "app/panels.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/colours.h"
#include "ui/icons.h"
#include "ui/plot.h"
#include "ui/readings.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace palpa {
namespace {

// The sign of a force on one axis says what it does; at rest it is rounding.
const char* effect_of(bool on_axis, double force) {
    constexpr double rounding = 1e-6;
    if (!on_axis || std::abs(force) < rounding) return "";
    return force > 0 ? translated(", repels") : translated(", attracts");
}

void draw_bar(const char* name, double value, double full, const std::string& text, ImU32 colour,
              const char* explanation) {
    write_wrapped(std::string(name) + ": " + text);
    tip(explanation);
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, colour);
    const auto share = static_cast<float>(full > 0 ? std::abs(value) / full : 0);
    ImGui::ProgressBar(std::isfinite(share) ? share : 1, {-1, scaled(8)}, "");
    ImGui::PopStyleColor();
    tip(explanation);
}

void draw_forces(const World& app) {
    const Readings& readings = app.resource<Readings>();
    const bool on_axis = frame_of(app).readout.contact.active_freedom == 1;
    const double hand = readings.last.hand_N, molecule = readings.last.molecular_nN;
    draw_bar(translated("force on your hand"), hand,
             app.resource<SettingsState>().now.coupling.clamp_N,
             fmt::format("{:.3f} N{}", std::abs(hand), effect_of(on_axis, hand)), colours().hand,
             translated("As sent to the device, N; the full bar is the largest force"));
    double largest = 1;
    for (const Reading& sample : readings.history.samples())
        largest = std::max(largest, std::abs(sample.molecular_nN));
    draw_bar(translated("force on the molecule"), molecule, largest,
             fmt::format("{:.4f} nN{}", std::abs(molecule), effect_of(on_axis, molecule)),
             colours().molecule,
             translated("On the molecule in hand, nN; the full bar is 1 nN or the largest force of "
                        "the last 10 s"));
}

void draw_energy(World& app) {
    const Readings& readings = app.resource<Readings>();
    std::vector<double> time, energy;
    for (const Reading& sample : readings.history.samples()) {
        time.push_back(sample.time_s);
        energy.push_back(sample.potential_kcal_per_mol);
    }
    const double now = frame_of(app).readout.contact.potential_kcal_per_mol;
    ImGui::TextUnformatted(format_translated("energy {:.2f} kcal/mol", now).c_str());
    tip(translated("Potential energy of the molecules, kcal/mol, over the last ten seconds"));
    if (time.empty()) return;
    const std::array lines{PlotLine{time, energy, colours().energy, {}}};
    const PlotRange across{time.back() - History::seconds, time.back()};
    draw_plot("energy",
              {translated("time (s)"), "kcal/mol", across, range_around(energy, 1), lines},
              scaled(90) + plot_label_height(true));
}

// How strongly the hand feels, as a multiple of the scene's setting.
double find_strength(const CouplingDescription& now, const CouplingDescription& scene) {
    if (now.feel_pN && scene.feel_pN) return (*scene.feel_pN)[0] / (*now.feel_pN)[0];
    if (now.force_law == ForceLawChoice::Perceptual && now.mode == CouplingMode::Guarded)
        return scene.F_lo_pN / now.F_lo_pN;
    return now.A_f / scene.A_f;
}

void set_strength(CouplingDescription& now, const CouplingDescription& scene, double strength) {
    if (now.feel_pN && scene.feel_pN)
        now.feel_pN = {(*scene.feel_pN)[0] / strength, (*scene.feel_pN)[1] / strength};
    now.F_lo_pN = scene.F_lo_pN / strength;
    now.F_hi_nN = scene.F_hi_nN / strength;
    now.A_f = scene.A_f * strength;
    now.A_f_max = scene.A_f_max * strength;
    now.A_f_min = scene.A_f_min * strength;
}

void draw_sliders(World& app) {
    const SettingsState& settings = app.resource<SettingsState>();
    const CouplingDescription& scene = coupling_of(scene_of(app), settings.now.hand);
    LiveSettings changed = settings.now;
    CouplingDescription& c = changed.coupling;
    const double least = 0.1, most = 10;
    ImGui::BeginDisabled(is_replay(app));
    const auto slide = [&](const char* label, double& value, const char* explanation) {
        ImGui::TextUnformatted(translated(label));
        ImGui::SetNextItemWidth(-1);
        const bool is_moved =
            ImGui::SliderScalar(fmt::format("##{}", label).c_str(), ImGuiDataType_Double, &value,
                                &least, &most, translated("%.2f times the scene's"),
                                ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
        tip(translated(explanation));
        return is_moved;
    };
    double strength = find_strength(c, scene), speed = scene.A_d / c.A_d;
    if (slide(for_translation("strength"), strength,
              for_translation("How strongly your hand feels the forces on the molecule")))
        set_strength(c, scene, strength);
    if (slide(for_translation("speed"), speed,
              for_translation("How far the molecule moves for the same way of your hand"))) {
        c.A_d = scene.A_d / speed;
        c.A_d_max = scene.A_d_max / speed;
        c.A_d_min = scene.A_d_min / speed;
    }
    ImGui::EndDisabled();
    if (!(changed == settings.now)) change_settings(app, changed);
    const Action& relax = action_called("relax");
    ImGui::BeginDisabled(!is_possible(app, relax));
    if (ImGui::Button(labelled(relax.text).c_str(), {-1, 0})) request(app, relax);
    ImGui::EndDisabled();
    tip(translated(relax.explains));
}

void draw_hand(World& app) {
    const WindowHands& hands = app.resource<WindowHands>();
    if (hands.all.size() > 1)
        ImGui::TextDisabled("%s", format_translated("{} hand: {}", name_of_hand(hands.led),
                                                    hands.held_address.empty() ? translated("empty")
                                                                               : hands.held_address)
                                      .c_str());
    draw_forces(app);
    draw_energy(app);
    ImGui::TextUnformatted(format_translated("work on your hand {:+.2f} mJ",
                                             1e3 * app.resource<Readings>().tick.hand_energy_J)
                               .c_str());
    tip(translated(
        "Energy given to the hand so far. On a path out and back it must not exceed 0."));
    ImGui::Separator();
    draw_sliders(app);
}

}  // namespace

extern const Panel hand_panel{
    .id = "hand",
    .title = for_translation("Hand"),
    .explains = for_translation("Force on the hand, energy and work; strength and speed."),
    .icon = icon_hand,
    .side = Side::Right,
    .draw = draw_hand};

}  // namespace palpa
