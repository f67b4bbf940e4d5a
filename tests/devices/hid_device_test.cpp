#include "devices/hid_device.h"

#include "devices/open_device.h"
#include "devices/sony_pad.h"
#include "devices/space_mouse.h"
#include "tests/support/hid_reports.h"
#include "tests/support/wait_until.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <string>

using namespace palpa;
using test::Bytes;
using test::wait_until;

namespace {

// Nothing in these tests lasts; where time is what is tested, it is short, and else endless.
constexpr HidSettings patient{.retry_s = 1e-3, .stale_s = 1e3, .silent_s = 1e3, .is_paced = false};

HidDevice& opened_hid(const OpenedDevice& opened) {
    REQUIRE(opened.device);
    return dynamic_cast<HidDevice&>(*opened.device);
}

const DeviceCheck* find_check(const OpenedDevice& opened, const std::string& layer) {
    for (const DeviceCheck& check : opened.checks) {
        if (check.layer == layer) return &check;
    }
    return nullptr;
}

OpenedDevice open_cap(const HidSettings& settings = patient) {
    return open_hid(std::make_unique<SpaceMouseProtocol>(), settings);
}

OpenedDevice open_pad(SonyModel model, const HidSettings& settings = patient) {
    return open_hid(std::make_unique<SonyPadProtocol>(model), settings);
}

// One report to the device, until it has been read and answered.
void tell(test::HidBus& bus, int number, const HidDevice& device, const Bytes& report) {
    const std::uint64_t before = device.reports();
    bus.send(number, report);
    wait_until([&] { return device.reports() > before; });
}

// How far the handle goes in so many ticks.
Vec3 way_of(Device& device, int ticks) {
    const Vec3 from = device.read().position_m;
    Vec3 to = from;
    for (int i = 0; i < ticks; ++i) to = device.read().position_m;
    return to - from;
}

// What was written last: reports of that size, one after the other.
Bytes last_report(Bytes written, std::size_t size) {
    REQUIRE(written.size() >= size);
    REQUIRE(written.size() % size == 0);
    return {written.end() - static_cast<std::ptrdiff_t>(size), written.end()};
}

}  // namespace

TEST_CASE("without a device the checks end at the bus, and name the mice that are none",
          "[devices][hid]") {
    test::HidBus bus;
    bus.plug({0x256f, 0xc650, 1, 2, false, "CadMouse"});

    const OpenedDevice opened = open_space_mouse({});

    CHECK_FALSE(opened.device);
    REQUIRE(opened.checks.size() == 2);
    CHECK(opened.checks[0].layer == "library");
    CHECK(opened.checks[0].outcome == CheckOutcome::Ok);
    CHECK(opened.checks[1].layer == "bus");
    CHECK(opened.checks[1].outcome == CheckOutcome::Failed);
    CHECK_THAT(opened.checks[1].found, Catch::Contains("no SpaceMouse among the 1 input devices") &&
                                           Catch::Contains("256f:c650 is a mouse or a keyboard"));
    CHECK_FALSE(opened.checks[1].remedy.empty());
}

TEST_CASE("a device is found among others, by the face that speaks", "[devices][hid]") {
    test::HidBus bus;
    bus.plug({0x046d, 0xc077, 1, 2, false, "a mouse"});
    bus.plug({0x256f, 0xc652, 1, 6, false, "the receiver's keyboard"});
    const int number = bus.plug({0x256f, 0xc652, 1, 8, false, "Universal Receiver"});
    bus.plug(test::dualsense_hid);

    const OpenedDevice opened = open_cap();
    HidDevice& device = opened_hid(opened);
    tell(bus, number, device, test::pushed_cap(Vec3(1, 0, 0)));

    CHECK(device.spec().name == "Universal Receiver");
    CHECK(device.spec().peak_force_newton == 0);
    CHECK(device.understood() == 1);
    CHECK_THAT(find_check(opened, "bus")->found,
               Catch::Contains("256f:c652 by cable, /dev/hidraw2"));
    CHECK(find_check(opened, "permission")->outcome == CheckOutcome::Ok);
    CHECK(find_check(opened, "reports")->outcome == CheckOutcome::Unknown);  // nobody touched it
}

