// Human interface devices on USB and Bluetooth, through hidapi: which there are, and a line to one.
// https://github.com/libusb/hidapi, 0.13; on Linux its hidraw form.
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

// One usage of one interface of a device that is plugged in.
struct HidPlace {
    std::string path;  // "/dev/hidraw3"
    UsbId id;
    std::uint16_t usage_page = 0, usage = 0;  // 0 where the system does not tell
    bool is_bluetooth = false;
    std::string product;  // in its own words
};

// A report with its number first; 0 of a device that does not number them.
using HidBytes = std::span<const std::uint8_t>;

// The longest report of the devices here is 78 bytes; a hidraw read cuts what is longer.
inline constexpr std::size_t longest_hid_report = 128;

// Empty where hidapi cannot be used.
std::vector<HidPlace> list_hids();

// "0.13.1", or empty where hidapi cannot be used.
std::string hidapi_version();

// What a device says of its reports (devices/hid_descriptor.h): hidapi 0.13 does not give it, so it
// is Linux's /sys that is read. Empty elsewhere, and where it cannot be read.
std::vector<std::uint8_t> read_report_descriptor(const std::string& path);

// Whether a line of this program is open to it.
bool is_in_use(const std::string& path);

// Used by one thread.
class HidLine {
public:
    // False where it cannot be opened, and why() says why: one line to a path at a time.
    bool open(const std::string& path);
    void close() noexcept { handle_.reset(); }
    bool is_open() const noexcept { return handle_ != nullptr; }
    const std::string& why() const noexcept { return why_; }

    // Waits for a report for as long. Its bytes in `into`; 0: none came; -1: the device is gone.
    int read(std::span<std::uint8_t> into, int wait_ms) noexcept;

    // False: the device is gone.
    bool write(HidBytes report) noexcept;

    // The same for a feature report.
    bool write_feature(HidBytes report) noexcept;

    // Asks for the feature report of a number. How many bytes came `into`, the number first; -1:
    // the device gives none.
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
