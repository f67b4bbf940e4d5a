#include "ui/overlay.h"

#include "haptics/gains.h"
#include "haptics/hand.h"
#include "session/run_headless.h"
#include "simulation/simulation.h"
#include "ui/plot.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpa {
namespace {

constexpr float edge = 10;  // pixels around the panels
constexpr ImU32 molecule_colour = IM_COL32(190, 40, 40, 255);
constexpr ImU32 hand_colour = IM_COL32(20, 90, 190, 255);
constexpr ImU32 gain_colour = IM_COL32(20, 130, 70, 255);
constexpr ImU32 now_colour = IM_COL32(250, 170, 0, 255);
constexpr ImGuiWindowFlags fixed_window =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings;

constexpr std::array<const char*, 6> mode_texts{"1  variable force, variable displacement",
                                                "2  variable force, constant displacement",
                                                "3  constant force, variable displacement",
                                                "4  constant force, constant displacement",
                                                "5  no force",
                                                "6  guarded"};

// Width of the panels at either side of a window that wide.
float column_of(float window_width) { return std::clamp(0.3F * window_width, 240.0F, 350.0F); }

void tip(const char* text) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(360);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

// One line of the readings: a name, a value, and what it is when the mouse rests on it.
void reading(const char* name, const std::string& value, const char* explanation) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    tip(explanation);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(value.c_str());
    tip(explanation);
}

void switch_sound(const OverlayStatus& status, std::vector<Action>& actions) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted("sound");
    tip("S. The force on the hand as a tone: higher and louder is stronger, nothing is silence. "
        "The "
        "choice is remembered.");
    ImGui::TableNextColumn();
    bool sounds = status.sounds;
    if (ImGui::Checkbox("force as a tone", &sounds)) actions.push_back(Action::ToggleSound);
}

// Centimetres that the handle goes for one Å of the molecule.
double cm_per_angstrom(double displacement_gain) { return displacement_gain * 1e-8; }

// The spring that the hand feels at this moment (N/m), at most, in the paper's modes.
double felt_stiffness(const CouplingLaws& laws, const TouchModel& touch) {
    return largest_felt(laws.force, touch.force_newton, touch.stiffness_matrix_N_per_m) /
           displacement_gain(laws.displacement, touch.force_newton.norm());
}

}  // namespace

Overlay::Overlay(const SceneDescription& scene)
    : scene_(scene),
      settings_{scene.coupling, scene.period_ms},
      before_edit_(settings_),
      lesson_(scene.lesson) {
    update_limit();
}

void Overlay::update_limit() {
    const auto delay_ticks = static_cast<int>(scene_.device.servo_delay_ticks);
    stiffness_limit_ = is_guarded()
                           ? guarded_cap(scene_.device.viscosity_N_s_per_m,
                                         guarded_damping(settings_.coupling.damping_N_s_per_m,
                                                         scene_.device.inertia_kg, delay_ticks),
                                         delay_ticks)
                           : calm_stiffness(scene_, hand_model(static_cast<Grip>(scene_.hand.grip)),
                                            settings_.period_ms * 1e-3);
}

void Overlay::add_tick(const ServoTick& tick) {
    const Reading reading = read_tick(tick);
    if (has_tick_ && reading.time_s == last_.time_s) return;  // paused: no time passed
    has_tick_ = true;
    last_ = reading;
    if (tick.touch.active_freedom == 1) {
        const double side = tick.touch.molecule.place_angstrom.x();
        if (side_ == 0) side_ = side;
        went_through_ = side * side_ < 0;
    }
    clamped_ = tick.clamped;
    stopped_ = tick.stopped;
    stage_ = tick.stage;
    reason_ = tick.reason;
    felt_N_per_m_ = tick.felt_N_per_m;
    raised_ = tick.raised;
    hand_energy_J_ = tick.hand_energy_J;
    kept_m_ = tick.kept_m.norm();
    force_gain_ = tick.force_gain;
    history_.add(last_);
    lesson_.update(last_, settings_.coupling.mode);
}

