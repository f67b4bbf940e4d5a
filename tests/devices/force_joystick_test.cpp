#include "devices/force_joystick.h"

#include "devices/open_device.h"
#include "tests/support/pid_stick.h"
#include "tests/support/wait_until.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <random>
#include <string>

using namespace palpa;
using test::Bytes;

namespace {

constexpr HidSettings without_time_limits{
    .retry_s = 1e-3, .stale_s = 1e3, .silent_s = 1e3, .is_paced = false};
constexpr double travel_m = ForceJoystickProtocol::half_travel_m;

OpenedDevice open_stick() {
    return open_hid(std::make_unique<ForceJoystickProtocol>(), without_time_limits);
}

HidDevice& stick_of(const OpenedDevice& opened) {
    REQUIRE(opened.device);
    return dynamic_cast<HidDevice&>(*opened.device);
}

// One report, until it has been read and answered.
void report_to(test::HidBus& bus, int number, const HidDevice& device, const Bytes& report) {
    const std::uint64_t before = device.reports();
    bus.send(number, report);
    test::wait_until([&] { return device.reports() != before; }, "an answer to the report");
}

// All that is written for a force, in its order.
Bytes written_for(test::HidBus& bus, int number, HidDevice& device, const Vec3& force_newton) {
    device.write(force_newton);
    report_to(bus, number, device, test::pushed_stick(Vec3::Zero()));
    report_to(bus, number, device, test::pushed_stick(Vec3::Zero()));
    return bus.take_written(number);
}

Bytes joined_reports(const std::vector<Bytes>& reports) {
    Bytes all;
    for (const Bytes& report : reports) all.insert(all.end(), report.begin(), report.end());
    return all;
}

// Control: reset, stop all, actuators on; then the device's gain.
const std::vector<Bytes> start_of_all{{0x24, 4}, {0x24, 3}, {0x24, 1}, {0x25, 0xff}};
// Behind the last force: stop both effects, stop all, actuators off.
const std::vector<Bytes> end_of_all{{0x23, 1, 3, 0xff}, {0x23, 2, 3, 0xff}, {0x24, 3}, {0x24, 2}};

// What the checks say of a stick, at the layer where they end.
DeviceCheck last_check(const test::MockHid& hid) {
    test::HidBus bus;
    bus.plug(hid);
    const OpenedDevice opened = open_stick();
    CHECK_FALSE(opened.device);
    return opened.checks.back();
}

}  // namespace

TEST_CASE("a stick is started by these reports, byte by byte", "[devices][hid][joystick]") {
    test::HidBus bus;
    const int number = bus.plug(test::force_joystick_hid());
    std::vector<Bytes> wanted = start_of_all;
    for (const std::uint8_t block : {std::uint8_t{1}, std::uint8_t{2}}) {
        // Hundredths of a degree: from the right, 9000; from ahead, 0.
        const std::uint8_t low = block == 1 ? 0x28 : 0, high = block == 1 ? 0x23 : 0;
        wanted.push_back({0x31, 1, 0, 0});  // a constant force
        // Block, type, duration without end, trigger's interval, sample period, gain, no button,
        // Direction Enable, both directions, delay.
        wanted.push_back(
            {0x21, block, 1, 0xff, 0xff, 0, 0, 0, 0, 0xff, 0, 0x04, low, high, 0, 0, 0, 0});
        wanted.push_back({0x22, block, 0, 0});
        wanted.push_back({0x23, block, 1, 0xff});
    }

    const OpenedDevice opened = open_stick();
    (void)stick_of(opened);

    CHECK(bus.take_written(number) == joined_reports(wanted));
    CHECK(opened.checks.size() == 6);
    CHECK(opened.checks[4].layer == "effects");
    CHECK_THAT(opened.checks[4].found, Catch::Contains("2 of 2 axes") && Catch::Contains("10000"));
    CHECK(opened.device->spec().peak_force_newton == 3);
}

TEST_CASE("a wheel has one effect, from the right in 255 parts of a turn",
          "[devices][hid][joystick]") {
    test::HidBus bus;
    const int number = bus.plug(test::force_joystick_hid(test::wheel_parts()));
    std::vector<Bytes> wanted = start_of_all;
    wanted.push_back({0x31, 1, 0, 0});
    wanted.push_back({0x21, 1, 1, 0xff, 0xff, 0, 0, 0, 0, 0xff, 0, 0x02, 64, 0, 0, 0});
    wanted.push_back({0x22, 1, 0, 0});
    wanted.push_back({0x23, 1, 1, 0xff});

    const OpenedDevice opened = open_stick();
    HidDevice& device = stick_of(opened);

    CHECK(bus.take_written(number) == joined_reports(wanted));
    CHECK(written_for(bus, number, device, Vec3(-1.5, 2, 1)) == Bytes{0x22, 1, 0x88, 0x13});
    report_to(bus, number, device, test::pushed_stick(Vec3(1, 1, 0)));  // Y is a pedal
    for (int i = 0; i < 200; ++i) (void)device.read();
    CHECK(device.read().position_m.x() == Approx(travel_m));
    CHECK(device.read().position_m.y() == 0);
}

