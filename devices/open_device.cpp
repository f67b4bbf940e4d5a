#include "devices/open_device.h"

#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "devices/open_haptics.h"
#include "devices/sony_pad.h"
#include "devices/space_mouse.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace palpa {
namespace {

OpenedDevice open_emulated(const DeviceRequest& request) {
    return {std::make_unique<EmulatedOmni>(request.emulated),
            {{"emulation", CheckOutcome::Ok, "a Phantom Omni that is not there", ""}}};
}

constexpr std::array makers{
    DeviceMaker{"emulated", "a Phantom Omni that is not there, and a hand on it", true,
                open_emulated},
    DeviceMaker{"omni", "Phantom Omni or Touch, by its maker's OpenHaptics", false, open_omni},
    DeviceMaker{"spacemouse", "SpaceMouse: a cap that sets the handle's speed; no force", false,
                open_space_mouse},
    DeviceMaker{"dualsense", "DualSense game pad: sticks and gyroscope, stiff triggers", false,
                open_dualsense},
    DeviceMaker{"dualshock4", "DualShock 4 game pad: sticks and gyroscope, rumble", false,
                open_dualshock4},
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