void Overlay::change_settings(const LiveSettings& settings, std::vector<Command>& commands) {
    settings_ = settings;
    update_limit();
    commands.emplace_back(settings_);
}

void Overlay::set_mode(CouplingMode mode, std::vector<Command>& commands) {
    if (settings_.coupling.mode == mode) return;
    undo_.push_back(settings_);
    redo_.clear();
    LiveSettings settings = settings_;
    settings.coupling.mode = mode;
    change_settings(settings, commands);
}

bool Overlay::perform(Action action, std::vector<Command>& commands) {
    const auto go_back = [&](std::vector<LiveSettings>& from, std::vector<LiveSettings>& to) {
        if (from.empty()) return;
        to.push_back(settings_);
        const LiveSettings settings = from.back();
        from.pop_back();
        change_settings(settings, commands);
    };
    switch (action) {
        case Action::PauseOrGo:
            wants_pause_ = !wants_pause_;
            commands.emplace_back(Pause{wants_pause_});
            return true;
        case Action::StepOnce:
            wants_pause_ = true;
            commands.emplace_back(StepOnce{});
            return true;
        case Action::Reset:
            commands.emplace_back(Reset{});
            return true;
        case Action::Mode1:
        case Action::Mode2:
        case Action::Mode3:
        case Action::Mode4:
        case Action::Mode5:
        case Action::Guarded: {
            const int mode = static_cast<int>(action) - static_cast<int>(Action::Mode1);
            set_mode(static_cast<CouplingMode>(mode), commands);
            return true;
        }
        case Action::Undo:
            go_back(undo_, redo_);
            return true;
        case Action::Redo:
            go_back(redo_, undo_);
            return true;
        case Action::ToggleOverlay:
            shows_overlays_ = !shows_overlays_;
            return true;
        case Action::ToggleLesson:
            shows_lesson_ = !shows_lesson_;
            return true;
        case Action::ToggleHelp:
            shows_help_ = !shows_help_;
            return true;
        default:
            return false;
    }
}

bool Overlay::is_shaking(const Readout& readout) const {
    if (is_guarded()) return false;
    const CouplingLaws laws = build_coupling_laws(settings_.coupling);
    return felt_stiffness(laws, readout.touch) > stiffness_limit_;
}

float Overlay::covered_pixels(float window_width) const noexcept {
    const float covered = column_of(window_width) + edge;
    return shows_overlays_ && window_width > 2.5F * covered ? covered : 0;
}

void Overlay::draw(const Readout& readout, const OverlayStatus& status,
                   std::vector<Command>& commands, std::vector<Action>& actions) {
    if (shows_overlays_) {
        draw_scene(readout, status, commands, actions);
        draw_gains(commands);
        draw_history();
    }
    if (shows_lesson_ && !lesson_.steps().empty()) draw_lesson();
    draw_warnings(readout, status);
    if (shows_help_) draw_help();
}