TEST_CASE("a pad that is silent is told from one that speaks", "[devices][hid]") {
    test::HidBus bus;
    bus.plug(test::dualshock4_hid);

    const OpenedDevice opened = open_pad(SonyModel::DualShock4);

    CHECK(opened.device);
    CHECK(find_check(opened, "reports")->outcome == CheckOutcome::Failed);
    CHECK(find_check(opened, "reports")->found == "it sent no report");
}

TEST_CASE("a pushed cap moves the handle, by both kinds of reports", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::space_mouse_hid);
    const OpenedDevice opened = open_cap();
    HidDevice& device = opened_hid(opened);
    const Bytes push = GENERATE(Bytes{1, 0x5e, 0x01, 0, 0, 0, 0},
                                Bytes{1, 0x5e, 0x01, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});

    tell(bus, number, device, push);
    const Vec3 way = way_of(device, 100);
    tell(bus, number, device, {2, 0, 0, 0, 0, 0x5e, 0x01});
    for (int i = 0; i < 100; ++i) (void)device.read();
    const Quat turned = device.read().orientation;

    CHECK((way - Vec3(0.1 * SpaceMouseProtocol::fastest_m_per_s, 0, 0)).norm() < 1e-9);
    const Vec3 turn = rotation_vector_of(turned);
    CHECK((turn - Vec3(0, -0.101 * SpaceMouseProtocol::fastest_rad_per_s, 0)).norm() < 1e-9);
}

TEST_CASE("garbage between reports changes nothing", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::dualsense_hid);
    const OpenedDevice opened = open_pad(SonyModel::DualSense);
    HidDevice& device = opened_hid(opened);

    tell(bus, number, device, test::dualsense_report(test::pushed_sticks(Vec3(0, 1, 0))));
    for (const Bytes& garbage : {Bytes{1}, Bytes(63, 0xff), Bytes(64, 0xff), Bytes(128, 0x01)}) {
        tell(bus, number, device, garbage);
    }
    const Vec3 way = way_of(device, 100);

    CHECK(device.reports() == 5);
    CHECK(device.understood() == 1);
    CHECK((way - Vec3(0, 0.1 * SonyPadProtocol::fastest_m_per_s, 0)).norm() < 1e-9);
}

TEST_CASE("a rate that the device does not renew is none any more", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::space_mouse_hid);
    HidSettings hasty = patient;
    hasty.silent_s = 1e-3;
    const OpenedDevice opened = open_cap(hasty);
    HidDevice& device = opened_hid(opened);

    tell(bus, number, device, test::pushed_cap(Vec3(1, 0, 0)));
    wait_until([&] { return way_of(device, 1) == Vec3::Zero(); });

    CHECK(device.read().valid);
}

TEST_CASE("reports that are not understood renew no rate", "[devices][hid]") {
    // Each report is followed by one that says nothing.
    class Flooded final : public HidProtocol {
    public:
        Flooded(test::HidBus& bus, int number) : bus_(bus), number_(number) {}
        std::string_view name() const noexcept override { return "flooded cap"; }
        bool is_ours(const HidPlace& place) const noexcept override { return cap_.is_ours(place); }
        bool is_talkative() const noexcept override { return false; }
        DeviceCheck begin(HidLine&, const HidPlace&) noexcept override { return {}; }
        bool decode(HidBytes report, HidInput& input) noexcept override {
            const bool is_known = cap_.decode(report, input);
            bus_.send(number_, Bytes{0x7f});
            return is_known;
        }
        HidBytes encode(const HidOutput&) noexcept override { return {}; }
        double least_s() const noexcept override { return 0; }

    private:
        test::HidBus& bus_;
        int number_;
        SpaceMouseProtocol cap_;
    };
    test::HidBus bus;
    const int number = bus.plug(test::space_mouse_hid);
    HidSettings hasty = patient;
    hasty.silent_s = 0.02;
    const OpenedDevice opened = open_hid(std::make_unique<Flooded>(bus, number), hasty);
    HidDevice& device = opened_hid(opened);

    tell(bus, number, device, test::pushed_cap(Vec3(1, 0, 0)));
    wait_until([&] { return way_of(device, 1) == Vec3::Zero(); });

    CHECK(device.understood() == 1);
    CHECK(device.read().valid);
}

