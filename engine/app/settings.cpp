#include "app/settings.h"

#include "app/lesson_course.h"
#include "app/window_world.h"
#include "haptics/gains.h"
#include "haptics/hand.h"
#include "session/run_headless.h"
#include "simulation/coupling.h"

#include <utility>
#include <vector>

namespace palpa {
void update_stiffness_limit(World& app) {
    SettingsState& settings = app.write<SettingsState>();
    const SceneDescription& scene = scene_of(app);
    const std::size_t hand = settings.now.hand;
    settings.stiffness_limit = settings.is_guarded()
                                   ? settings.device_cap_N_per_m
                                   : calm_stiffness(scene, hand, hand_model(scene.hands[hand].grip),
                                                    settings.now.period_ms * 1e-3);
}

void change_settings(World& app, const LiveSettings& settings) {
    app.write<SettingsState>().now = settings;
    update_stiffness_limit(app);
    send(app, settings);
}

void show_settings_of_led(World& app) {
    app.write<SettingsState>().now = led_hand(app).settings;
    update_stiffness_limit(app);
}

std::vector<LiveSettings> list_hand_settings(const World& app) {
    std::vector<LiveSettings> all;
    for (const LiveHand& hand : frame_of(app).hands) all.push_back(hand.settings);
    const LiveSettings& now = app.resource<SettingsState>().now;
    all[now.hand] = now;  // the frame may be from before
    for (LiveSettings& each : all) each.period_ms = now.period_ms;
    return all;
}

void set_mode(World& app, CouplingMode mode) {
    const SettingsState& settings = app.resource<SettingsState>();
    if (settings.now.coupling.mode == mode || is_replay(app)) return;
    LiveSettings changed = settings.now;
    changed.coupling.mode = mode;
    change_settings(app, changed);
}

void follow_settings(World& app) {
    const Readout& readout = frame_of(app).readout;
    const LiveSettings& now = led_hand(app).settings;
    SettingsState& settings = app.write<SettingsState>();
    if (is_replay(app)) {
        settings.now = now;
    } else if (std::exchange(settings.restored, readout.undo.restored) != readout.undo.restored) {
        app.set_resource(readout.undo.additions);
        const bool is_other_period = settings.now.period_ms != now.period_ms;
        settings.now = now;
        if (is_other_period) send(app, settings.now);  // devices hear of it as well
    } else {
        return;
    }
    update_stiffness_limit(app);
}

void take_ticks(World& app) {
    WindowHands& hands = app.write<WindowHands>();
    const WindowOptions& options = options_of(app);
    const bool is_paused = frame_of(app).readout.paused;
    std::vector<ServoTick> ticks(hands.all.size());
    while (session_of(app).pop_ticks(ticks)) {
        for (std::size_t slot = 0; slot < hands.all.size(); ++slot) {
            const ServoTick& tick = ticks[slot];
            WindowHand& hand = hands.all[slot];
            hand.lead.see(tick.reading.position_m, tick.contact.displacement_gain);
            hand.felt_newton = tick.sent_newton.norm();
            hand.molecule_nN = 1e9 * tick.contact.force_newton.norm();
            hand.waiting_m = tick.waiting_m;
            hand.is_at_wall = tick.overtravel_m.norm() > least_overtravel_m;
            hand.is_at_stop = tick.is_at_stop && !tick.clutched;
            if (!is_paused) hand.statistics.add(tick);
        }
        if (options.is_over && options.is_over(ticks.front()))
            app.write<FrameLoop>().is_quitting = true;
        if (is_paused) continue;
        add_tick(app, ticks[hands.led]);
        if (options.study) options.study->add(ticks.front());
    }
}

void add_tick(World& app, const ServoTick& tick) {
    Readings& readings = app.write<Readings>();
    const Reading reading = read_tick(tick);
    if (readings.has_tick && reading.time_s == readings.last.time_s) return;  // no time passed
    readings.has_tick = true;
    readings.last = reading;
    readings.tick = tick;
    if (tick.contact.active_freedom == 1) {
        const double side = tick.contact.molecule.place_angstrom.x();
        if (readings.start_side == 0) readings.start_side = side;
        readings.went_through = side * readings.start_side < 0;
    } else {
        readings.start_side = 0;
        readings.went_through = false;
    }
    SettingsState& settings = app.write<SettingsState>();
    if (std::exchange(settings.device_cap_N_per_m, tick.cap_N_per_m) != tick.cap_N_per_m)
        update_stiffness_limit(app);
    readings.history.add(reading);
    follow_lesson_by_tick(app, tick);
}

double find_felt_stiffness(const World& app) {
    const SettingsState& settings = app.resource<SettingsState>();
    if (settings.is_guarded()) return app.resource<Readings>().tick.felt_N_per_m;
    const CouplingLaws laws = build_coupling_laws(settings.now.coupling);
    const ContactModel& contact = frame_of(app).readout.contact;
    return largest_felt(laws.force, contact.force_newton, contact.stiffness_matrix_N_per_m) /
           displacement_gain(laws.displacement, contact.force_newton.norm());
}

bool is_shaking(const World& app) {
    const SettingsState& settings = app.resource<SettingsState>();
    return !settings.is_guarded() && find_felt_stiffness(app) > settings.stiffness_limit;
}

void set_additions(World& app, ViewAdditions additions) {
    if (app.resource<ViewAdditions>() == additions) return;
    app.set_resource(additions);
    send(app, additions);
}

}  // namespace palpa