void Overlay::draw_scene(const Readout& readout, const OverlayStatus& status,
                         std::vector<Command>& commands, std::vector<Action>& actions) {
    ImGui::SetNextWindowPos({edge, edge});
    ImGui::SetNextWindowSize({column_of(ImGui::GetIO().DisplaySize.x), 0});
    ImGui::Begin(fmt::format("{}###scene", scene_.title).c_str(), nullptr, fixed_window);
    if (!scene_.about.empty() && ImGui::CollapsingHeader("About")) {
        ImGui::TextWrapped("%s", scene_.about.c_str());
    }
    if (ImGui::Button(readout.paused ? "Go on" : "Pause")) actions.push_back(Action::PauseOrGo);
    tip("P. While paused nothing moves, and the hand feels nothing.");
    ImGui::SameLine();
    if (ImGui::Button("Step")) actions.push_back(Action::StepOnce);
    tip("Full stop key. One step of the simulation, then pause.");
    ImGui::SameLine();
    if (ImGui::Button("Reset")) actions.push_back(Action::Reset);
    tip("R. The molecules go back to their start; the settings stay.");
    ImGui::SameLine();
    if (ImGui::Button("Screenshot")) actions.push_back(Action::Screenshot);
    tip("F12");
    ImGui::SameLine();
    if (ImGui::Button("Keys")) actions.push_back(Action::ToggleHelp);
    tip("H");

    ImGui::SetNextItemWidth(-1);
    const auto mode = static_cast<std::size_t>(settings_.coupling.mode);
    if (ImGui::BeginCombo("##mode", mode_texts[mode])) {
        for (std::size_t i = 0; i < mode_texts.size(); ++i) {
            if (ImGui::Selectable(mode_texts[i], i == mode)) {
                set_mode(static_cast<CouplingMode>(i), commands);
            }
        }
        ImGui::EndCombo();
    }
    tip("The paper's five modes, keys 1 to 5, and guarded coupling, 6: there the servo moves the "
        "molecule itself, in the field around it, a thousand times a second. The force gain is "
        "F_h/F_m, the displacement gain A_d = dx_handle/dx_molecule.");
    int period = static_cast<int>(std::lround(settings_.period_ms));
    const LiveSettings before = settings_;
    ImGui::SetNextItemWidth(-90);
    if (ImGui::SliderInt("period", &period, 1, 100, "%d ms", ImGuiSliderFlags_Logarithmic)) {
        LiveSettings settings = settings_;
        settings.period_ms = std::clamp(period, 1, 1000);
        change_settings(settings, commands);
    }
    remember_edit(before);
    tip("T_s, ms: how often the simulation answers the hand. In the paper's modes the hand feels a "
        "force that is one period old, and held for one: the longer, the more it vibrates.");
    draw_readings(readout, status, actions);
    ImGui::End();
}

