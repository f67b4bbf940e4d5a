// The panel at the left: what the scene is, the run, and what is measured.
#include "core/translate.h"
#include "haptics/gains.h"
#include "haptics/hand.h"
#include "simulation/coupling.h"
#include "simulation/grip_queries.h"
#include "ui/layout.h"
#include "ui/overlay.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
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

// One line of the readings: a name, a value, and what it is when the mouse rests on it.
void reading(const char* name, const std::string& value, const char* explanation) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    tip(explanation);
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", value.c_str());
    tip(explanation);
}

bool begin_readings(const char* id) {
    if (!ImGui::BeginTable(id, 2)) return false;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, scaled(115));
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

// On one axis a force's sign says what it does; at rest only rounding is left of it.
const char* doing(bool on_axis, double force) {
    constexpr double rounding = 1e-6;
    if (!on_axis || std::abs(force) < rounding) return "";
    return force > 0 ? translated(", repels") : translated(", attracts");
}

// Which water is around the molecules, and what that leaves out.
void show_solvent(Solvent solvent, bool is_remote) {
    if (is_remote) {
        return reading(translated("water"), translated("the engine's"),
                       translated("A remote engine moves the atoms with its own force field, "
                                  "temperature and water."));
    }
    if (solvent == Solvent::None) {
        return reading(
            translated("water"), translated("none: vacuum"),
            translated("The molecules are in vacuum. Nothing screens charges, so ionic groups "
                       "attract and repel each other far too strongly, and there is no solvation "
                       "energy. The scene sets this by force_field.solvent."));
    }
    reading(
        translated("water"), translated("implicit, EEF1-SB"),
        translated("EEF1-SB (Bottaro et al. 2013): each atom has a solvation energy, reduced by "
                   "the atoms around it; ionic groups are neutral, and charges act through a "
                   "dielectric of 1.5 r. The model leaves out salt, surface tension, polarisation "
                   "and viscosity, and does not distinguish inside and outside of a protein: salt "
                   "bridges are far too weak; pairs of catalytic acids and metal sites are "
                   "described poorly. The energies are not free energies of binding."));
}

// Residues whose parameters nobody has fitted.
void show_approximate(const std::vector<MoleculeDescription>& molecules) {
    std::vector<std::string> names;
    for (const MoleculeDescription& molecule : molecules) {
        for (const std::string& name : molecule.approximate) {
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        }
    }
    if (names.empty()) return;
    reading(
        translated("approximate"), fmt::format("{}", fmt::join(names, ", ")),
        translated("Types, charges and parameters of these residues are approximate: Palpa took "
                   "them from similar model compounds of CGenFF, so their forces are rough. For "
                   "better ones send the molecule to the CGenFF server (cgenff.com), then open the "
                   "structure together with the stream file (.str) that it writes."));
}

void switch_sound(const OverlayStatus& status, std::vector<Action>& actions) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(translated("sound"));
    tip(
        translated("S. Plays the force on the hand as a tone: a stronger force is higher and "
                   "louder; silence means no force. Palpa remembers the choice."));
    ImGui::TableNextColumn();
    bool sounds = status.sounds;
    if (ImGui::Checkbox(labelled("force as a tone").c_str(), &sounds))
        actions.push_back(Action::ToggleSound);
}

// Both texts are English.
void button(const char* text, const char* explanation, Action action,
            std::vector<Action>& actions) {
    if (ImGui::Button(labelled(text).c_str())) actions.push_back(action);
    tip(translated(explanation));
}

// `name`: of what it changes; empty: nothing.
void undo_button(const char* text, const char* key, const std::string& name, Action action,
                 std::vector<Action>& actions) {
    same_line_if_it_fits(translated(text));
    ImGui::BeginDisabled(name.empty());
    if (ImGui::Button(labelled(text).c_str())) actions.push_back(action);
    ImGui::EndDisabled();
    if (!name.empty())
        tip(fmt::format("{}. {}: {}", translated(key), translated(text), name).c_str());
}

}  // namespace

