// The checks on the way to a device, layer by layer: what was found, and how to fix what fails.
#pragma once
#include "devices/emulated_omni.h"
#include "haptics/device.h"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

enum class CheckOutcome {
    Ok,
    Unknown,  // cannot be determined; opening goes on
    Failed
};

struct DeviceCheck {
    std::string layer;  // "library", "bus", "permission" ...
    CheckOutcome outcome = CheckOutcome::Ok;
    std::string found;   // what was found, or why nothing was; lower case, no full stop
    std::string remedy;  // a command, or what to do by hand; empty if nothing needs fixing
};

// What is needed to open a device.
struct DeviceRequest {
    EmulatedOmniSettings emulated;  // settings of the emulated device and of the hand on it
    HandOrders* orders =
        nullptr;  // orders of a window, for devices that run on the servo's clock; may be null
    PadLink* pads = nullptr;          // game pads of a window; may be null
    std::filesystem::path file = {};  // file that a device plays, if it plays one
    std::filesystem::path system_root =
        "/";  // folder that contains /dev and /sys; tests use another one
};

struct OpenedDevice {
    std::unique_ptr<Device> device;   // null if the device cannot be used
    std::vector<DeviceCheck> checks;  // in order, up to the first failure that prevents the use
};

}  // namespace palpa