void Overlay::draw_readings(const Readout& readout, const OverlayStatus& status,
                            std::vector<Action>& actions) {
    if (!ImGui::BeginTable("readings", 2)) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, 115);
    const CouplingLaws laws = build_coupling_laws(settings_.coupling);
    const TouchModel& touch = readout.touch;
    const bool on_axis = touch.active_freedom == 1;
    reading("separation", fmt::format("{:.3f} Å", last_.distance_angstrom),
            "Distance of the reference atoms, Å");
    reading("force, molecule", fmt::format("{:+.4g} nN", last_.molecular_nN),
            on_axis ? "F_m, nN, on the molecule in hand; + repels, - attracts"
                    : "|F_m|, nN, on the molecule in hand");
    reading("force, hand", fmt::format("{:+.3f} N", last_.hand_N),
            "F_h = f(F_m), N, as sent to the device; eq. 2 of the paper in modes 1 and 2");
    if (!on_axis) {
        reading(
            "torque",
            fmt::format("{:.3g} nN Å, not played", 1e19 * touch.torque_newton_metre.norm()),
            "on the molecule in hand about its centre of mass; no motor plays it, so a molecule "
            "that is turned between the way in and the way out can give the hand energy");
    }
    reading("force gain", fmt::format("{:.3g}", force_gain_), "A_f = F_h/F_m, N/N");
    reading("displ. gain",
            fmt::format("{:.3g}  ({:.2f} cm/Å)", last_.displacement_gain,
                        cm_per_angstrom(last_.displacement_gain)),
            "A_d = dx_handle/dx_molecule, m/m; eq. 3 of the paper in modes 1 and 3");
    const double felt = is_guarded() ? felt_N_per_m_ : felt_stiffness(laws, touch);
    reading("spring felt",
            fmt::format("{:.4g} of {:.4g} N/m, {:.0f} % left", felt, stiffness_limit_,
                        100 * std::max(0.0, 1 - felt / stiffness_limit_)),
            "K = (dF_h/dF_m) k / A_d, N/m. Guarded: of the cap, half of what the device keeps "
            "calm; A_d "
            "is raised until it holds. Else of the largest K that the hand keeps calm: about "
            "B/(1.5 T_s), found from the eigenvalues of hand, device, period and delay");
    reading(
        "work on hand", fmt::format("{:+.2f} mJ", 1e3 * hand_energy_J_),
        "energy given to the hand so far, mJ: over a way there and back it should not be above 0");
    if (is_guarded()) {
        reading("held back", fmt::format("{:.1f} mm", 1e3 * kept_m_),
                "handle travel that the molecule did not follow, since an atom would be pushed too "
                "hard (coupling.stop_nN); it is felt, and has to be given back");
    }
    draw_exactness(readout);
    reading("energy", fmt::format("{:.3f} kcal/mol", touch.potential_kcal_per_mol),
            "of the molecule in hand with all others: Lennard-Jones and Coulomb, kcal/mol");
    reading("moving",
            fmt::format("{} degree{} of freedom", touch.active_freedom, on_axis ? "" : "s"),
            "degrees of freedom that a step may move");
    reading("hand", std::string(hand_names[scene_.hand.grip]),
            "the grip on the emulated handle; hand.grip of the scene");
    if (status.devices.empty()) {
        reading("device", status.device_name, "what the force is sent to, 1000 times a second");
    } else {
        choose_device(status);
    }
    switch_sound(status, actions);
    reading("step", fmt::format("{:.3f} ms of {} ms", readout.step_ms, settings_.period_ms),
            "wall time of the last simulation step, and the declared period");
    reading("drawing", fmt::format("{:.1f} ms, scale {:.2f}", status.frame_ms, status.render_scale),
            "time of a frame; the scale is lowered where the machine cannot hold 30 Hz");
    reading("servo",
            fmt::format("{} skipped{}", status.servo.overruns,
                        !status.servo.real_time ? ", ordinary priority"
                        : !status.servo.locked  ? ", memory not locked"
                                                : ""),
            "servo ticks that were skipped because the system was late. Without real-time priority "
            "or locked memory that happens more often: allow rtprio 50 and memlock for yourself in "
            "/etc/security/limits.conf.");
    ImGui::EndTable();
    ImGui::TextDisabled("%s", status.gpu_name.c_str());
}

void Overlay::choose_device(const OverlayStatus& status) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted("device");
    tip("What the force is sent to, 1000 times a second. D takes the next one that is there. The "
        "choice is remembered; a device that was unplugged is taken again when it is back.");
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##device", status.device_name.c_str())) return;
    for (const DeviceOffer& offer : status.devices) {
        const std::string text =
            fmt::format("{}{}", offer.name, offer.is_there ? "" : " (not seen)");
        if (ImGui::Selectable(text.c_str(), offer.name == status.device)) device_ = offer.name;
        tip(offer.summary.c_str());
    }
    ImGui::EndCombo();
}

void Overlay::draw_exactness(const Readout& readout) {
    const CouplingDescription& c = settings_.coupling;
    if (const auto range = c.feel_pN; range && is_guarded()) {
        reading("to be felt",
                fmt::format("{:.4g} to {:.4g} pN, A_d x {:.2f}", (*range)[0], (*range)[1], raised_),
                "molecular forces that are felt as 0.3 N or more and 2.7 N or less, and how much "
                "A_d is raised at this moment so that the spring felt stays under its cap: by so "
                "much less the molecule goes");
    }
    if (const auto within_pN = c.feel_within_pN; within_pN && readout.effort.steps > 0) {
        const std::string error =
            readout.error_pN ? fmt::format("{:.3g}", *readout.error_pN) : std::string("?");
        reading("exact to",
                fmt::format("{} of {:.4g} pN{}, {} active", error, *within_pN,
                            readout.error_pN.value_or(0) > *within_pN ? ", gives way" : "",
                            readout.effort.active),
                "how far nine of ten forces are, at most, from what all joints would give, as "
                "found on a copy now and then, of what is asked; and how many degrees of freedom "
                "are wanted for it. Where the period leaves no time for more, the force is less "
                "exact than asked.");
    }
}

