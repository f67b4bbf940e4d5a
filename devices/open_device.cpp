#include "devices/open_device.h"

#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "devices/mouse_handle.h"
#include "devices/open_haptics.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace palpa {
namespace {

OpenedDevice open_emulated(const DeviceRequest& request) {
    EmulatedOmniSettings settings = request.emulated;
    if (request.orders) settings.orders = request.orders;
    return {std::make_unique<EmulatedOmni>(settings),
            {{"emulation", CheckOutcome::Ok, "a Phantom Omni that is not there", ""}}};
}

OpenedDevice open_mouse(const DeviceRequest& request) {
    MouseHandleSettings settings = mouse_handle_of(request.emulated.hand);
    settings.orders = request.orders;
    return {std::make_unique<MouseHandle>(settings),
            {{"window", CheckOutcome::Ok, "mouse and keys of the window", ""}}};
}

constexpr std::array makers{
    DeviceMaker{.name = "emulated",
                .summary = "a Phantom Omni that is not there, and a hand on it",
                .is_emulated = true,
                .open = open_emulated},
    DeviceMaker{.name = "mouse",
                .summary = "mouse and keys: the force is seen as what the handle lags",
                .is_emulated = true,
                .is_led = true,
                .open = open_mouse},
    DeviceMaker{.name = "omni",
                .summary = "Phantom Omni or Touch, by its maker's OpenHaptics",
                .open = open_omni},
};

}  // namespace

std::span<const DeviceMaker> device_makers() noexcept { return makers; }

const DeviceMaker& device_maker_called(const std::string& name) {
    const auto* const found = std::find_if(
        makers.begin(), makers.end(), [&](const DeviceMaker& maker) { return maker.name == name; });
    if (found != makers.end()) return *found;
    std::vector<std::string_view> names;
    for (const DeviceMaker& maker : makers) names.push_back(maker.name);
    throw LoadError(
        {fmt::format("--device {}", name)},
        fmt::format("expected one of {}{}", fmt::join(names, ", "), near_name_hint(name, names)));
}

OpenedDevice open_device(const std::string& name, const DeviceRequest& request) {
    OpenedDevice opened = device_maker_called(name).open(request);
    if (opened.device) return opened;
    const DeviceCheck last = opened.checks.empty() ? DeviceCheck{} : opened.checks.back();
    throw LoadError({fmt::format("--device {}", name)},
                    fmt::format("{}: {}{}{}", last.layer, last.found,
                                last.remedy.empty() ? "" : "; ", last.remedy));
}

}  // namespace palpa
