#include "app/device_choice.h"

#include "app/notices.h"
#include "app/window_world.h"
#include "core/load_error.h"
#include "core/translate.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::chrono::seconds device_look{1};

bool is_stand_in(const DeviceMenu& menu, const std::string& name) {
    return std::ranges::any_of(menu.offers, [&](const DeviceOffer& offer) {
        return offer.name == name && offer.is_stand_in;
    });
}

bool change_device(World& app, const std::string& name) {
    DeviceChoice& choice = app.write<DeviceChoice>();
    WindowDevice next;
    try {
        next = choice.menu.open(name);
        session_of(app).change_device(*next.device, next.orders, 0);
    } catch (const LoadError& error) {
        if (error.what() != choice.refusal) tell(app, error.what(), long_notice_s);
        choice.refusal = error.what();
        return false;
    }
    choice.refusal.clear();
    choice.chosen = std::move(next.device);
    WindowHand& first = app.write<WindowHands>().all.front();
    first.device = choice.chosen.get();
    first.orders = next.orders;
    first.mouse_reach_m = next.mouse_reach_m;
    first.lead = MouseLead(first.mouse_reach_m);
    first.waiting_m = Vec3::Zero();
    choice.menu.current = name;
    tell(app, format_translated("device: {}", first.device->spec().name));
    return true;
}

void ask_for_stand_in(World& app) {
    const DeviceMenu& menu = app.resource<DeviceChoice>().menu;
    const auto found = std::ranges::find_if(menu.offers, &DeviceOffer::is_stand_in);
    if (found == menu.offers.end() || found->name == menu.current) return;
    app.write<Dialogs>().question = {
        format_translated(
            "No other device was found. Use an emulated device for this session ({})?",
            translated(found->summary.c_str())),
        {{Key::Y, translated("Yes (Y)"),
          [&app, name = found->name] { (void)choose_device(app, name); }},
         {Key::Escape, translated("No (Esc)")}}};
}

}  // namespace

bool can_choose_device(const World& app) {
    return app.resource<DeviceChoice>().menu.open && !is_study(app);
}

void look_for_devices(World& app) {
    DeviceChoice& choice = app.write<DeviceChoice>();
    if (!can_choose_device(app) || SteadyClock::now() < choice.next_look) return;
    choice.next_look = SteadyClock::now() + device_look;
    DeviceMenu& menu = choice.menu;
    bool is_wanted_there = false;
    for (DeviceOffer& offer : menu.offers) {
        offer.is_there = menu.is_there(offer.name);
        is_wanted_there = is_wanted_there || (offer.name == menu.wanted && offer.is_there);
    }
    if (!is_wanted_there) {
        choice.refusal.clear();
        const bool is_quiet = SteadyClock::now() > app.resource<Notices>().until;
        if (!menu.wanted.empty() && !std::exchange(choice.has_looked, true) && is_quiet)
            tell(app,
                 format_translated("{} is not connected; using until then: {}", menu.wanted,
                                   menu.current),
                 long_notice_s);
    } else if (change_device(app, menu.wanted)) {  // else it is tried again: it may open later
        menu.wanted.clear();
    }
}

bool choose_device(World& app, const std::string& name) {
    DeviceChoice& choice = app.write<DeviceChoice>();
    choice.refusal.clear();
    if (name != choice.menu.current && !change_device(app, name)) return false;
    choice.menu.wanted.clear();
    if (is_stand_in(choice.menu, name)) {
        tell(app,
             format_translated("using for this session: {}; press D to go back",
                               app.resource<WindowHands>().all.front().device->spec().name),
             long_notice_s);
        return true;
    }
    const std::string problem = keep_choice(choice.menu.remember, name);
    if (!problem.empty()) tell(app, problem, long_notice_s);
    return true;
}

void choose_next_device(World& app) {
    const std::vector<DeviceOffer> offers = app.resource<DeviceChoice>().menu.offers;
    const auto current =
        std::ranges::find(offers, app.resource<DeviceChoice>().menu.current, &DeviceOffer::name);
    const std::size_t from = current == offers.end()
                                 ? offers.size() - 1
                                 : static_cast<std::size_t>(current - offers.begin());
    std::string refusals;
    for (std::size_t i = 1; i < offers.size(); ++i) {
        const DeviceOffer& next = offers[(from + i) % offers.size()];
        if (!next.is_there || next.is_stand_in) continue;
        if (choose_device(app, next.name)) {
            if (!refusals.empty())
                tell(app, refusals + app.resource<Notices>().text, long_notice_s);
            return;
        }
        refusals += app.resource<DeviceChoice>().refusal + "\n";
    }
    if (refusals.empty()) ask_for_stand_in(app);
}

bool switch_sound(World& app, bool is_on) {
    ForceTone& tone = app.write<ForceTone>();
    tone.speaker.reset();
    tone.rumble.reset();
    tone.is_on = is_on;
    tone.clicks = 0;  // what snapped before is not heard
    if (!is_on) return true;
    tone.rumble = std::make_shared<PadRumble>();
    try {
        tone.speaker = std::make_shared<Speaker>();
    } catch (const SoundError& error) {
        tone.is_on = tone.rumble->find();
        tell(app,
             tone.is_on ? format_translated("no tone: {}; the game pad rumbles", error.what())
                        : format_translated("no tone: {}", error.what()),
             long_notice_s);
    }
    return tone.is_on;
}

void choose_sound(World& app) {
    const bool is_on = !app.resource<ForceTone>().is_on;
    if (!switch_sound(app, is_on)) return;
    if (!is_on) {
        tell(app, translated("sound off"));
    } else if (app.resource<ForceTone>().speaker) {
        tell(app, translated("sound on: the higher and louder the tone, the stronger the force on "
                             "your hand; a click: something snapped"));
    }
    const std::string problem = keep_choice(options_of(app).sound.remember, is_on);
    if (!problem.empty()) tell(app, problem, long_notice_s);
}

// Whether the device itself lets a person feel the force.
bool plays_force(const Device& device) {
    const DeviceSpec& spec = device.spec();
    return spec.is_real && (spec.shakes || spec.peak_force_newton > 0);
}

// While paused the hand feels nothing.
void play_force(World& app) {
    ForceTone& sound = app.write<ForceTone>();
    const Readout& readout = frame_of(app).readout;
    if (readout.snap_step > sound.snap_step) ++sound.clicks;
    sound.snap_step = readout.snap_step;
    if (!sound.is_on) return;
    const double newton = readout.paused ? 0 : app.resource<WindowHands>().by_mouse().felt_newton;
    if (!plays_force(*app.resource<WindowHands>().by_mouse().device) && sound.rumble->find())
        sound.rumble->play(newton, sound.clicks);
    if (!sound.speaker) return;
    if (sound.speaker->is_there()) {
        Tone tone = tone_of(newton);
        tone.clicks = sound.clicks;
        return sound.speaker->play(tone);
    }
    sound.speaker.reset();
    tell(app, translated("no tone: the sound output was disconnected"), long_notice_s);
}

}  // namespace palpa