void Overlay::draw_gains(std::vector<Command>& commands) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float column = column_of(screen.x);
    ImGui::SetNextWindowPos({screen.x - column - edge, edge});
    ImGui::SetNextWindowSize({column, 0});
    ImGui::Begin("Gains", nullptr, fixed_window);
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
              {"F_m (nN)", "force on the hand (N)", forces, {-3.2, 3.2}, force_lines, force_points},
              125);
    tip("Eq. 2: F_h = a1 atan(d1 F) + a2 [atan(d2 (F - F_0)) + atan(d2 (F + F_0))]; the point is "
        "where you are. Steep for weak forces, flat for strong ones, never cut off.");
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
              {"F_m (nN)", "handle per molecule (cm/Å)", forces, gains, gain_lines, gain_points},
              118);
    tip("Eq. 3: A_d = A_dmin + b [atan((|F| - F_off) g) - atan(-F_off g)]: far from everything the "
        "molecule goes far for a little travel of the handle, in contact it goes slowly.");
    const LiveSettings before = settings_;
    draw_gain_sliders();
    if (!(settings_ == before)) change_settings(settings_, commands);
    gains_bottom_ = ImGui::GetWindowPos().y + ImGui::GetWindowHeight();
    ImGui::End();
}

void Overlay::slide(const char* label, double& value, double low, double high, const char* format,
                    bool logarithmic, const char* explanation) {
    ImGui::SetNextItemWidth(-80);
    const LiveSettings before = settings_;
    ImGui::SliderScalar(
        label, ImGuiDataType_Double, &value, &low, &high, format,
        ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
    remember_edit(before);
    tip(explanation);
}

void Overlay::remember_edit(const LiveSettings& before) {
    if (ImGui::IsItemActivated()) before_edit_ = before;
    if (!ImGui::IsItemDeactivatedAfterEdit()) return;
    undo_.push_back(before_edit_);
    redo_.clear();
}

void Overlay::draw_gain_sliders() {
    CouplingDescription& c = settings_.coupling;
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
        slide("F_lo", c.F_lo_pN, 1, 1000, "%.0f pN", true,
              "molecular force that is felt as 0.3 N, pN; the law is linear below");
        slide("F_hi", c.F_hi_nN, 0.1, 100, "%.2f nN", true,
              "molecular force that is felt as 3 N, nN; between, equally many noticeable steps a "
              "decade");
        c.F_hi_nN = std::max(c.F_hi_nN, 2.1e-3 * c.F_lo_pN);
    } else if (variable_force) {
        slide("A_f max", c.A_f_max, 0.1e9, 50e9, "%.3g", true,
              "A_fmax of eq. 2: gain of weak forces, N on the hand per N on the molecule");
        slide("A_f min", c.A_f_min, 0.01e9, 5e9, "%.3g", true,
              "A_fmin of eq. 2: gain of strong forces, N/N");
        slide("F_h1", c.F_h1_N, 0.1, 2.9, "%.2f N", false,
              "F_h1 of eq. 2, N: where the weak forces' part of the curve tends to");
        slide("F_h2", c.F_h2_N, 0.2, 3.3, "%.2f N", false,
              "F_h2 of eq. 2, N: where the strongest forces tend to; above F_h1");
        slide("F_0", c.F_0_nN, 0.0, 10, "%.2f nN", false,
              "F_0 of eq. 2, nN: between weak and strong forces");
        c.F_h2_N = std::max(c.F_h2_N, 1.05 * c.F_h1_N);
        c.A_f_max = std::max(c.A_f_max, c.A_f_min);
    } else if (c.mode != CouplingMode::NoForce) {
        slide("A_f", c.A_f, 0.01e9, 50e9, "%.3g", true, "constant force gain F_h/F_m, N/N");
    }
    if (variable_displacement) {
        slide("A_d max", c.A_d_max, 0.01e9, 10e9, "%.3g", true,
              "A_dmax of eq. 3: handle metres per molecule metre in contact");
        slide("A_d min", c.A_d_min, 0.0005e9, 1e9, "%.3g", true,
              "A_dmin of eq. 3: handle metres per molecule metre far away");
        slide("F_off", c.F_off_pN, 1, 500, "%.0f pN", true,
              "F_off of eq. 3, pN: molecular force where near begins");
        c.A_d_max = std::max(c.A_d_max, c.A_d_min);
    } else {
        slide("A_d", c.A_d, 0.005e9, 10e9, "%.3g", true,
              "constant displacement gain, handle metres per molecule metre; 0.25e9 is 2.5 cm/Å");
    }
    if (is_guarded()) choose_range();
}