void Overlay::draw_scene(const Readout& readout, const OverlayStatus& status,
                         std::vector<Command>& commands, std::vector<Action>& actions) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float column = panel_column(screen.x), edge = panel_edge();
    ImGui::SetNextWindowPos({edge, edge});
    ImGui::SetNextWindowSizeConstraints({column, 0}, {column, screen.y - 2 * edge});
    ImGui::SetNextWindowSize({column, 0});
    // A title that the bar would cut stands below it.
    const bool fits = ImGui::CalcTextSize(scene_.title.c_str()).x < column - scaled(45);
    const std::string title = fmt::format("{}###scene", fits ? scene_.title : translated("Scene"));
    fold_in_small_window(left_folds_);
    // A panel that fits its height is laid out also where it is folded.
    const bool is_open =
        ImGui::Begin(title.c_str(), nullptr, fixed_panel) && !ImGui::IsWindowCollapsed();
    left_covered_ = is_open ? column + edge : 0;
    if (is_open) {
        if (!fits) ImGui::TextWrapped("%s", scene_.title.c_str());
        if (!scene_.about.empty() && ImGui::CollapsingHeader(labelled("About").c_str())) {
            ImGui::TextWrapped("%s", scene_.about.c_str());
        }
        draw_buttons(readout, status.recorded_s.has_value(), actions);
        choose_mode(commands);
        draw_readings(readout, status, actions);
        if (ImGui::CollapsingHeader(labelled("Machine").c_str())) draw_machine(readout, status);
    }
    ImGui::End();
}

void Overlay::draw_buttons(const Readout& readout, bool is_recording,
                           std::vector<Action>& actions) {
    button(readout.paused ? for_translation("Go on") : for_translation("Pause"),
           for_translation("P. While paused, nothing moves and the hand feels no force."),
           Action::PauseOrGo, actions);
    same_line_if_it_fits(translated("Step"));
    button(for_translation("Step"),
           for_translation("Full stop key. Makes one step of the simulation, then pauses."),
           Action::StepOnce, actions);
    same_line_if_it_fits(translated("Reset"));
    button(for_translation("Reset"),
           for_translation("R. Puts molecules and view back to their start; the settings stay."),
           Action::Reset, actions);
    undo_button(for_translation("Undo"), for_translation("Ctrl+Z"), readout.undo.undo, Action::Undo,
                actions);
    undo_button(for_translation("Redo"), for_translation("Ctrl+Shift+Z"), readout.undo.redo,
                Action::Redo, actions);
    same_line_if_it_fits(translated("Open"));
    button(for_translation("Open"),
           for_translation("Ctrl+O. Opens another scene, or a structure of your own."),
           Action::StartScreen, actions);
    same_line_if_it_fits(translated("Save"));
    button(for_translation("Save"),
           for_translation("Ctrl+S. Saves the scene with these settings to a new file."),
           Action::Save, actions);
    same_line_if_it_fits(translated("Picture"));
    button(for_translation("Picture"), for_translation("F12. Saves a screenshot."),
           Action::Screenshot, actions);
    same_line_if_it_fits(translated("Film"));
    button(for_translation("Film"), for_translation("M. Starts or ends a film of the window."),
           Action::Film, actions);
    same_line_if_it_fits(translated("Coordinates"));
    button(for_translation("Coordinates"),
           for_translation("E. Saves the coordinates of what is shown, or of the molecule in hand: "
                           "PDB, mmCIF, GRO, PSF and CRD."),
           Action::Export, actions);
    same_line_if_it_fits(
        translated(is_recording ? for_translation("End recording") : for_translation("Record")));
    button(is_recording ? for_translation("End recording") : for_translation("Record"),
           for_translation("F9. Records the session into a new folder, for a replay."),
           Action::Record, actions);
    same_line_if_it_fits(translated("Add"));
    button(for_translation("Add"),
           for_translation("Insert. Adds a molecule: a residue, a copy, or from a file."),
           Action::Add, actions);
    same_line_if_it_fits(translated("Remove"));
    button(for_translation("Remove"),
           for_translation("Delete. Removes the molecule in hand; Ctrl+Z brings it back."),
           Action::Remove, actions);
    same_line_if_it_fits(translated("Keys"));
    button(for_translation("Keys"), for_translation("H. Shows all keys."), Action::ToggleHelp,
           actions);
}

void Overlay::choose_mode(std::vector<Command>& commands) {
    ImGui::SetNextItemWidth(-1);
    const auto mode = static_cast<std::size_t>(settings_.coupling.mode);
    if (ImGui::BeginCombo("##mode", translated(mode_texts[mode]))) {
        for (std::size_t i = 0; i < mode_texts.size(); ++i) {
            if (ImGui::Selectable(labelled(mode_texts[i]).c_str(), i == mode)) {
                set_mode(static_cast<CouplingMode>(i), commands);
            }
        }
        ImGui::EndCombo();
    }
    tip(
        translated("The paper's five modes (keys 1 to 5) and guarded coupling (6), in which the 1 "
                   "kHz servo itself moves the molecule in the force field around it. The force "
                   "gain is F_h/F_m, the displacement gain A_d = dx_handle/dx_molecule."));
    int period = static_cast<int>(std::lround(settings_.period_ms));
    ImGui::SetNextItemWidth(-scaled(70));
    if (ImGui::SliderInt(labelled("period").c_str(), &period, 1, 100, "%d ms",
                         ImGuiSliderFlags_Logarithmic)) {
        LiveSettings settings = settings_;
        settings.period_ms = std::clamp(period, 1, 1000);
        change_settings(settings, commands);
    }
    tip(
        translated("T_s, ms: time between two simulation steps. In the paper's modes the force on "
                   "the hand is one period old and stays constant for one period: the longer the "
                   "period, the more it vibrates."));
}