TEST_CASE("two hands have a device each, and a third none", "[devices][hid]") {
    test::HidBus bus;
    const int first_number = bus.plug(test::space_mouse_hid);
    OpenedDevice first = open_cap();
    REQUIRE(first.device);
    const auto check_taken = [](const OpenedDevice& opened) {
        CHECK_FALSE(opened.device);
        CHECK(opened.checks.back().layer == "open");
        CHECK(opened.checks.back().outcome == CheckOutcome::Failed);
        CHECK(opened.checks.back().found == "the other hand uses it");
    };
    check_taken(open_cap());

    const int second_number = bus.plug(test::space_mouse_hid);
    const OpenedDevice second = open_cap();
    REQUIRE(second.device);
    check_taken(open_cap());
    tell(bus, first_number, opened_hid(first), test::pushed_cap(Vec3(1, 0, 0)));
    tell(bus, second_number, opened_hid(second), test::pushed_cap(Vec3(0, 1, 0)));
    CHECK(way_of(*first.device, 10).normalized() == Vec3(1, 0, 0));
    CHECK(way_of(*second.device, 10).normalized() == Vec3(0, 1, 0));

    first.device.reset();
    CHECK(open_cap().device);
}

TEST_CASE("the clutch brings the handle back to the middle", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::space_mouse_hid);
    const OpenedDevice opened = open_cap();
    HidDevice& device = opened_hid(opened);
    tell(bus, number, device, test::pushed_cap(Vec3(1, 0, 0)));
    REQUIRE(way_of(device, 500).norm() > 0.02);

    tell(bus, number, device, {3, 1});
    for (int i = 0; i < 300; ++i) {
        CHECK(is_pressed(device.read().buttons, Button::Clutch));
    }
    CHECK(device.read().position_m.norm() < 1e-12);

    tell(bus, number, device, {3, 0});
    CHECK(way_of(device, 10).norm() > 0);
}

TEST_CASE("without the person's attention the handle rests and no button counts",
          "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::space_mouse_hid);
    const OpenedDevice opened = open_cap();
    HidDevice& device = opened_hid(opened);
    tell(bus, number, device, test::pushed_cap(Vec3(1, 0, 0)));
    tell(bus, number, device, {3, 1});

    device.attend(false);
    tell(bus, number, device, {3, 3});
    const DeviceReading reading = device.read();
    const Vec3 way = way_of(device, 100);
    const Bytes light = last_report(bus.take_written(number), 2);
    device.attend(true);
    tell(bus, number, device, {3, 0});

    CHECK(reading.valid);
    CHECK(reading.buttons == 0);
    CHECK(way == Vec3::Zero());
    CHECK(light == Bytes{4, 0});
    CHECK(way_of(device, 100).norm() > 0);
    CHECK(device.view_rate().m_per_s ==
          Vec3::Zero());  // that the second button was pressed unheard
    CHECK(last_report(bus.take_written(number), 2) == Bytes{4, 1});
}

TEST_CASE("without the person's attention a pad has no force, and then it is back",
          "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::dualsense_hid);
    const OpenedDevice opened = open_pad(SonyModel::DualSense);
    HidDevice& device = opened_hid(opened);
    const auto played = [&] {
        tell(bus, number, device, test::dualsense_report({}));
        tell(bus, number, device, test::dualsense_report({}));  // the first may have been under way
        return last_report(bus.take_written(number), 63);
    };
    device.write(Vec3(0, 3, 0));
    REQUIRE(played()[13] == 255);

    device.attend(false);
    device.write(Vec3(0, 3, 0));
    const Bytes unheard = played();
    device.attend(true);

    CHECK(unheard[4] == 0);
    CHECK(unheard[11] == 0x05);
    CHECK(unheard[13] == 0);
    CHECK(unheard[24] == 0);
    CHECK(played()[13] == 255);
}