TEST_CASE("a force is one magnitude for each axis on which it changed",
          "[devices][hid][joystick]") {
    test::HidBus bus;
    const int number = bus.plug(test::force_joystick_hid());
    const OpenedDevice opened = open_stick();
    HidDevice& device = stick_of(opened);
    (void)bus.take_written(number);
    const auto written = [&](const Vec3& newton) {
        return written_for(bus, number, device, newton);
    };

    // 1.5 N of 3 N to the right is 5000 of 10000, and comes from the left.
    CHECK(written({1.5, 0, 0}) == Bytes{0x22, 1, 0x78, 0xec});
    CHECK(written({1.5, 0, 2.0}).empty());  // no motor goes there
    CHECK(written({1.5, 0.3, 0}) == Bytes{0x22, 2, 0x18, 0xfc});
    CHECK(written({1.5, 0.30029, 0}).empty());  // not yet the next step
    CHECK(written({-1.5, -0.3, 0}) == Bytes{0x22, 1, 0x88, 0x13, 0x22, 2, 0xe8, 0x03});
    CHECK(written({-1e300, 0, 0}) == Bytes{0x22, 1, 0x10, 0x27, 0x22, 2, 0, 0});
    CHECK(written({std::nan(""), 1, 0}) == Bytes{0x22, 1, 0, 0});
    device.write({1.5, 0, 0});
    device.attend(false);
    CHECK(written({1.5, 0, 0}).empty());
    device.attend(true);
    CHECK(written({1.5, 0, 0}) == Bytes{0x22, 1, 0x78, 0xec});
}

TEST_CASE("a closed stick has no force, and its motors are off", "[devices][hid][joystick]") {
    test::HidBus bus;
    const int number = bus.plug(test::force_joystick_hid());
    OpenedDevice opened = open_stick();
    test::PidStick stick;
    stick.take(bus.take_written(number));
    stick.take(written_for(bus, number, stick_of(opened), Vec3(1, -2, 0)));
    CHECK((stick.force_newton() - Vec3(1, -2, 0)).norm() < 3e-4);  // half a count of 10000
    std::vector<Bytes> wanted{{0x22, 1, 0, 0}, {0x22, 2, 0, 0}};
    wanted.insert(wanted.end(), end_of_all.begin(), end_of_all.end());

    opened.device.reset();

    const Bytes written = bus.take_written(number);
    CHECK(written == joined_reports(wanted));
    stick.take(written);
    CHECK_FALSE(stick.is_on());
    CHECK_FALSE(stick.is_playing());
}

TEST_CASE("the handle goes with the stick, and the first button is the clutch",
          "[devices][hid][joystick]") {
    test::HidBus bus;
    const int number = bus.plug(test::force_joystick_hid());
    const OpenedDevice opened = open_stick();
    HidDevice& device = stick_of(opened);
    CHECK_FALSE(device.read().valid);
    CHECK_THAT(std::string(device.status()), Catch::Contains("Move the stick"));

    // The first place is where the handle is; the next is gone to.
    report_to(bus, number, device, test::pushed_stick(Vec3(0.5, 0, 0)));
    CHECK(device.status().empty());
    const DeviceReading first = device.read();
    report_to(bus, number, device, test::pushed_stick(Vec3(-0.5, 1, 0), 0x01));
    double fastest_m = 0;
    Vec3 place = first.position_m;
    for (int i = 0; i < 300; ++i) {
        const DeviceReading reading = device.read();
        CHECK(is_pressed(reading.buttons, Button::Clutch));
        fastest_m = std::max(fastest_m, (reading.position_m - place).norm());
        place = reading.position_m;
    }

    // To the nearest of 4096 counts.
    CHECK(first.valid);
    CHECK((first.position_m - travel_m * Vec3(0.5, 0, 0)).norm() < 2e-5);
    CHECK((place - travel_m * Vec3(-0.5, 1, 0)).norm() < 2e-5);
    CHECK(fastest_m == Approx(1e-3));  // a metre a second
    report_to(bus, number, device, test::pushed_stick(Vec3(-0.5, 1, 0), 0xfe));
    CHECK(device.read().buttons == 0);
}