void Overlay::draw_readings(const Readout& readout, const OverlayStatus& status,
                            std::vector<Action>& actions) {
    if (!begin_readings("readings")) return;
    draw_forces(readout.contact);
    draw_gain_readings(readout.contact, status.travel);
    draw_comparison(readout);
    reading(has_flexible_ ? translated("energy of all") : translated("energy"),
            fmt::format("{:.3f} kcal/mol", readout.contact.potential_kcal_per_mol),
            has_flexible_
                ? translated("Potential energy of all molecules with bonded terms, kcal/mol")
                : translated("Interaction energy of the molecule in hand with all others "
                             "(Lennard-Jones and Coulomb), kcal/mol"));
    show_solvent(scene_.force_field.solvent, scene_.engine.has_value());
    show_approximate(scene_.molecules);
    if (status.devices.empty()) {
        reading(translated("device"), status.device_name,
                translated("the device that renders the force, 1000 times a second"));
    } else {
        choose_device(status);
    }
    switch_sound(status, actions);
    ImGui::EndTable();
}

void Overlay::draw_forces(const ContactModel& contact) const {
    const bool on_axis = contact.active_freedom == 1;
    reading(translated("separation"), fmt::format("{:.3f} Å", last_.distance_angstrom),
            translated("Distance of the reference atoms, Å"));
    reading(translated("force, molecule"),
            fmt::format("{:.4f} nN{}", std::abs(last_.molecular_nN),
                        doing(on_axis, last_.molecular_nN)),
            translated("|F_m|, nN, on the molecule in hand"));
    reading(
        translated("force, hand"),
        fmt::format("{:.3f} N{}", std::abs(last_.hand_N), doing(on_axis, last_.hand_N)),
        translated("F_h = f(F_m), N, as sent to the device; eq. 2 of the paper in modes 1 and 2"));
    if (has_flexible_) {
        reading(translated("relaxation"), translated("incomplete"),
                translated("The surroundings make only a few relaxation steps while the hand "
                           "moves, so they are not at rest: the force can be several times the "
                           "force of relaxed surroundings (measured in scenes/hiv/results.md)."));
    }
    if (!on_axis && scene_.hands.front().grab.atom.empty()) {  // a spring turns nothing
        reading(translated("torque"),
                fmt::format("{:.3g} nN Å", 1e19 * contact.torque_newton_metre.norm()),
                translated("Torque on the molecule in hand about its centre of mass. The device "
                           "has no motor for it, so a molecule that is turned between the way in "
                           "and the way out can give energy to the hand."));
    }
}

void Overlay::draw_gain_readings(const ContactModel& contact, const HandTravel& travel) const {
    const CouplingLaws laws = build_coupling_laws(settings_.coupling);
    const double felt = is_guarded() ? felt_N_per_m_ : felt_stiffness(laws, contact);
    reading(
        translated("stiffness felt"),
        format_translated("{:.4g} of {:.4g} N/m", felt, stiffness_limit_),
        translated("K = (dF_h/dF_m) k / A_d, N/m, and its limit. Guarded coupling: the limit is "
                   "the cap of the device in use, half of its stability limit; A_d is raised until "
                   "K is below it. Other modes: the limit is the largest stable K of this hand, "
                   "about B/(1.5 "
                   "T_s), from the eigenvalues for hand, device, period and delay."));
    reading(
        translated("displ. gain"),
        fmt::format("{:.2f} cm/Å", cm_per_angstrom(last_.displacement_gain)),
        translated(
            "A_d = dx_handle/dx_molecule, centimetres of the handle for an Å of the molecule; 1 "
            "cm/Å is 1e8. Eq. 3 of the paper in modes 1 and 3"));
    reading(translated("force gain"), fmt::format("{:.3g}", force_gain_),
            translated("A_f = F_h/F_m, N/N"));
    reading(translated("work on hand"), fmt::format("{:+.2f} mJ", 1e3 * hand_energy_J_),
            translated("Energy given to the hand so far, mJ. On a path out and back it must not "
                       "exceed 0 (passivity)."));
    if (is_guarded()) {
        reading(
            translated("overtravel"), fmt::format("{:.1f} mm", 1e3 * overtravel_m_),
            format_translated("The contact force reached {:.3g} nN (coupling.stop_nN), so the "
                              "molecule stopped. Move back by this much before it follows again.",
                              settings_.coupling.stop_nN)
                .c_str());
        reading(
            translated("travel lost"),
            format_translated("{:.1f} of {:.0f} cm", 100 * travel.lost_m, 100 * travel.handle_m),
            translated("Handle travel that the molecule will never follow, and the travel so "
                       "far. While the molecule waits for its model, up to 2 cm are kept."));
    }
}