TEST_CASE("the second button gives the rate to the camera, and takes it back", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::space_mouse_hid);
    const OpenedDevice opened = open_cap();
    HidDevice& device = opened_hid(opened);
    tell(bus, number, device, test::pushed_cap(Vec3(0, 1, 0)));

    tell(bus, number, device, {3, 2});
    tell(bus, number, device, {3, 2});  // still held
    CHECK(way_of(device, 100) == Vec3::Zero());
    CHECK(device.view_rate().m_per_s == Vec3(0, SpaceMouseProtocol::fastest_m_per_s, 0));
    CHECK_FALSE(device.status().empty());
    device.attend(false);
    CHECK(device.view_rate().m_per_s == Vec3::Zero());
    device.attend(true);

    tell(bus, number, device, {3, 0});
    tell(bus, number, device, {3, 2});
    CHECK(way_of(device, 100).norm() > 0);
    CHECK(device.view_rate().m_per_s == Vec3::Zero());
    CHECK(device.status().empty());
}

TEST_CASE("an unplugged device is looked for, and found on another node", "[devices][hid]") {
    test::HidBus bus;
    int number = bus.plug(test::dualsense_hid);
    const OpenedDevice opened = open_pad(SonyModel::DualSense);
    HidDevice& device = opened_hid(opened);
    device.write(Vec3(0, 0, 3));
    tell(bus, number, device, test::dualsense_report(test::pushed_sticks(Vec3(1, 0, 0))));
    const Vec3 place = device.read().position_m;

    for (int i = 0; i < 3; ++i) {
        bus.unplug(number);
        wait_until([&] { return !device.status().empty(); });
        CHECK_FALSE(device.read().valid);
        CHECK(way_of(device, 100) == Vec3::Zero());

        number = bus.plug(test::dualsense_hid);
        wait_until([&] { return device.status().empty(); });
        CHECK(device.read().valid);
        CHECK(way_of(device, 100) == Vec3::Zero());  // nobody has touched this one yet
    }

    CHECK(device.read().position_m == place);
    tell(bus, number, device, test::dualsense_report({}));
    CHECK(last_report(bus.take_written(number), 63)[13] == 255);  // the force is told anew
}

TEST_CASE("a pad plays the force on its triggers and its rise on a motor", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::dualsense_hid);
    const OpenedDevice opened = open_pad(SonyModel::DualSense);
    HidDevice& device = opened_hid(opened);
    const Bytes rest = test::dualsense_report({});
    Bytes last;
    const auto played = [&](const Vec3& force_newton, int ticks) {
        for (int i = 0; i < ticks; ++i) device.write(force_newton);
        tell(bus, number, device, rest);
        tell(bus, number, device, rest);  // the first may have been read with the force before
        const Bytes written = bus.take_written(number);
        if (!written.empty()) last = last_report(written, 63);  // else nothing had to change
        return last;
    };

    // 1.5 N of 3 N, all of it within a tick of which 1/50 is no news; then old news.
    const Bytes met = played(Vec3(0.9, 0, 1.2), 1);
    CHECK(met[13] == 128);
    CHECK(met[24] == 128);
    CHECK(met[4] == 125);
    const Bytes held = played(Vec3(-0.9, 1.2, 0), 1000);
    CHECK(held[13] == 128);
    CHECK(held[4] == 0);
    // The clamp and beyond.
    CHECK(played(Vec3(0, -3, 0), 1000)[13] == 255);
    CHECK(played(Vec3(0, 1, 0), 1)[13] == 85);
    CHECK(played(Vec3(0, 1e300, 0), 1)[24] == 255);
    // What is no force.
    const Bytes none = played(Vec3(0, std::numeric_limits<double>::quiet_NaN(), 0), 1);
    CHECK(none[11] == 0x05);
    CHECK(none[13] == 0);
    CHECK(none[4] == 0);
}

