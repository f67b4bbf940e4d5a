// The device in the hand, and the force as a tone.
#include "app/sandbox.h"

#include "core/load_error.h"
#include "core/translate.h"

#include <fmt/format.h>
#include <algorithm>
#include <utility>

namespace palpa {
namespace {

constexpr std::chrono::seconds device_look{1};

}  // namespace

// One that was wanted, and was not there, is taken when it comes.
void Sandbox::look_for_devices() {
    if (!can_choose_device() || SteadyClock::now() < next_look_) return;
    next_look_ = SteadyClock::now() + device_look;
    bool is_wanted_there = false;
    for (DeviceOffer& offer : devices_.offers) {
        offer.is_there = devices_.is_there(offer.name);
        is_wanted_there = is_wanted_there || (offer.name == devices_.wanted && offer.is_there);
    }
    if (!is_wanted_there) {
        refusal_.clear();
        if (!devices_.wanted.empty() && !std::exchange(has_looked_, true) && notice_.empty()) {
            notice(format_translated("{} is not connected; using until then: {}", devices_.wanted,
                                     devices_.current),
                   first_notice_s);
        }
    } else if (change_device(devices_.wanted)) {  // or it is tried again: a node may open later
        devices_.wanted.clear();
    }
}

bool Sandbox::change_device(const std::string& name) {
    WindowDevice next;
    try {
        next = devices_.open(name);
        session_.change_device(*next.device, next.orders, 0);
    } catch (const LoadError& error) {
        if (error.what() != refusal_) notice(error.what(), first_notice_s);
        refusal_ = error.what();
        return false;
    }
    refusal_.clear();
    chosen_ = std::move(next.device);
    WindowHand& first = hands_.front();
    first.device = chosen_.get();
    first.orders = next.orders;
    first.mouse_reach_m = next.mouse_reach_m;
    first.lead = MouseLead(first.mouse_reach_m);
    first.waiting_m = Vec3::Zero();
    devices_.current = name;
    notice(format_translated("device: {}", first.device->spec().name));
    return true;
}

bool Sandbox::choose_device(const std::string& name) {
    refusal_.clear();
    if (name != devices_.current && !change_device(name)) return false;
    devices_.wanted.clear();
    if (is_stand_in(name)) {
        notice(format_translated("using for this session: {}; press D to go back",
                                 hands_.front().device->spec().name),
               first_notice_s);
        return true;
    }
    try {
        devices_.remember(name);
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
    }
    return true;
}

bool Sandbox::is_stand_in(const std::string& name) const {
    return std::any_of(
        devices_.offers.begin(), devices_.offers.end(),
        [&](const DeviceOffer& offer) { return offer.name == name && offer.is_stand_in; });
}

void Sandbox::ask_for_stand_in() {
    const auto found = std::find_if(devices_.offers.begin(), devices_.offers.end(),
                                    [](const DeviceOffer& offer) { return offer.is_stand_in; });
    if (found == devices_.offers.end() || found->name == devices_.current) return;
    question_ = {
        format_translated(
            "No other device was found. Use an emulated device for this session ({})?",
            translated(found->summary.c_str())),
        {{Key::Y, translated("Yes (Y)"), [this, name = found->name] { (void)choose_device(name); }},
         {Key::Escape, translated("No (Esc)")}}};
}

// What is there and cannot be used is said, and passed over.
void Sandbox::choose_next_device() {
    if (!can_choose_device()) return;
    const auto& offers = devices_.offers;
    const auto current = std::find_if(offers.begin(), offers.end(), [&](const DeviceOffer& offer) {
        return offer.name == devices_.current;
    });
    const std::size_t from = current == offers.end()
                                 ? offers.size() - 1
                                 : static_cast<std::size_t>(current - offers.begin());
    std::string refusals;
    for (std::size_t i = 1; i < offers.size(); ++i) {
        const DeviceOffer& next = offers[(from + i) % offers.size()];
        if (!next.is_there || next.is_stand_in) continue;
        if (choose_device(next.name)) {
            if (!refusals.empty()) notice(refusals + notice_, first_notice_s);
            return;
        }
        refusals += refusal_ + "\n";
    }
    if (refusals.empty()) ask_for_stand_in();
}

// False where it stays off.
bool Sandbox::switch_sound(bool is_on) {
    speaker_.reset();
    if (!is_on) return true;
    try {
        speaker_.emplace();
    } catch (const SoundError& error) {
        notice(format_translated("no tone: {}", error.what()), first_notice_s);
        return false;
    }
    return true;
}

void Sandbox::choose_sound() {
    if (!switch_sound(!speaker_)) return;
    notice(speaker_ ? translated("sound on: the higher and louder the tone, the stronger the force")
                    : translated("sound off"));
    if (!options_.sound.remember) return;
    try {
        options_.sound.remember(speaker_.has_value());
    } catch (const LoadError& error) {
        notice(error.what(), first_notice_s);
    }
}

// While paused the hand feels nothing.
void Sandbox::play_force() {
    if (!speaker_) return;
    if (speaker_->is_there())
        return speaker_->play(tone_of(frame_.readout.paused ? 0 : hand().felt_newton));
    speaker_.reset();
    notice(translated("no tone: the sound output was disconnected"), first_notice_s);
}

}  // namespace palpa
