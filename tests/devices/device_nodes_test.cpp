#include "devices/device_nodes.h"

#include "tests/support/temporary_folder.h"

#include <array>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

using namespace palpa;
namespace fs = std::filesystem;

namespace {

void write_line(const fs::path& file, const std::string& line) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << line << '\n';
}

// A Touch with a serial and a HID interface, as Linux shows it, and a mouse beside it.
void plug_in_touch(const fs::path& root) {
    const fs::path hub = root / "sys/devices/pci0/usb1";
    write_line(hub / "1-2/idVendor", "2988");
    write_line(hub / "1-2/idProduct", "0302");
    write_line(hub / "1-2/product", "Touch");
    fs::create_directories(hub / "1-2/1-2:1.0/tty/ttyACM3");
    fs::create_directories(hub / "1-2/1-2:1.1/0003:2988:0302.0001/hidraw/hidraw5");
    write_line(hub / "1-3/idVendor", "046d");
    write_line(hub / "1-3/idProduct", "c077");
    fs::create_directories(hub / "1-3/1-3:1.0/0003:046D:C077.0002/hidraw/hidraw0");
    const auto link = [&](const fs::path& to, const fs::path& from) {
        fs::create_directories(from.parent_path());
        fs::create_directory_symlink(to, from);
    };
    link(hub / "1-2", root / "sys/bus/usb/devices/1-2");
    link(hub / "1-3", root / "sys/bus/usb/devices/1-3");
    link(hub / "1-2/1-2:1.0", root / "sys/class/tty/ttyACM3/device");
    link(hub / "1-2/1-2:1.1/0003:2988:0302.0001", root / "sys/class/hidraw/hidraw5/device");
    link(hub / "1-3/1-3:1.0/0003:046D:C077.0002", root / "sys/class/hidraw/hidraw0/device");
    fs::create_directories(root / "sys/class/tty/tty0");
}

constexpr std::array contact{UsbId{0x2988, 0x0302}};

}  // namespace

TEST_CASE("a USB device is found with its serial and hidraw nodes", "[devices][nodes]") {
    const test::TemporaryFolder folder;
    plug_in_touch(folder.path());
    write_line(folder.path() / "dev/ttyACM3", "");

    const auto found = find_usb_devices(folder.path(), contact);

    REQUIRE(found.size() == 1);
    CHECK(found[0].where == "USB 2988:0302 (Touch)");
    REQUIRE(found[0].nodes.size() == 2);
    CHECK(found[0].nodes[0] == folder.path() / "dev/hidraw5");
    CHECK(found[0].nodes[1] == folder.path() / "dev/ttyACM3");
    // The one that is not there cannot be opened either, by root no more than by others.
    REQUIRE(found[0].closed.size() == 1);
    CHECK(found[0].closed[0] == folder.path() / "dev/hidraw5");
}

TEST_CASE("a FireWire device is found by its maker's name", "[devices][nodes]") {
    const test::TemporaryFolder folder;
    const fs::path devices = folder.path() / "sys/bus/firewire/devices";
    write_line(devices / "fw0/vendor_name", "Linux Firewire");
    write_line(devices / "fw1/vendor_name", "SensAble Technologies");
    write_line(devices / "fw1/model_name", "PHANTOM Omni");
    write_line(folder.path() / "dev/fw1", "");

    const auto found = find_firewire_devices(folder.path(), "sensable");

    REQUIRE(found.size() == 1);
    CHECK(found[0].where == "FireWire fw1 (SensAble Technologies PHANTOM Omni)");
    CHECK(found[0].nodes == std::vector<fs::path>{folder.path() / "dev/fw1"});
    CHECK(found[0].closed.empty());
}

TEST_CASE("where the system shows nothing nothing is found", "[devices][nodes]") {
    CHECK(find_usb_devices("/nowhere", contact).empty());
    CHECK(find_firewire_devices("/nowhere", "sensable").empty());
}