TEST_CASE("a force that the servo does not renew is played no longer", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::dualshock4_hid);
    HidSettings hasty = patient;
    hasty.stale_s = 1e-3;
    const OpenedDevice opened = open_pad(SonyModel::DualShock4, hasty);
    HidDevice& device = opened_hid(opened);
    Bytes written;
    // It may come and go between two looks.
    const auto has_come_and_gone = [&] {
        const Bytes more = bus.take_written(number);
        written.insert(written.end(), more.begin(), more.end());
        bool has_come = false;
        for (std::size_t at = 4; at < written.size(); at += 32) has_come |= written[at] == 255;
        return has_come && last_report(written, 32)[4] == 0;
    };

    device.write(Vec3(3, 0, 0));
    wait_until(has_come_and_gone);

    CHECK(device.read().valid);
}

TEST_CASE("a closed pad has neither stiff triggers nor rumble", "[devices][hid]") {
    test::HidBus bus;
    const bool is_bluetooth = GENERATE(false, true);
    const std::size_t size = is_bluetooth ? 78 : 63, at = is_bluetooth ? 3 : 1;
    const int number =
        bus.plug(is_bluetooth ? test::by_bluetooth(test::dualsense_hid) : test::dualsense_hid);
    OpenedDevice opened = open_pad(SonyModel::DualSense);
    HidDevice& device = opened_hid(opened);
    device.write(Vec3(3, 0, 0));
    tell(bus, number, device,
         is_bluetooth ? test::dualsense_bluetooth_report({}) : test::dualsense_report({}));
    REQUIRE(device.understood() == 1);
    const Bytes stiff = last_report(bus.take_written(number), size);
    REQUIRE(stiff[at + 12] == 255);

    opened.device.reset();

    const Bytes last = last_report(bus.take_written(number), size);
    CHECK(last[0] == (is_bluetooth ? 0x31 : 0x02));
    CHECK(last[at + 3] == 0);
    CHECK(last[at + 10] == 0x05);
    CHECK(last[at + 12] == 0);
    CHECK(last[at + 21] == 0x05);
}

// A program of its own, as this one started anew: on the bus of the other it plays a force until it
// is told to leave.
[[noreturn]] void leave_by_exit() {
    const OpenedDevice opened = open_pad(SonyModel::DualSense);
    HidDevice& device = opened_hid(opened);
    device.write(Vec3(3, 0, 0));
    wait_until([&] { return device.reports() > 0; });
    std::exit(0);
}

TEST_CASE("a pad is at rest after exit(), which destroys nothing on a stack", "[devices][hid]") {
    constexpr const char* child_mark = "PALPA_TEST_LEAVES_BY_EXIT";
    if (std::getenv(child_mark)) leave_by_exit();
    test::HidBus bus;
    const int number = bus.plug(test::dualsense_hid);
    setenv(child_mark, "yes", 1);
    std::string program = std::filesystem::read_symlink("/proc/self/exe");
    std::string name = "a pad is at rest after exit()*";
    std::array<char*, 3> arguments{program.data(), name.data(), nullptr};
    pid_t child = 0;
    REQUIRE(posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments.data(), environ) == 0);
    unsetenv(child_mark);
    Bytes written;
    wait_until([&] {
        const Bytes more = bus.take_written(number);
        written.insert(written.end(), more.begin(), more.end());
        return written.size() >= 63 && last_report(written, 63)[13] == 255;
    });

    bus.send(number, test::dualsense_report({}));
    int status = -1;
    REQUIRE(waitpid(child, &status, 0) == child);

    CHECK(status == 0);
    const Bytes last = last_report(bus.take_written(number), 63);
    CHECK(last[4] == 0);
    CHECK(last[11] == 0x05);
    CHECK(last[13] == 0);
    CHECK(last[22] == 0x05);
}

TEST_CASE("a closed cap is dark", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::space_mouse_hid);
    OpenedDevice opened = open_cap();
    tell(bus, number, opened_hid(opened), test::pushed_cap(Vec3::Zero()));
    REQUIRE(last_report(bus.take_written(number), 2) == Bytes{4, 1});

    opened.device.reset();

    CHECK(last_report(bus.take_written(number), 2) == Bytes{4, 0});
}

