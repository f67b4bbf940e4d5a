// The devices that a window offers, and the choice of the first one.
#pragma once
#include "app/preferences.h"
#include "app/run_window.h"
#include "devices/device_check.h"
#include "haptics/hand.h"

#include <optional>
#include <string>

namespace palpa {

// The default device of a window: no motor moves before somebody has chosen a device with motors.
inline constexpr const char* first_device = "mouse";

// The devices to choose from, and whether each is connected.
std::vector<DeviceOffer> list_device_offers(const DeviceRequest& request);

// The devices of one window. It and the preferences must outlive the window.
class WindowDevices {
public:
    // `emulated`: settings of the emulated device, moved by the mouse.
    WindowDevices(const EmulatedOmniSettings& emulated, PreferencesFile& preferences);

    // Opens the requested device, else the one chosen last, else the default. Throws LoadError if
    // the requested one cannot be opened; if the one chosen last cannot, notice() says so and the
    // default is opened.
    WindowDevice open_first(const std::optional<std::string>& asked);

    // The notice of open_first(), one line; empty if there is none.
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

// Opens the device of the second hand: the requested one, else the arrow keys. `orders`: of its
// hand. Throws LoadError if it cannot be opened.
WindowDevice open_second(const std::optional<std::string>& asked,
                         const EmulatedOmniSettings& emulated, HandOrders& orders, PadLink& pads);

}  // namespace palpa