void Overlay::choose_laws() {
    CouplingDescription& c = settings_.coupling;
    const std::string laws = fmt::format(
        "laws: {}, {}, {}###laws", force_law_names[static_cast<std::size_t>(c.force_law)],
        displacement_law_names[static_cast<std::size_t>(c.displacement_law)],
        workspace_names[static_cast<std::size_t>(c.workspace)]);
    if (!ImGui::TreeNode(laws.c_str())) return;
    const auto choose = [&](const char* label, const auto& names, auto& choice, const char* text) {
        const LiveSettings before = settings_;
        int i = static_cast<int>(choice);
        std::vector<const char*> items;
        for (const std::string_view name : names) items.push_back(name.data());
        ImGui::SetNextItemWidth(-80);
        if (ImGui::Combo(label, &i, items.data(), static_cast<int>(items.size()))) {
            undo_.push_back(before);
            redo_.clear();
            choice = static_cast<std::remove_reference_t<decltype(choice)>>(i);
        }
        tip(text);
    };
    choose("force", force_law_names, c.force_law,
           "force law: eq. 2 as printed, or calibrated to its slopes, a constant gain, or equal "
           "noticeable steps for each decade");
    choose("travel", displacement_law_names, c.displacement_law,
           "displacement law: eq. 3 that sees stiff places too, as printed, or a constant gain");
    choose("raised", gain_shape_names, c.gain_shape,
           "where A_d is raised for the cap: in all directions, or, a tensor, in those that are "
           "stiff, so that sliding along a wall goes faster");
    choose("reach", workspace_names, c.workspace,
           "how far places are reached: the clutch alone; outside a bubble the molecule goes on by "
           "itself; or the handle drifts back to its centre while it moves");
    ImGui::TreePop();
}

void Overlay::choose_range() {
    constexpr double lowest_pN = 1, highest_pN = 1e5, least_ratio = 1.1, least_clamp_newton = 3;
    CouplingDescription& c = settings_.coupling;
    const LiveSettings before = settings_;
    bool has_range = c.feel_pN.has_value();
    if (c.clamp_N >= least_clamp_newton && ImGui::Checkbox("feel a range", &has_range)) {
        undo_.push_back(before);
        redo_.clear();
        c.feel_pN.reset();
        if (has_range) c.feel_pN = {c.F_lo_pN, 1e3 * c.F_hi_nN};
    }
    tip("what must be felt, in place of a force law: the weakest force as 0.3 N, the strongest as "
        "2.7 N");
    if (c.feel_pN) {
        auto& [weakest, strongest] = *c.feel_pN;
        slide("weakest", weakest, lowest_pN, highest_pN, "%.0f pN", true,
              "molecular force that is felt as 0.3 N or more");
        slide("strongest", strongest, lowest_pN, highest_pN, "%.0f pN", true,
              "molecular force that is felt as 2.7 N");
        strongest = std::max(strongest, least_ratio * weakest);
    }
    if (c.feel_within_pN) {
        slide("within", *c.feel_within_pN, lowest_pN, highest_pN, "%.0f pN", true,
              "how far forces may be from what all joints would give; active joints follow");
    }
}

