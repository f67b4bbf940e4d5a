#include "tests/support/hid_bus.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace palpa::test {
namespace {

void check(GError* error) {
    if (!error) return;
    const std::string message = error->message;
    g_error_free(error);
    throw std::runtime_error("umockdev: " + message);
}

std::vector<std::uint8_t> descriptor_of(const MockHid& device) {
    if (!device.descriptor.empty()) return device.descriptor;
    return {0x05, device.usage_page, 0x09, device.usage, 0xa1, 0x01, 0xc0};
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
        device.is_bluetooth ? 5 : 3, fmt::format("{:02X}", fmt::join(descriptor_of(device), "")),
        number, std::filesystem::path(paths[2]).filename().string());
}

// What a question comes with, and what is put into it as the answer.
class Argument {
public:
    explicit Argument(UMockdevIoctlClient* client)
        : client_(client),
          size_(_IOC_SIZE(umockdev_ioctl_client_get_request(client))),
          data_(umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, size_,
                                            nullptr)) {}
    Argument(const Argument&) = delete;
    Argument& operator=(const Argument&) = delete;
    ~Argument() { g_object_unref(data_); }

    std::span<const std::uint8_t> bytes() const { return {data_->data, size_}; }

    void give(std::span<const std::uint8_t> bytes) const {
        std::vector<std::uint8_t> some(bytes.begin(), bytes.end());
        some.resize(std::min(some.size(), size_));
        umockdev_ioctl_data_update(data_, 0, some.data(), static_cast<gint>(some.size()));
        done(some.size());
    }
    void done(std::size_t bytes) const {
        umockdev_ioctl_client_complete(client_, static_cast<glong>(bytes), 0);
    }
    void refuse(int why) const { umockdev_ioctl_client_complete(client_, -1, why); }

private:
    UMockdevIoctlClient* client_;
    std::size_t size_;
    UMockdevIoctlData* data_;
};

// Of all nodes, so that it is older than any: umockdev's thread meets a node at it for the first
// time.
std::mutex& nodes_mutex() {
    static std::mutex mutex;
    return mutex;
}

// A node from the device's side. Its questions are answered on a thread of umockdev's.
class Node {
public:
    Node(UMockdevTestbed* bed, std::string path, MockHid device)
        : bed_(bed),
          path_(std::move(path)),
          device_(std::move(device)),
          base_(umockdev_ioctl_base_new()) {
        g_signal_connect(base_, "handle-ioctl", G_CALLBACK(&Node::on_ioctl), this);
        GError* error = nullptr;
        umockdev_testbed_attach_ioctl(bed_, path_.c_str(), base_, &error);
        check(error);
    }
    Node(const Node&) = delete;
    Node& operator=(const Node&) = delete;
    ~Node() {
        umockdev_testbed_detach_ioctl(bed_, path_.c_str(), nullptr);
        g_object_unref(base_);
        // Behind the last answer.
        const std::lock_guard lock(nodes_mutex());
    }

    const MockHid& device() const { return device_; }

    // Shows it; what it is asked meanwhile waits.
    void plug(const std::string& text) {
        const std::lock_guard lock(nodes_mutex());
        GError* error = nullptr;
        umockdev_testbed_add_from_string(bed_, text.c_str(), &error);
        check(error);
        fd_ = umockdev_testbed_get_dev_fd(bed_, path_.c_str());
    }

    // The testbed keeps the node, and its own end of it, which it closes at its end.
    void hang_up() {
        const std::lock_guard lock(nodes_mutex());
        is_gone_ = true;
        const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
        dup2(nothing, fd_);
        close(nothing);
        const std::unique_ptr<gchar, decltype(&g_free)> root(umockdev_testbed_get_root_dir(bed_),
                                                             g_free);
        std::filesystem::remove(root.get() + path_);
    }

    void send(std::span<const std::uint8_t> report) const {
        if (write(fd_, report.data(), report.size()) != static_cast<ssize_t>(report.size())) {
            throw std::runtime_error("the report cannot be sent");
        }
    }

    std::vector<std::uint8_t> take_written() {
        const std::lock_guard lock(nodes_mutex());
        take_outputs();
        return std::exchange(written_, {});
    }

private:
    static gboolean on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client,
                             gpointer node) {
        static_cast<Node*>(node)->answer(client);
        return TRUE;
    }

    void answer(UMockdevIoctlClient* client) {
        const gulong request = umockdev_ioctl_client_get_request(client);
        const Argument argument(client);
        const std::lock_guard lock(nodes_mutex());
        take_outputs();
        if (is_gone_) return argument.refuse(ENODEV);
        if (request == HIDIOCGRDESCSIZE) return tell_size(argument);
        if (_IOC_NR(request) == _IOC_NR(HIDIOCSFEATURE(0))) return take_feature(argument);
        if (_IOC_NR(request) == _IOC_NR(HIDIOCGFEATURE(0))) return tell_feature(argument);
        argument.refuse(ENOTTY);
    }

    void tell_size(const Argument& argument) const {
        const int size = static_cast<int>(descriptor_of(device_).size());
        std::array<std::uint8_t, sizeof size> bytes{};
        std::memcpy(bytes.data(), &size, sizeof size);
        argument.give(bytes);
    }

    void take_feature(const Argument& argument) {
        const std::span<const std::uint8_t> report = argument.bytes();
        written_.insert(written_.end(), report.begin(), report.end());
        argument.done(report.size());
    }

    void tell_feature(const Argument& argument) {
        const auto answers = device_.features.find(argument.bytes()[0]);
        if (answers == device_.features.end()) return argument.refuse(EPIPE);
        argument.give(answers->second.front());
        if (answers->second.size() > 1) answers->second.erase(answers->second.begin());
    }

    void take_outputs() {
        std::array<std::uint8_t, 4096> some{};
        for (pollfd ready{fd_, POLLIN, 0};
             poll(&ready, 1, 0) > 0 && (ready.revents & POLLIN) != 0;) {
            const ssize_t count = read(fd_, some.data(), some.size());
            if (count <= 0) break;
            written_.insert(written_.end(), some.begin(), some.begin() + count);
        }
    }

    UMockdevTestbed* bed_;
    std::string path_;
    MockHid device_;
    UMockdevIoctlBase* base_;
    int fd_ = -1;
    bool is_gone_ = false;
    std::vector<std::uint8_t> written_;
};

}  // namespace

struct HidBus::Testbed {
    Testbed() : bed(umockdev_testbed_new()) {}
    Testbed(const Testbed&) = delete;
    Testbed& operator=(const Testbed&) = delete;
    ~Testbed() {
        nodes.clear();
        g_object_unref(bed);
    }

    UMockdevTestbed* bed;
    std::map<int, Node> nodes;  // also those that were unplugged: they may still be asked
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
    // The answers first: who finds the node asks at once.
    Node& node =
        testbed_->nodes.try_emplace(number, testbed_->bed, node_of(number), device).first->second;
    node.plug(text_of(number, device));
    return number;
}

void HidBus::unplug(int number) {
    Node& node = testbed_->nodes.at(number);
    const auto paths = paths_of(number, node.device());
    for (auto path = paths.rbegin(); path != paths.rend(); ++path) {
        umockdev_testbed_remove_device(testbed_->bed, ("/sys" + *path).c_str());
    }
    node.hang_up();
}

void HidBus::send(int number, std::span<const std::uint8_t> report) {
    testbed_->nodes.at(number).send(report);
}

std::vector<std::uint8_t> HidBus::take_written(int number) {
    return testbed_->nodes.at(number).take_written();
}

}  // namespace palpa::test
