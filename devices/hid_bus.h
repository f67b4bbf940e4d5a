// Lists human interface devices (HID) on USB and Bluetooth, and opens a connection to one, through
// hidapi. https://github.com/libusb/hidapi, 0.13; on Linux its hidraw variant.
#pragma once
#include "devices/device_nodes.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct hid_device_;

namespace palpa {

// Usages of devices that are played with, of the generic desktop page (HID Usage Tables 1.5, 4.1).
namespace hid_usage {
inline constexpr std::uint16_t generic_desktop_page = 1;
inline constexpr std::uint16_t joystick = 4, game_pad = 5, multi_axis_controller = 8;
}  // namespace hid_usage

// One usage of one interface of a device that is plugged in.
struct HidPlace {
    std::string path;  // "/dev/hidraw3"
    UsbId id;
    std::uint16_t usage_page = 0, usage = 0;  // 0 if the system does not report it
    bool is_bluetooth = false;
    std::string product;  // product name as the device reports it
};

// A report that begins with its number; 0 for a device without report numbers.
using HidBytes = std::span<const std::uint8_t>;

// The longest report of the supported devices has 78 bytes; a hidraw read cuts longer ones.
inline constexpr std::size_t longest_hid_report = 128;

// Empty if hidapi cannot be used.
std::vector<HidPlace> list_hids();

// Such as "0.13.1"; empty if hidapi cannot be used.
std::string hidapi_version();

// The report descriptor of a device (devices/hid_descriptor.h). hidapi 0.13 does not provide it, so
// it is read from Linux's /sys. Empty on other systems, and if it cannot be read.
std::vector<std::uint8_t> read_report_descriptor(const std::string& path);

// Whether this program has a connection to it.
bool is_in_use(const std::string& path);

// A connection to one device, for use by one thread.
class HidLine {
public:
    // False if it cannot be opened; why() gives the reason. Only one connection to a path at a
    // time.
    bool open(const std::string& path);
    void close() noexcept { handle_.reset(); }
    bool is_open() const noexcept { return handle_ != nullptr; }
    const std::string& why() const noexcept { return why_; }

    // Waits up to `wait_ms` for a report and copies it to `into`. Returns its number of bytes; 0:
    // no report; -1: the device is gone.
    int read(std::span<std::uint8_t> into, int wait_ms) noexcept;

    // Returns false if the device is gone.
    bool write(HidBytes report) noexcept;

    // The same for a feature report.
    bool write_feature(HidBytes report) noexcept;

    // Reads the feature report with this number into `into`, which begins with the number. Returns
    // the number of bytes; -1: the device does not provide it.
    int read_feature(std::uint8_t number, std::span<std::uint8_t> into) noexcept;

private:
    struct Closer {
        std::string path;
        void operator()(hid_device_* handle) const noexcept;
    };
    std::unique_ptr<hid_device_, Closer> handle_;
    std::string why_;
};

}  // namespace palpa
