// The devices that the program knows, by name: a list, written out.
#pragma once
#include "devices/device_check.h"

#include <span>
#include <string>
#include <string_view>

namespace palpa {

struct DeviceMaker {
    std::string_view name;       // as --device takes it
    std::string_view summary;    // what it is, in a few words
    bool is_emulated = false;    // always there, and its time is the servo's
    bool is_led = false;         // by the window's mouse and keys, where there is one
    bool needs_window = false;   // nobody leads it without one
    std::string_view file = {};  // of one that plays it, as --device NAME:FILE gives it; else empty
    // A quick look whether it is plugged in; null where that is not to be seen.
    bool (*is_there)(const DeviceRequest& request) = nullptr;
    // Looks at every layer in order and opens the device if it can. Plays no force. Never throws
    // because something is missing: the checks say so.
    OpenedDevice (*open)(const DeviceRequest& request) = nullptr;
};

// In the order in which they are listed. Another device is another line in open_device.cpp.
std::span<const DeviceMaker> device_makers() noexcept;

// `name` as --device takes it, with ":FILE" where the device plays one. Throws LoadError that lists
// the names, or says that the file is missing or too much.
const DeviceMaker& device_maker_called(const std::string& name);

// What stands behind the colon of such a name; empty: nothing.
std::string file_of(const std::string& name);

// With a device in it: otherwise throws LoadError that says which layer failed and what mends it.
// The file of the name takes the place of the request's.
OpenedDevice open_device(const std::string& name, DeviceRequest request);

}  // namespace palpa
