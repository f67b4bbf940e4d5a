// What stands between the program and a device, layer by layer: there or not, and what mends it.
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
    Unknown,  // cannot be seen from here; no reason to give up
    Failed
};

struct DeviceCheck {
    std::string layer;  // "library", "bus", "permission" ...
    CheckOutcome outcome = CheckOutcome::Ok;
    std::string found;   // what is there, or why nothing is; lower case, no full stop
    std::string remedy;  // a command, or what to do by hand; empty where nothing has to be mended
};

// Where a node below /dev is closed to the user.
inline constexpr std::string_view udev_remedy =
    "sudo cp devices/udev/70-palpa.rules /etc/udev/rules.d/ && sudo udevadm control --reload && "
    "sudo udevadm trigger";

// What whoever opens a device knows of its surroundings.
struct DeviceRequest {
    EmulatedOmniSettings emulated;            // of devices that are not there, and the hand
    HandOrders* orders = nullptr;             // of a window, for those on the servo's ticks
    PadLink* pads = nullptr;                  // of a window, which sees game pads
    std::filesystem::path file = {};          // that a device plays
    std::filesystem::path system_root = "/";  // above /dev and /sys; another one in tests
};

struct OpenedDevice {
    std::unique_ptr<Device> device;   // null where it cannot be used
    std::vector<DeviceCheck> checks;  // in order, to the first one that it cannot do without
};

}  // namespace palpa
