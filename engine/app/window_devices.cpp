#include "app/window_devices.h"

#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_hand.h"
#include "devices/open_device.h"

#include <fmt/format.h>
#include <memory>
#include <utility>

namespace palpa {
namespace {

// What cannot be seen may well be there.
bool is_there(const DeviceMaker& maker, const DeviceRequest& request) {
    return maker.is_emulated || !maker.is_there || maker.is_there(request);
}

// What a person has to do although the device could be opened.
void print_failed_checks(const OpenedDevice& opened) {
    for (const DeviceCheck& check : opened.checks) {
        if (check.outcome != CheckOutcome::Failed) continue;
        fmt::print(stderr, "warning: {}: {}; {}\n", check.layer, printable(check.found),
                   check.remedy);
    }
}

}  // namespace

WindowDevices::WindowDevices(const EmulatedOmniSettings& emulated, PreferencesFile& preferences)
    : preferences_(preferences) {
    request_.emulated = emulated;
    request_.orders = &orders_;
    request_.pads = &pads_;
}

WindowDevice WindowDevices::open_first(const std::optional<std::string>& asked) {
    const std::optional<std::string>& chosen = preferences_.now().device;
    notice_ = preferences_.problem();
    if (!asked && chosen) {
        try {
            const DeviceMaker& maker = device_maker_called(*chosen);
            wanted_ = *chosen;
            // Whether a pad is there only the window can tell, which is not open yet.
            if (!maker.needs_window || is_there(maker, request_)) {
                WindowDevice opened = open(wanted_);
                current_ = std::exchange(wanted_, {});
                return opened;
            }
        } catch (const LoadError& error) {
            notice_ =
                wanted_.empty()
                    ? fmt::format("{}; using until then: {}", error.what(), first_device)
                    : fmt::format(
                          "{}, the device used last, cannot be used now; using until then: {}",
                          wanted_, first_device);
        }
    }
    current_ = asked.value_or(first_device);
    return open(current_);
}

WindowDevice WindowDevices::open(const std::string& name) {
    const DeviceMaker& maker = device_maker_called(name);
    OpenedDevice opened = open_device(name, request_);
    print_failed_checks(opened);
    return {std::move(opened.device), maker.is_emulated ? &orders_ : nullptr,
            maker.is_led ? mouse_reach_m(request_.emulated) : 0};
}

std::vector<DeviceOffer> list_device_offers(const DeviceRequest& request) {
    std::vector<DeviceOffer> offers;
    for (const DeviceMaker& maker : device_makers()) {
        if (!maker.file.empty()) continue;
        offers.push_back({.name = std::string(maker.name),
                          .summary = std::string(maker.summary),
                          .is_there = is_there(maker, request),
                          .is_stand_in = maker.is_emulated && !maker.needs_window});
    }
    return offers;
}

DeviceMenu WindowDevices::menu() {
    DeviceMenu menu;
    menu.offers = list_device_offers(request_);
    menu.current = current_;
    menu.wanted = wanted_;
    menu.is_there = [this](const std::string& name) {
        return palpa::is_there(device_maker_called(name), request_);
    };
    menu.open = [this](const std::string& name) { return open(name); };
    menu.remember = [this](const std::string& name) {
        Preferences preferences = preferences_.now();
        preferences.device = name;
        preferences_.keep(preferences);
    };
    return menu;
}

WindowDevice open_second(const std::optional<std::string>& asked,
                         const EmulatedOmniSettings& emulated, HandOrders& orders, PadLink& pads) {
    const std::string name = asked.value_or(first_device);
    const DeviceMaker& maker = device_maker_called(name);
    OpenedDevice opened =
        open_device(name, {.emulated = emulated, .orders = &orders, .pads = &pads});
    print_failed_checks(opened);
    return {std::move(opened.device), maker.is_emulated ? &orders : nullptr,
            maker.is_led ? mouse_reach_m(emulated) : 0};
}

}  // namespace palpa
