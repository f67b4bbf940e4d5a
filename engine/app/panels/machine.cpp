// The panel "Machine": the device in the hand, what the model leaves out, and how fast all runs.
#include "app/device_choice.h"
#include "app/panels.h"
#include "app/window_world.h"
#include "core/translate.h"
#include "ui/icons.h"
#include "ui/readings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace palpa {
namespace {

void add_water(const SceneDescription& scene) {
    if (scene.engine)
        return add_reading(translated("water"), translated("the engine's"),
                           translated("A remote engine moves the atoms with its own force field, "
                                      "temperature and water."));
    if (scene.force_field.solvent == Solvent::None)
        return add_reading(
            translated("water"), translated("none: vacuum"),
            translated("The molecules are in vacuum. Nothing screens charges, so ionic groups "
                       "attract and repel each other far too strongly, and there is no solvation "
                       "energy. The scene sets this by force_field.solvent."));
    add_reading(
        translated("water"), translated("implicit, EEF1-SB"),
        translated("EEF1-SB (Bottaro et al. 2013): each atom has a solvation energy, reduced by "
                   "the atoms around it; ionic groups are neutral, and charges act through a "
                   "dielectric of 1.5 r. The model leaves out salt, surface tension, polarisation "
                   "and viscosity, and does not distinguish inside and outside of a protein: salt "
                   "bridges are far too weak; pairs of catalytic acids and metal sites are "
                   "described poorly. The energies are not free energies of binding."));
}

// Adds the residues whose parameters nobody has fitted.
void add_approximate(const SceneDescription& scene) {
    std::vector<std::string> names;
    for (const MoleculeDescription& molecule : scene.molecules)
        for (const std::string& name : molecule.approximate)
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    if (names.empty()) return;
    add_reading(
        translated("approximate"), fmt::format("{}", fmt::join(names, ", ")),
        translated("Types, charges and parameters of these residues are approximate: Palpa took "
                   "them from similar model compounds of CGenFF, so their forces are rough. For "
                   "better ones send the molecule to the CGenFF server (cgenff.com), then open the "
                   "structure together with the stream file (.str) that it writes."));
}

void choose_from_devices(World& app) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(translated("device"));
    tip(translated(
        "The device that renders the force, 1000 times a second. D selects the next connected "
        "device. Palpa remembers the choice, and uses an unplugged device again when it is back."));
    ImGui::TableNextColumn();
    if (!can_choose_device(app)) {
        const Device& device = *app.resource<WindowHands>().by_mouse().device;
        return ImGui::TextUnformatted(device.spec().name.c_str());
    }
    const DeviceMenu& menu = app.resource<DeviceChoice>().menu;
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##device", menu.current.c_str())) return;
    for (const DeviceOffer& offer : menu.offers) {
        const std::string text =
            fmt::format("{}{}", offer.name, offer.is_there ? "" : translated(" (not connected)"));
        if (ImGui::Selectable(text.c_str(), offer.name == menu.current))
            request(app, [name = offer.name](World& later) { (void)choose_device(later, name); });
        tip(translated(offer.summary.c_str()));
    }
    ImGui::EndCombo();
}

// Adds what is to be felt, and how wrong it is.
void add_accuracy(const World& app) {
    const Readout& readout = frame_of(app).readout;
    const SettingsState& settings = app.resource<SettingsState>();
    const CouplingDescription& c = settings.now.coupling;
    if (const auto range = c.feel_pN; range && settings.is_guarded())
        add_reading(
            translated("force range"),
            format_translated("{:.4g} to {:.4g} pN, A_d x {:.2f}", (*range)[0], (*range)[1],
                              app.resource<Readings>().tick.cap_ratio),
            translated("The molecular forces that are felt as 0.3 N and as 2.7 N, and the cap "
                       "ratio: A_d is multiplied by it to keep the stiffness below its cap, so "
                       "the molecule moves less far by this factor."));
    if (!readout.error_pN) return;
    std::string error = fmt::format("{:.3g} pN", *readout.error_pN);
    if (const auto within_pN = c.feel_within_pN)
        error += format_translated(" (limit {:.4g} pN)", *within_pN);
    if (readout.work_budget.steps > 0)
        error += format_translated(", {} active joints", readout.work_budget.active);
    if (const double age = readout.contact.model_age_angstrom; std::isfinite(age))
        error += format_translated(", contact model {:.2f} Å away", age);
    add_reading(translated("error"), error,
                translated("Estimated error of the force against complete relaxation of all joints "
                           "with all pairs; and the distance of the hand from the place where the "
                           "contact model was computed."));
}

void add_speeds(const World& app) {
    const Readout& readout = frame_of(app).readout;
    const ServoHealth servo = session_of(app).servo_health();
    add_reading(translated("step"),
                format_translated("{:.3f} ms of {} ms", readout.step_ms,
                                  app.resource<SettingsState>().now.period_ms),
                translated("Wall time of the last simulation step, and the declared period"));
    add_reading(translated("drawing"),
                format_translated("{:.1f} ms, scale {:.2f}", app.resource<FrameLoop>().last_ms,
                                  app.resource<PictureState>().scale.value()),
                translated("Time to draw a frame. If the frame rate falls below 30 Hz, Palpa first "
                           "drops effects, then lowers the resolution."));
    const double ticks = 1e3 * app.resource<Readings>().last.time_s;
    add_reading(
        translated("servo"),
        format_translated("{:.2f} % of ticks missed{}",
                          ticks > 0 ? 100 * static_cast<double>(servo.overruns) / ticks : 0.0,
                          !servo.real_time ? translated(", ordinary priority")
                          : !servo.locked  ? translated(", memory not locked")
                                           : ""),
        translated("The servo sends a force every millisecond. When the system is late, it "
                   "misses a tick and the device keeps the previous force. This happens "
                   "more often without real-time priority and locked memory: allow rtprio "
                   "50 and memlock for your user in /etc/security/limits.conf."));
}

void draw_machine(World& app) {
    const SceneDescription& scene = scene_of(app);
    if (!begin_readings("machine")) return;
    choose_from_devices(app);
    add_reading(translated("grip"),
                std::string(grip_names[static_cast<std::size_t>(scene.hands.front().grip)]),
                translated("How firmly the emulated hand holds the handle (hand.grip of the "
                           "scene)"));
    add_water(scene);
    add_approximate(scene);
    const int freedom = frame_of(app).readout.contact.active_freedom;
    add_reading(
        translated("moving"),
        fmt::format(fmt::runtime(translated_plural("{} degree of freedom", "{} degrees of freedom",
                                                   static_cast<std::size_t>(freedom))),
                    freedom),
        translated("Number of degrees of freedom that a step may move"));
    add_accuracy(app);
    add_speeds(app);
    ImGui::EndTable();
    WindowShell* const shell = app.resource<WindowLinks>().shell;
    if (shell && shell->graphics())
        ImGui::TextDisabled("%s", shell->graphics()->device.name().c_str());
}

}  // namespace

extern const Panel machine_panel{
    .id = "machine",
    .title = for_translation("Machine"),
    .explains = for_translation("Device, servo, graphics and water model."),
    .icon = icon_machine,
    .side = Side::Right,
    .draw = draw_machine};

}  // namespace palpa
