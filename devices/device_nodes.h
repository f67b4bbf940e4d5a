// What the system shows of devices that are plugged in, Linux's /sys and /dev: on other systems
// nothing is found.
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
    std::string where;                          // "USB 2988:0302 (Touch)"
    std::vector<std::filesystem::path> nodes;   // below /dev, that belong to it
    std::vector<std::filesystem::path> closed;  // of those, which this user may not read and write
};

// Whether this user may read and write it.
bool is_open_to_user(const std::filesystem::path& node);

// USB devices with one of these ids, with their serial and hidraw nodes. `root` stands for "/".
std::vector<FoundDevice> find_usb_devices(const std::filesystem::path& root,
                                          std::span<const UsbId> ids);

// The same with their node of the bus itself, for those that no driver of the system serves.
std::vector<FoundDevice> find_raw_usb_devices(const std::filesystem::path& root,
                                              std::span<const UsbId> ids);

// FireWire devices whose maker or model, in their own words, contains `name`, in any case.
std::vector<FoundDevice> find_firewire_devices(const std::filesystem::path& root,
                                               const std::string& name);

}  // namespace palpa
