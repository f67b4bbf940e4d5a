#include "tests/support/hid_bus.h"

#include "tests/support/temporary_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <umockdev.h>
#include <unistd.h>
#include <array>
#include <map>
#include <stdexcept>

namespace palpa::test {
namespace {

void check(GError* error) {
    if (!error) return;
    const std::string message = error->message;
    g_error_free(error);
    throw std::runtime_error("umockdev: " + message);
}

// The shortest one that names a usage.
std::string descriptor_of(const MockHid& device) {
    return fmt::format("05{:02X}09{:02X}A101C0", device.usage_page, device.usage);
}

std::string node_of(int number) { return fmt::format("/dev/hidraw{}", number); }

// Where it hangs in /sys: from the top down to the node.
std::array<std::string, 4> paths_of(int number, const MockHid& device) {
    const std::string usb = fmt::format("/devices/pci0000:00/usb1/1-{}", number + 1);
    const std::string interface = fmt::format("{}/1-{}:1.0", usb, number + 1);
    const std::string hid =
        fmt::format("{}/{:04X}:{:04X}:{:04X}.{:04X}", interface, device.is_bluetooth ? 5 : 3,
                    device.vendor, device.product, number + 1);
    return {usb, interface, hid, fmt::format("{}/hidraw/hidraw{}", hid, number)};
}

std::string text_of(int number, const MockHid& device) {
    const auto paths = paths_of(number, device);
    return fmt::format(
        "P: {0}\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n"
        "A: idVendor={4:04x}\\n\nA: idProduct={5:04x}\\n\n"
        "A: manufacturer=nobody\\n\nA: product={6}\\n\nA: bcdDevice=0100\\n\n\n"
        "P: {1}\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n\n"
        "P: {2}\nE: SUBSYSTEM=hid\nE: HID_ID={7:04X}:{4:08X}:{5:08X}\nE: HID_NAME={6}\n"
        "E: HID_UNIQ=\nH: report_descriptor={8}\n\n"
        "P: {3}\nN: hidraw{9}\nE: SUBSYSTEM=hidraw\nE: DEVNAME=/dev/hidraw{9}\n"
        "L: device=../../../{10}\n",
        paths[0], paths[1], paths[2], paths[3], device.vendor, device.product, device.name,
        device.is_bluetooth ? 5 : 3, descriptor_of(device), number,
        std::filesystem::path(paths[2]).filename().string());
}

// The two questions that hidapi asks of a node.
std::string ioctls_of(int number, const MockHid& device) {
    const std::string descriptor = descriptor_of(device);
    const auto size = descriptor.size() / 2;
    return fmt::format("@DEV {}\nHIDIOCGRDESCSIZE 0 {:02X}000000\nHIDIOCGRDESC 0 {} {}\n",
                       node_of(number), size, size, descriptor);
}

}  // namespace

struct HidBus::Testbed {
    Testbed() : bed(umockdev_testbed_new()) {}
    Testbed(const Testbed&) = delete;
    Testbed& operator=(const Testbed&) = delete;
    ~Testbed() { g_object_unref(bed); }

    // The testbed keeps the node, and its own end of it, which it closes at its end.
    void hang_up(const std::string& node) const {
        const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
        dup2(nothing, umockdev_testbed_get_dev_fd(bed, node.c_str()));
        close(nothing);
        const std::unique_ptr<gchar, decltype(&g_free)> root(umockdev_testbed_get_root_dir(bed),
                                                             g_free);
        std::filesystem::remove(root.get() + node);
    }

    UMockdevTestbed* bed;
    TemporaryFolder folder;
    std::map<int, MockHid> plugged;
    int next = 0;
};

HidBus::HidBus() : testbed_(std::make_unique<Testbed>()) {
    // It knows that only with a testbed.
    if (!umockdev_in_mock_environment()) {
        throw std::runtime_error("start it as 'umockdev-wrapper PROGRAM', of package umockdev");
    }
}

HidBus::~HidBus() = default;

int HidBus::plug(const MockHid& device) {
    const int number = testbed_->next++;
    GError* error = nullptr;
    // The answers first: who finds the node asks at once.
    const auto ioctls = testbed_->folder.add_file("ioctls", ioctls_of(number, device));
    umockdev_testbed_load_ioctl(testbed_->bed, nullptr, ioctls.c_str(), &error);
    check(error);
    umockdev_testbed_add_from_string(testbed_->bed, text_of(number, device).c_str(), &error);
    check(error);
    testbed_->plugged[number] = device;
    return number;
}

void HidBus::unplug(int number) {
    const auto paths = paths_of(number, testbed_->plugged.at(number));
    for (auto path = paths.rbegin(); path != paths.rend(); ++path) {
        umockdev_testbed_remove_device(testbed_->bed, ("/sys" + *path).c_str());
    }
    testbed_->hang_up(node_of(number));
    testbed_->plugged.erase(number);
}

void HidBus::send(int number, std::span<const std::uint8_t> report) {
    const int fd = umockdev_testbed_get_dev_fd(testbed_->bed, node_of(number).c_str());
    const auto size = static_cast<ssize_t>(report.size());
    if (fd < 0 || write(fd, report.data(), report.size()) != size) {
        throw std::runtime_error("the report cannot be sent");
    }
}

std::vector<std::uint8_t> HidBus::take_written(int number) {
    const int fd = umockdev_testbed_get_dev_fd(testbed_->bed, node_of(number).c_str());
    std::vector<std::uint8_t> bytes;
    std::array<std::uint8_t, 4096> some{};
    for (pollfd ready{fd, POLLIN, 0}; poll(&ready, 1, 0) > 0 && (ready.revents & POLLIN) != 0;) {
        const ssize_t count = read(fd, some.data(), some.size());
        if (count <= 0) break;
        bytes.insert(bytes.end(), some.begin(), some.begin() + count);
    }
    return bytes;
}

}  // namespace palpa::test