void Overlay::draw_history() {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float column = column_of(screen.x);
    const float height = std::min(screen.y - gains_bottom_ - 2 * edge, 520.0F);
    if (height < 220) return;  // no room; a larger window has it
    ImGui::SetNextWindowPos({screen.x - column - edge, gains_bottom_ + edge});
    ImGui::SetNextWindowSize({column, height});
    ImGui::Begin("What happened", nullptr, fixed_window);
    const std::span<const Reading> samples = history_.samples();
    const auto fill = [&](std::vector<double>& values, auto&& value) {
        values.clear();
        for (const Reading& sample : samples) values.push_back(value(sample));
    };
    const float labels = 2 * ImGui::GetTextLineHeight();
    const float each = (height - 90 - labels) / 3;
    const auto draw = [&](const char* id, std::string_view x_label, std::string_view y_label,
                          PlotRange across, double least, ImU32 colour, auto&& value) {
        fill(y_, value);
        const std::array lines{PlotLine{x_, y_, colour, {}}};
        std::array points{PlotPoint{}};
        if (!x_.empty()) points[0] = {x_.back(), y_.back(), now_colour};
        draw_plot(id,
                  {x_label, y_label, across, range_around(y_, least), lines,
                   x_.empty() ? std::span<const PlotPoint>() : points},
                  x_label.empty() ? each : each + labels);
    };
    const auto draw_all = [&](std::string_view x_label, PlotRange across) {
        draw("F_m", "", "force on the molecule, F_m (nN)", across, 0.2, molecule_colour,
             [](const Reading& r) { return r.molecular_nN; });
        tip("nN; on one axis + repels and - attracts");
        draw("F_h", "", "force on the hand, F_h (N)", across, 0.5, hand_colour,
             [](const Reading& r) { return r.hand_N; });
        tip("N, as sent to the device");
        draw("A_d", x_label, "displacement gain, A_d (cm/Å)", across, 0.2, gain_colour,
             [](const Reading& r) { return cm_per_angstrom(r.displacement_gain); });
        tip("A_d = dx_handle/dx_molecule; 1 cm/Å is 1e8");
    };
    if (ImGui::BeginTabBar("plots")) {
        if (ImGui::BeginTabItem("over time")) {
            fill(x_, [](const Reading& r) { return r.time_s; });
            const double now = x_.empty() ? 0 : x_.back();
            draw_all("time (s)", {now - History::seconds, now + 0.02 * History::seconds});
            ImGui::EndTabItem();
        }
        if (ImGui::BeginTabItem("over separation")) {
            fill(x_, [](const Reading& r) { return r.distance_angstrom; });
            draw_all("separation (Å)", range_around(x_, 1));
            ImGui::EndTabItem();
        }
        ImGui::EndTabBar();
    }
    ImGui::End();
}