TEST_CASE("without the window's focus the clutch holds the molecule, and there is no force",
          "[devices][hid][joystick]") {
    test::HidBus bus;
    const int number = bus.plug(test::force_joystick_hid());
    const OpenedDevice opened = open_stick();
    HidDevice& device = stick_of(opened);
    test::PidStick stick;
    stick.take(bus.take_written(number));
    stick.take(written_for(bus, number, device, Vec3(1, 1, 0)));
    REQUIRE(stick.force_newton().norm() > 1);

    device.attend(false);
    stick.take(written_for(bus, number, device, Vec3(1, 1, 0)));

    CHECK(device.read().valid);
    CHECK(is_pressed(device.read().buttons, Button::Clutch));
    CHECK(stick.force_newton() == Vec3::Zero());
    device.attend(true);
    stick.take(written_for(bus, number, device, Vec3(1, 1, 0)));
    CHECK(stick.force_newton().norm() > 1);
    CHECK_FALSE(is_pressed(device.read().buttons, Button::Clutch));
}

TEST_CASE("a report that says something else moves nothing", "[devices][hid][joystick]") {
    test::HidBus bus;
    const int number = bus.plug(test::force_joystick_hid());
    const OpenedDevice opened = open_stick();
    HidDevice& device = stick_of(opened);
    report_to(bus, number, device, test::pushed_stick(Vec3(0.5, 0, 0)));
    const Vec3 place = device.read().position_m;

    report_to(bus, number, device, {2, 0x81});
    report_to(bus, number, device, {1});
    report_to(bus, number, device, {7, 1, 2, 3, 4, 5, 6});

    CHECK(device.reports() == 4);
    CHECK(device.understood() == 1);
    CHECK(device.read().position_m == place);
    CHECK(device.read().valid);
}

TEST_CASE("a stick that lacks what a constant force takes says what", "[devices][hid][joystick]") {
    const test::DescriptorParts whole = test::stick_parts();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        test::DescriptorParts parts = whole;
        const std::string name = parts[i].name;
        parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
        CAPTURE(name);
        const std::string lacking = ForceJoystickProtocol().use(test::joined(parts));
        const bool is_needed = name != "PID State report" && name != "Device Gain report";
        CHECK(lacking == (is_needed ? "its report descriptor has no " + name : ""));
    }
    Bytes unsigned_magnitude = test::joined(whole);
    const Bytes range{0x16, 0xf0, 0xd8, 0x26, 0x10, 0x27};
    const auto at = std::search(unsigned_magnitude.begin(), unsigned_magnitude.end(), range.begin(),
                                range.end());
    REQUIRE(at != unsigned_magnitude.end());
    at[1] = at[2] = 0;
    CHECK(ForceJoystickProtocol().use(unsigned_magnitude) == "its force magnitude has no sign");
    Bytes cut = test::joined(whole);
    cut.pop_back();
    CHECK(ForceJoystickProtocol().use(cut) ==
          "its report descriptor is wrong: it ends in a collection");
    CHECK_THAT(ForceJoystickProtocol().use({}), Catch::Contains("cannot be read"));

    const DeviceCheck plain = last_check({0x044f, 0xb108, 1, 4, false, "a plain stick"});
    CHECK(plain.layer == "bus");
    CHECK_THAT(plain.found,
               Catch::Contains("no force-feedback joystick among the 1 input devices") &&
                   Catch::Contains("044f:b108 is a joystick without a usable force: "
                                   "its report descriptor has no X axis"));
}

