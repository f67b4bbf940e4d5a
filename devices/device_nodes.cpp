#include "devices/device_nodes.h"

#include "core/files.h"
#include "core/shell_word.h"
#include "core/text.h"
#include "platform/file.h"
#include "platform/program.h"
#include "platform/system.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <optional>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

// Its first line; empty where it cannot be read.
std::string first_line(const fs::path& file) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    return line;
}

std::uint16_t hex(const std::string& text) {
    std::uint16_t value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value, 16);
    return value;
}

// The USB device is the one above that has an id.
fs::path usb_device_above(const fs::path& node) {
    std::error_code error;
    fs::path folder = fs::canonical(node, error);
    if (error) return {};
    while (folder.has_relative_path()) {
        if (fs::exists(folder / "idVendor", error)) return folder;
        folder = folder.parent_path();
    }
    return {};
}

void add_node(const fs::path& node, FoundDevice& device) {
    device.nodes.push_back(node);
    if (!is_open_to_user(node)) device.closed.push_back(node);
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

}  // namespace

std::string permission_remedy() {
    if (system_name() != "Linux") return "close other programs that use it";
    const fs::path program = find_program_file().parent_path();
    const fs::path installed = (program / "../lib/udev/rules.d/70-palpa.rules").lexically_normal();
    std::error_code error;
    const bool is_installed = !program.empty() && fs::exists(installed, error);
    return fmt::format(
        "sudo cp {} /etc/udev/rules.d/ && sudo udevadm control --reload && sudo "
        "udevadm trigger",
        is_installed ? shell_word(installed.string()) : "devices/udev/70-palpa.rules");
}

bool is_open_to_user(const fs::path& node) { return may_read_and_write(node); }

namespace {

// With its folder in /sys, beside each other.
struct UsbDevices {
    std::vector<FoundDevice> found;
    std::vector<fs::path> folders;
};

UsbDevices list_usb_devices(const fs::path& root, std::span<const UsbId> ids) {
    UsbDevices all;
    for (const fs::path& folder : list_folder(root / "sys/bus/usb/devices")) {
        const UsbId id{hex(first_line(folder / "idVendor")), hex(first_line(folder / "idProduct"))};
        if (std::find(ids.begin(), ids.end(), id) == ids.end()) continue;
        const std::string product = first_line(folder / "product");
        FoundDevice device;
        device.where = fmt::format("USB {:04x}:{:04x}{}", id.vendor, id.product,
                                   product.empty() ? "" : " (" + product + ")");
        all.found.push_back(device);
        std::error_code error;
        all.folders.push_back(fs::canonical(folder, error));
    }
    return all;
}

}  // namespace

std::vector<FoundDevice> find_usb_devices(const fs::path& root, std::span<const UsbId> ids) {
    auto [found, folders] = list_usb_devices(root, ids);
    for (const char* kind : {"hidraw", "tty"}) {
        for (const fs::path& node : list_folder(root / "sys/class" / kind)) {
            const fs::path above = usb_device_above(node / "device");
            for (std::size_t i = 0; i < found.size(); ++i) {
                if (above.empty() || above != folders[i]) continue;
                add_node(root / "dev" / node.filename(), found[i]);
            }
        }
    }
    return found;
}

std::vector<FoundDevice> find_raw_usb_devices(const fs::path& root, std::span<const UsbId> ids) {
    auto [found, folders] = list_usb_devices(root, ids);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const std::optional<std::int64_t> bus = find_integer(first_line(folders[i] / "busnum")),
                                          device = find_integer(first_line(folders[i] / "devnum"));
        if (!bus || !device) continue;
        add_node(root / "dev/bus/usb" / fmt::format("{:03}", *bus) / fmt::format("{:03}", *device),
                 found[i]);
    }
    return found;
}

std::vector<FoundDevice> find_firewire_devices(const fs::path& root, const std::string& name) {
    std::vector<FoundDevice> found;
    for (const fs::path& folder : list_folder(root / "sys/bus/firewire/devices")) {
        const std::string words =
            first_line(folder / "vendor_name") + " " + first_line(folder / "model_name");
        if (lower(words).find(lower(name)) == std::string::npos) continue;
        FoundDevice device;
        device.where = fmt::format("FireWire {} ({})", folder.filename().string(), words);
        add_node(root / "dev" / folder.filename(), device);
        found.push_back(device);
    }
    return found;
}

}  // namespace palpa