TEST_CASE("no more reports are written than the line takes", "[devices][hid]") {
    test::HidBus bus;
    const int number = bus.plug(test::dualsense_hid);
    // Of all that follows, the first and the last, which is at the end.
    class Unhurried final : public HidProtocol {
    public:
        std::string_view name() const noexcept override { return pad_.name(); }
        bool is_ours(const HidPlace& place) const noexcept override { return pad_.is_ours(place); }
        bool is_talkative() const noexcept override { return false; }
        DeviceCheck begin(HidLine& line, const HidPlace& place) noexcept override {
            return pad_.begin(line, place);
        }
        bool decode(HidBytes report, HidInput& input) noexcept override {
            return pad_.decode(report, input);
        }
        HidBytes encode(const HidOutput& output) noexcept override { return pad_.encode(output); }
        double least_s() const noexcept override { return 1e3; }

    private:
        SonyPadProtocol pad_{SonyModel::DualSense};
    };
    HidSettings paced = patient;
    paced.is_paced = true;
    OpenedDevice opened = open_hid(std::make_unique<Unhurried>(), paced);
    HidDevice& device = opened_hid(opened);

    for (int i = 0; i < 100; ++i) {
        device.write(Vec3(0.03 * i, 0, 0));
        tell(bus, number, device, test::dualsense_report({}));
    }
    opened.device.reset();

    CHECK(bus.take_written(number).size() == 126);  // two reports
}

// Without an end, if it waited.
TEST_CASE("read and write do not wait for a line that hangs", "[devices][hid]") {
    struct Gate {
        std::mutex mutex;
        std::condition_variable changed;
        bool is_reached = false, is_open = false;
    };
    // Its answer to the first force is held up.
    class Hanging final : public HidProtocol {
    public:
        explicit Hanging(Gate& gate) : gate_(gate) {}
        std::string_view name() const noexcept override { return "hanging cap"; }
        bool is_ours(const HidPlace& place) const noexcept override {
            return place.id == UsbId{0x256f, 0xc635};
        }
        bool is_talkative() const noexcept override { return false; }
        DeviceCheck begin(HidLine&, const HidPlace&) noexcept override { return {}; }
        bool decode(HidBytes, HidInput&) noexcept override { return true; }
        HidBytes encode(const HidOutput& output) noexcept override {
            report_[0] = output.force;
            std::unique_lock lock(gate_.mutex);
            if (output.force == 0) return report_;
            gate_.is_reached = true;
            gate_.changed.notify_all();
            gate_.changed.wait(lock, [&] { return gate_.is_open; });
            return report_;
        }
        double least_s() const noexcept override { return 0; }

    private:
        Gate& gate_;
        std::array<std::uint8_t, 1> report_{};
    };
    Gate gate;
    test::HidBus bus;
    const int number = bus.plug(test::space_mouse_hid);
    const OpenedDevice opened = open_hid(std::make_unique<Hanging>(gate), patient);
    HidDevice& device = opened_hid(opened);
    device.write(Vec3(1, 0, 0));
    {
        std::unique_lock lock(gate.mutex);
        gate.changed.wait(lock, [&] { return gate.is_reached; });
    }

    int valid = 0;
    for (int i = 0; i < 1000; ++i) {
        valid += device.read().valid ? 1 : 0;
        device.write(Vec3(0, 0.003 * i, 0));
    }
    {
        const std::lock_guard lock(gate.mutex);
        gate.is_open = true;
    }
    gate.changed.notify_all();
    tell(bus, number, device, {0});
    tell(bus, number, device, {0});

    CHECK(valid == 1000);
    CHECK(bus.take_written(number).back() == 255);  // 2.997 N: the newest
}

TEST_CASE("the list of devices opens what is plugged in", "[devices][hid][open-device]") {
    test::HidBus bus;
    bus.plug(test::space_mouse_hid);
    bus.plug(test::dualsense_hid);
    bus.plug(test::by_bluetooth(test::dualshock4_hid));

    CHECK(open_device("spacemouse", {}).device->spec().name == test::space_mouse_hid.name);
    CHECK(open_device("dualsense", {}).device->spec().name == test::dualsense_hid.name);
    const OpenedDevice pad = open_device("dualshock4", {});
    CHECK(pad.device->spec().name == test::dualshock4_hid.name);
    CHECK_THAT(find_check(pad, "bus")->found, Catch::Contains("054c:09cc by Bluetooth"));
}