TEST_CASE("a stick with room for one effect plays it, and one without any is not used",
          "[devices][hid][joystick]") {
    test::MockHid hid = test::force_joystick_hid();
    auto& answers = hid.features.at(0x32);

    SECTION("one") {
        answers = {test::loaded_block(5, 1), test::loaded_block(0, 2)};
        test::HidBus bus;
        const int number = bus.plug(hid);
        const OpenedDevice opened = open_stick();
        HidDevice& device = stick_of(opened);
        (void)bus.take_written(number);
        CHECK_THAT(opened.checks[4].found, Catch::Contains("1 of 2 axes"));
        CHECK(written_for(bus, number, device, Vec3(1.5, 1.5, 0)) == Bytes{0x22, 5, 0x78, 0xec});
        report_to(bus, number, device, test::pushed_stick(Vec3(0, 1, 0)));
        CHECK(device.read().valid);
    }
    SECTION("none") {
        answers = {test::loaded_block(0, 2)};
        const DeviceCheck full = last_check(hid);
        CHECK(full.layer == "effects");
        CHECK_THAT(full.found, Catch::Contains("no memory"));
    }
    SECTION("busy at first") {
        answers = {test::loaded_block(0, 0), test::loaded_block(0, 0), test::loaded_block(7, 1),
                   test::loaded_block(8, 1)};
        test::HidBus bus;
        bus.plug(hid);
        CHECK_THAT(open_stick().checks[4].found, Catch::Contains("2 of 2 axes"));
    }
    SECTION("an error, no answer, half an answer, no block") {
        const int which = GENERATE(0, 1, 2, 3);
        if (which == 0) answers = {test::loaded_block(0, 3)};
        if (which == 1) hid.features.clear();
        if (which == 2) answers = {{0x32, 1}};
        if (which == 3) answers = {test::loaded_block(0, 1)};
        const DeviceCheck refused = last_check(hid);
        CHECK(refused.layer == "effects");
        CHECK_THAT(refused.found, Catch::Contains("does not accept a constant force"));
        CHECK_FALSE(refused.remedy.empty());
    }
}

TEST_CASE("a stick that does not take an effect is left with its motors off",
          "[devices][hid][joystick]") {
    test::HidBus bus;
    test::MockHid hid = test::force_joystick_hid();
    hid.features.at(0x32) = {test::loaded_block(1, 1), test::loaded_block(0, 3)};
    const int number = bus.plug(hid);

    CHECK_FALSE(open_stick().device);

    test::PidStick stick;
    stick.take(bus.take_written(number));
    CHECK_FALSE(stick.is_on());
    CHECK_FALSE(stick.is_playing());
}

TEST_CASE("a stick that was unplugged is started anew, from its first place on",
          "[devices][hid][joystick]") {
    test::HidBus bus;
    int number = bus.plug(test::force_joystick_hid());
    const OpenedDevice opened = open_stick();
    HidDevice& device = stick_of(opened);
    device.write(Vec3(1, 0, 0));
    report_to(bus, number, device, test::pushed_stick(Vec3(0.5, 0, 0)));
    REQUIRE(device.read().valid);

    bus.unplug(number);
    const auto status_says = [&](std::string_view words) {
        return device.status().find(words) != std::string_view::npos;
    };
    test::wait_until([&] { return status_says("does not answer"); }, "the loss");
    CHECK_FALSE(device.read().valid);
    number = bus.plug(test::force_joystick_hid());
    test::wait_until([&] { return status_says("Move the stick"); }, "the joystick");

    CHECK_FALSE(device.read().valid);
    report_to(bus, number, device, test::pushed_stick(Vec3(0, -1, 0)));
    CHECK((device.read().position_m - travel_m * Vec3(0, -1, 0)).norm() < 2e-5);
    test::PidStick stick;
    stick.take(bus.take_written(number));
    CHECK((stick.force_newton() - Vec3(1, 0, 0)).norm() < 3e-4);
}

TEST_CASE("the list of devices knows a stick with a force from one without",
          "[devices][hid][joystick][open-device]") {
    test::HidBus bus;
    const auto& maker = device_maker_called("joystick");
    bus.plug({0x044f, 0xb108, 1, 4, false, "a plain stick"});

    CHECK_FALSE(maker.is_there({}));
    bus.plug(test::force_joystick_hid());

    CHECK(maker.is_there({}));
    CHECK(open_device("joystick", {}).device->spec().name == "Force Stick");
}

TEST_CASE("a million random reports of a stick leave the handle within its way",
          "[devices][joystick]") {
    ForceJoystickProtocol protocol;
    REQUIRE(protocol.use(test::joined(test::stick_parts())).empty());
    std::mt19937 random(17);
    HidInput input;
    int understood = 0;

    for (int i = 0; i < 1'000'000; ++i) {
        std::array<std::uint8_t, 8> bytes{};
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
        bytes[0] = static_cast<std::uint8_t>(random() % 4);
        const HidBytes report = HidBytes(bytes).first(random() % (bytes.size() + 1));
        understood += protocol.decode(report, input) ? 1 : 0;
        const Vec3 place = input.place_m.value_or(Vec3::Zero());
        if (!(place.cwiseAbs().maxCoeff() <= travel_m && input.buttons < 2)) FAIL("report " << i);
    }

    CHECK(understood > 50'000);
}
