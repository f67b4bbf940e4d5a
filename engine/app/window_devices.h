// The list of devices as a window offers it, and which of them it begins with.
#pragma once
#include "app/preferences.h"
#include "app/run_window.h"
#include "devices/device_check.h"
#include "haptics/hand.h"

#include <optional>
#include <string>

namespace palpa {

// What a person at a window without a choice of their own is given: no motor moves before somebody
// has asked for it.
inline constexpr const char* first_device = "mouse";

// Those that a person may choose from, and whether each is there.
std::vector<DeviceOffer> list_device_offers(const DeviceRequest& request);

// One window's. It and the preferences must outlive the window.
class WindowDevices {
public:
    // `emulated`: with a mouse in its hand's place.
    WindowDevices(const EmulatedOmniSettings& emulated, PreferencesFile& preferences);

    // The one that was asked for, or else the one that was chosen last, or else the first. Throws
    // LoadError where the first of these cannot be opened; where the second cannot, says so in
    // notice() and opens the third.
    WindowDevice open_first(const std::optional<std::string>& asked);

    // Of what open_first() had to say, one line; empty where all is well.
    const std::string& notice() const noexcept { return notice_; }

    DeviceMenu menu();
    PadLink& pads() noexcept { return pads_; }

private:
    WindowDevice open(const std::string& name);

    DeviceRequest request_;
    PreferencesFile& preferences_;
    HandOrders orders_;
    PadLink pads_;
    std::string current_, wanted_, notice_;
};

// The device in a scene's second hand, the one that was asked for, or else the arrow keys'.
// `orders` are its hand's. Throws LoadError where it cannot be opened.
WindowDevice open_second(const std::optional<std::string>& asked,
                         const EmulatedOmniSettings& emulated, HandOrders& orders, PadLink& pads);

}  // namespace palpa
