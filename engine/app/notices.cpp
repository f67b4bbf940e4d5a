#include "app/notices.h"

#include "app/editing.h"
#include "app/inspected.h"
#include "app/settings.h"
#include "app/window_world.h"
#include "core/translate.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace palpa {
namespace {

void tell_of_undo(World& app) {
    const UndoReadout& undo = frame_of(app).readout.undo;
    if (undo.dropped > std::exchange(app.write<PendingEdits>().forgotten, undo.dropped))
        tell(app,
             format_translated("undo has no room for more and forgets the oldest change: {}",
                               undo.dropped_name),
             long_notice_s);
}

void tell_of_problem(World& app) {
    Notices& notices = app.write<Notices>();
    const Readout& readout = frame_of(app).readout;
    const bool is_new =
        std::exchange(notices.refused, readout.refused_edits) != readout.refused_edits ||
        notices.problem != readout.problem;
    notices.problem = readout.problem;
    if (is_new && !notices.problem.empty()) tell(app, notices.problem, long_notice_s);
}

void tell_of_grip(World& app) {
    WindowHands& hands = app.write<WindowHands>();
    const std::string& held = led_hand(app).held_address;
    if (hands.held_address == held) return;
    const bool is_first = hands.held_address.empty() && !app.resource<PictureState>().has_first;
    hands.held_address = held;
    if (std::holds_alternative<InspectedMolecule>(app.resource<Inspected>().what))
        app.write<Inspected>().what = InspectedMolecule{};
    if (is_first || held.empty()) return;
    tell(app, format_translated("in hand: {}; Ctrl+Z undoes, G lets go", held));
}

// Says what the hand can do, if there is nothing else to tell.
std::string advise_hand(const World& app) {
    const WindowHands& hands = app.resource<WindowHands>();
    const Readout& readout = frame_of(app).readout;
    const WindowHand& hand = hands.by_mouse();
    if (const auto status = hand.device->status(); !status.empty()) return std::string(status);
    if (readout.replay)
        return translated("a recorded session is played again; drag turns the view, H: all keys");
    if (!readout.holds_something)
        return translated("nothing is in hand: click on an atom to take its molecule; H: all keys");
    if (!hand.is_led())
        return format_translated("device: {}; H: all keys", hand.device->spec().name);
    return hands.holds ? translated("in hand: move the mouse; the wheel goes in and out")
                       : translated(
                             "hold Space and move the mouse to pull the molecule, or use the arrow "
                             "keys; H: all keys");
}

}  // namespace

void tell(World& app, std::string text, double seconds) {
    constexpr std::size_t most = 100;
    Notices& notices = app.write<Notices>();
    if (text != notices.text || SteadyClock::now() > notices.until) {
        if (notices.history.size() == most) notices.history.erase(notices.history.begin());
        notices.history.push_back(text);
    }
    notices.text = std::move(text);
    notices.until = SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(
                                             std::chrono::duration<double>(seconds));
}

void tell_news(World& app) {
    tell_of_grip(app);
    tell_of_undo(app);
    tell_of_edit(app);
    tell_of_problem(app);
}

std::string find_message(const World& app) {
    const Notices& notices = app.resource<Notices>();
    return SteadyClock::now() < notices.until ? notices.text : advise_hand(app);
}

std::vector<std::string> list_warnings(World& app) {
    Notices& notices = app.write<Notices>();
    const Readings& readings = app.resource<Readings>();
    const SettingsState& settings = app.resource<SettingsState>();
    const WindowHand& hand = app.resource<WindowHands>().by_mouse();
    const Readout& readout = frame_of(app).readout;
    const ServoTick& tick = readings.tick;
    const double frame_s = ImGui::GetIO().DeltaTime;
    std::vector<std::string> warnings;
    const auto warn = [&](double& left_s, bool is_so, auto&& text) {
        constexpr double readable_s = 2;
        if (is_so) left_s = readable_s;
        left_s -= frame_s;
        if (left_s > 0) warnings.push_back(text());
    };
    if (tick.stopped)
        warnings.emplace_back(translated(
            "a force was not finite, so the force is off until you reset the scene (R)"));
    const bool feels = readout.holds_something && !tick.stopped;
    // A mouse has no handle to hold.
    const bool is_told = tick.reason != SafetyStage::Engaging || !hand.is_led();
    if (tick.reason != SafetyStage::None && feels && is_told)
        warnings.emplace_back(translated(describe(tick.reason).data()));
    if (tick.stage >= SafetyStage::ThermalLimit && tick.stage != tick.reason && feels)
        warnings.emplace_back(translated(describe(tick.stage).data()));
    warn(notices.shaking_s, is_shaking(app), [&] {
        return format_translated(
            "the hand vibrates: it feels a stiffness of more than {:.3g} N/m, its limit at a "
            "period "
            "of {} ms. Lower the strength (panel Hand), or shorten the period (panel Coupling).",
            settings.stiffness_limit, settings.now.period_ms);
    });
    warn(notices.clamped_s, tick.clamped, [&] {
        return format_translated(
            "the force is limited to {} N: push less, or lower the strength (panel Hand)",
            settings.now.coupling.clamp_N);
    });
    // A single late step, of any length, is no reason to raise the period.
    const double step_ms = std::min(readout.step_ms, 10 * settings.now.period_ms);
    notices.mean_step_ms += std::min(1.0, frame_s) * (step_ms - notices.mean_step_ms);
    warn(notices.late_s, notices.mean_step_ms > settings.now.period_ms, [&] {
        return format_translated(
            "steps take longer than the period of {} ms, so the force is delayed: raise the period "
            "(panel Coupling)",
            settings.now.period_ms);
    });
    const double overtravel_m = tick.overtravel_m.norm();
    warn(notices.at_wall_s, settings.is_guarded() && overtravel_m > least_overtravel_m, [&] {
        return format_translated(
            "overtravel: the contact force has reached {:.3g} nN, so the molecule has stopped; "
            "move the hand back by {:.0f} mm before it follows again",
            settings.now.coupling.stop_nN, std::ceil(1e3 * overtravel_m));
    });
    warn(notices.at_stop_s, tick.is_at_stop && !tick.clutched, [&] {
        return std::string(
            hand.is_led()
                ? translated("the handle is at its end: release Space, press it again")
                : translated("the handle is at its end: press the clutch, move back, let go"));
    });
    if (readings.went_through)
        warnings.emplace_back(
            translated("the molecule was pushed through another one; R resets the scene"));
    if (!readout.engine.empty()) warnings.push_back(readout.engine);
    if (!readout.edit_under_way.empty())
        warnings.push_back(format_translated("{}: in preparation", readout.edit_under_way));
    if (readout.paused) warnings.emplace_back(translated("paused; P continues"));
    return warnings;
}

}  // namespace palpa