void Overlay::draw_lesson() {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float column = column_of(screen.x);
    const float width = std::max(260.0F, screen.x - 2 * column - 4 * edge);
    ImGui::SetNextWindowPos({screen.x / 2, screen.y - edge - 30}, ImGuiCond_Always, {0.5F, 1});
    ImGui::SetNextWindowSize({std::min(width, 560.0F), 0});
    ImGui::Begin("Lesson", nullptr, fixed_window);
    const std::size_t count = lesson_.steps().size();
    if (lesson_.is_done()) {
        ImGui::TextWrapped("All %d steps are done. L hides this.", static_cast<int>(count));
    } else {
        const LessonStepDescription& step = lesson_.steps()[lesson_.current()];
        ImGui::TextDisabled("%s",
                            fmt::format("step {} of {}", lesson_.current() + 1, count).c_str());
        ImGui::TextWrapped("%s", step.text.c_str());
        ImGui::PushStyleColor(ImGuiCol_Text, hand_colour);
        ImGui::TextWrapped("%s", step.task.c_str());
        ImGui::PopStyleColor();
        if (step.for_s > 0) ImGui::ProgressBar(static_cast<float>(lesson_.share()), {-1, 6}, "");
        if (ImGui::SmallButton("skip")) lesson_.skip();
        ImGui::SameLine();
    }
    if (ImGui::SmallButton("from the beginning")) lesson_.restart();
    ImGui::End();
}

void Overlay::draw_warnings(const Readout& readout, const OverlayStatus& status) {
    std::vector<std::string> warnings;
    // Each stays for a while after its reason, or nobody could read it.
    const auto warn = [&](double& left_s, bool is_so, auto&& text) {
        if (is_so) left_s = 2;
        left_s -= ImGui::GetIO().DeltaTime;
        if (left_s > 0) warnings.push_back(text());
    };
    if (stopped_) warnings.emplace_back("a force was not finite: no force until you reset (R)");
    if (reason_ != SafetyStage::None && !stopped_) warnings.emplace_back(words(reason_));
    if (stage_ >= SafetyStage::Hot && stage_ != reason_ && !stopped_)
        warnings.emplace_back(words(stage_));
    warn(shaking_for_s_, is_shaking(readout), [&] {
        return fmt::format(
            "this setting vibrates: K > B/(1.5 T_s). This hand keeps {:.3g} N/m calm at T_s = {} "
            "ms. Shorten the period, raise A_d, or lower the force gain.",
            stiffness_limit_, settings_.period_ms);
    });
    warn(clamped_for_s_, clamped_,
         [&] { return fmt::format("the force is cut off at {} N", settings_.coupling.clamp_N); });
    warn(late_for_s_, readout.step_ms > settings_.period_ms, [&] {
        return fmt::format("steps take longer than their period of {} ms: the force comes late",
                           settings_.period_ms);
    });
    if (went_through_) {
        warnings.emplace_back("the molecule was pushed through the other one: R brings it back");
    }
    if (!readout.problem.empty()) warnings.push_back(readout.problem);
    if (readout.paused) warnings.emplace_back("paused: P goes on");
    if (!status.notice.empty()) warnings.push_back(status.notice);
    warnings.emplace_back(!status.has_mouse_hand
                              ? fmt::format("led by: {}; H: all keys", status.device_name)
                          : status.holding ? "in hand: move the mouse; the wheel goes in and out"
                                           : "hold Space and move the mouse to pull the molecule, "
                                             "or use the arrow keys; H: all keys");
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float column = column_of(screen.x);
    ImGui::SetNextWindowPos({screen.x / 2, edge}, ImGuiCond_Always, {0.5F, 0});
    ImGui::SetNextWindowSizeConstraints({200, 0},
                                        {std::max(260.0F, screen.x - 2 * column - 60), 400});
    ImGui::Begin("##warnings", nullptr,
                 fixed_window | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(std::max(240.0F, screen.x - 2 * column - 90));
    for (const std::string& warning : warnings) ImGui::TextUnformatted(warning.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

void Overlay::draw_help() {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::Begin("Keys and mouse", &shows_help_, fixed_window | ImGuiWindowFlags_AlwaysAutoResize);
    if (ImGui::BeginTable("keys", 2)) {
        const auto row = [](std::string_view name, std::string_view does) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(name.data(), name.data() + name.size());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(does.data(), does.data() + does.size());
        };
        for (const Gesture& gesture : gestures()) row(gesture.name, gesture.does);
        for (const Shortcut& shortcut : shortcuts()) row(shortcut.name, shortcut.does);
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace palpa