void Overlay::draw_machine(const Readout& readout, const OverlayStatus& status) {
    if (!begin_readings("machine")) return;
    const int freedom = readout.contact.active_freedom;
    reading(
        translated("moving"),
        fmt::format(fmt::runtime(translated_plural("{} degree of freedom", "{} degrees of freedom",
                                                   static_cast<std::size_t>(freedom))),
                    freedom),
        translated("Number of degrees of freedom that a step may move"));
    reading(translated("hand"),
            std::string(grip_names[static_cast<std::size_t>(scene_.hands.front().grip)]),
            translated("How firmly the emulated hand holds the handle (hand.grip of the scene)"));
    reading(translated("step"),
            format_translated("{:.3f} ms of {} ms", readout.step_ms, settings_.period_ms),
            translated("Wall time of the last simulation step, and the declared period"));
    reading(translated("drawing"),
            format_translated("{:.1f} ms, scale {:.2f}", status.frame_ms, status.render_scale),
            translated("Time to draw a frame. If the frame rate falls below 30 Hz, Palpa first "
                       "drops effects, then lowers the resolution."));
    const double ticks = 1e3 * last_.time_s;
    reading(translated("servo"),
            format_translated(
                "{:.2f} % of ticks missed{}",
                ticks > 0 ? 100 * static_cast<double>(status.servo.overruns) / ticks : 0.0,
                !status.servo.real_time ? translated(", ordinary priority")
                : !status.servo.locked  ? translated(", memory not locked")
                                        : ""),
            translated("The servo sends a force every millisecond. When the system is late, it "
                       "misses a tick and the device keeps the previous force. This happens more "
                       "often without real-time priority and locked memory: allow rtprio 50 and "
                       "memlock for your user in /etc/security/limits.conf."));
    ImGui::EndTable();
    ImGui::TextDisabled("%s", status.gpu_name.c_str());
}

void Overlay::choose_device(const OverlayStatus& status) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(translated("device"));
    tip(translated(
        "The device that renders the force, 1000 times a second. D selects the next connected "
        "device. Palpa remembers the choice, and uses an unplugged device again when it is back."));
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##device", status.device.c_str())) return;
    for (const DeviceOffer& offer : status.devices) {
        const std::string text =
            fmt::format("{}{}", offer.name, offer.is_there ? "" : translated(" (not connected)"));
        if (ImGui::Selectable(text.c_str(), offer.name == status.device)) device_ = offer.name;
        tip(translated(offer.summary.c_str()));
    }
    ImGui::EndCombo();
}

// What is to be felt, and how wrong it is.
void Overlay::draw_comparison(const Readout& readout) {
    const CouplingDescription& c = settings_.coupling;
    if (const auto range = c.feel_pN; range && is_guarded()) {
        reading(translated("force range"),
                format_translated("{:.4g} to {:.4g} pN, A_d x {:.2f}", (*range)[0], (*range)[1],
                                  cap_ratio_),
                translated("The molecular forces that are felt as 0.3 N and as 2.7 N, and the cap "
                           "ratio: A_d is multiplied by it to keep the stiffness below its cap, so "
                           "the molecule moves less far by this factor."));
    }
    if (!readout.error_pN) return;
    std::string error = fmt::format("{:.3g} pN", *readout.error_pN);
    if (const auto within_pN = c.feel_within_pN)
        error += format_translated(" (limit {:.4g} pN)", *within_pN);
    if (readout.work_budget.steps > 0)
        error += format_translated(", {} active joints", readout.work_budget.active);
    if (const double age = readout.contact.model_age_angstrom; std::isfinite(age))
        error += format_translated(", contact model {:.2f} Å away", age);
    reading(translated("error"), error,
            translated("Estimated error of the force against complete relaxation of all joints "
                       "with all pairs; and the distance of the hand from the place where the "
                       "contact model was computed."));
}

}  // namespace palpa
