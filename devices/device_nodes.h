// Finds connected devices in Linux's /sys and /dev. On other systems nothing is found.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace palpa {

struct UsbId {
    std::uint16_t vendor = 0, product = 0;
    bool operator==(const UsbId&) const = default;
};

struct FoundDevice {
    std::string where;                         // "USB 2988:0302 (Touch)"
    std::vector<std::filesystem::path> nodes;  // nodes below /dev that belong to the device
    std::vector<std::filesystem::path>
        closed;  // those of them that this user may not read and write
};

// Whether this user may read and write the node.
bool is_open_to_user(const std::filesystem::path& node);

// The remedy if this user may not read or write a device: on Linux shell commands with the rules
// that were installed with the program, or those of the source tree.
std::string permission_remedy();

// Finds USB devices with one of these ids, with their serial and hidraw nodes. `root` is the folder
// that contains /sys and /dev.
std::vector<FoundDevice> find_usb_devices(const std::filesystem::path& root,
                                          std::span<const UsbId> ids);

// The same with the node of the device on the bus itself, for devices without a system driver.
std::vector<FoundDevice> find_raw_usb_devices(const std::filesystem::path& root,
                                              std::span<const UsbId> ids);

// Finds FireWire devices whose maker or model name contains `name`, in upper or lower case.
std::vector<FoundDevice> find_firewire_devices(const std::filesystem::path& root,
                                               const std::string& name);

}  // namespace palpa
