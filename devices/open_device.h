// The list of all devices by name, and how to open one.
#pragma once
#include "devices/device_check.h"

#include <span>
#include <string>
#include <string_view>

namespace palpa {

struct DeviceMaker {
    std::string_view name;       // name for --device
    std::string_view summary;    // short description
    bool is_emulated = false;    // always available; runs on the servo's clock
    bool is_led = false;         // moved by the window's mouse and keys, if there is a window
    bool needs_window = false;   // cannot be used without a window
    std::string_view file = {};  // name in the help of what follows in --device NAME:FILE, such as
                                 // "FOLDER"; empty for devices without a file
    // Quick check whether the device is connected; null if that cannot be checked.
    bool (*is_there)(const DeviceRequest& request) = nullptr;
    // Checks every layer in order and opens the device if possible. Sends no force. Does not throw
    // if something is missing: the checks report it.
    OpenedDevice (*open)(const DeviceRequest& request) = nullptr;
};

// In listing order. To add a device, add a line in open_device.cpp.
std::span<const DeviceMaker> device_makers() noexcept;

// The maker for `name` as given to --device, with ":FILE" if the device plays a file. Throws
// LoadError that lists the names, or says that the file is missing or not allowed.
const DeviceMaker& device_maker_called(const std::string& name);

// The part of such a name after the colon; empty: none.
std::string file_of(const std::string& name);

// Opens the device. Throws LoadError with the failed layer and its remedy. The file in the name
// replaces the one of the request.
OpenedDevice open_device(const std::string& name, DeviceRequest request);

}  // namespace palpa
