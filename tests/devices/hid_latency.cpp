// What palpa devices --latency says of devices on hidapi: the real libhidapi, threads, mailboxes
// and servo, on devices that umockdev shows it. Started as 'umockdev-wrapper hid_latency
// [REPORTS]'.
#include "devices/force_joystick.h"
#include "devices/hid_device.h"
#include "devices/sony_pad.h"
#include "devices/space_mouse.h"
#include "experiments/latency.h"
#include "tests/support/hid_reports.h"
#include "tests/support/pid_stick.h"
#include "tools/commands/latency.h"

#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

using namespace palpa;

namespace {

using Clock = AnsweringServo::Clock;

struct LatencyCase {
    std::string name;
    test::MockHid hid;
    std::unique_ptr<HidProtocol> protocol;
    test::Bytes (*report)(bool is_pressed);
    // Whether the last report that the device got has that share of the full force; null: it plays
    // none.
    bool (*plays)(const test::Bytes& written, double share) = nullptr;
};

// Reports of so many bytes, in one of which the force stands.
template <std::size_t Size, std::size_t At>
bool plays_level(const test::Bytes& written, double share) {
    return written.size() >= Size &&
           written[written.size() - Size + At] == std::lround(255 * share);
}

// Upwards is from ahead backwards.
bool plays_magnitude(const test::Bytes& written, double share) {
    constexpr std::size_t size = 4;
    if (written.size() < size) return false;
    const std::uint8_t* const last = written.data() + written.size() - size;
    const auto magnitude = static_cast<std::int16_t>(last[2] | last[3] << 8);
    return last[0] == 0x22 && last[1] == 2 && std::abs(magnitude + 10'000 * share) < 1;
}

test::PadState pressed_pad(bool is_pressed) {
    test::PadState state;
    state.shoulders = is_pressed ? 0x02 : 0;
    return state;
}

std::vector<LatencyCase> list_cases() {
    std::vector<LatencyCase> cases;
    cases.push_back({"SpaceMouse", test::space_mouse_hid, std::make_unique<SpaceMouseProtocol>(),
                     [](bool is_pressed) { return test::Bytes{3, std::uint8_t(is_pressed)}; }});
    cases.push_back(
        {"DualSense", test::dualsense_hid, std::make_unique<SonyPadProtocol>(SonyModel::DualSense),
         [](bool is_pressed) { return test::dualsense_report(pressed_pad(is_pressed)); },
         plays_level<63, 13>});
    cases.push_back(
        {"DualSense, Bluetooth", test::by_bluetooth(test::dualsense_hid),
         std::make_unique<SonyPadProtocol>(SonyModel::DualSense),
         [](bool is_pressed) { return test::dualsense_bluetooth_report(pressed_pad(is_pressed)); },
         plays_level<78, 15>});
    cases.push_back(
        {"DualShock 4", test::dualshock4_hid,
         std::make_unique<SonyPadProtocol>(SonyModel::DualShock4),
         [](bool is_pressed) { return test::dualshock4_report(pressed_pad(is_pressed)); },
         plays_level<32, 4>});
    cases.push_back(
        {"force joystick", test::force_joystick_hid(), std::make_unique<ForceJoystickProtocol>(),
         [](bool is_pressed) { return test::pushed_stick(Vec3::Zero(), is_pressed ? 1 : 0); },
         plays_magnitude});
    return cases;
}

double us_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::micro>(to - from).count();
}

void measure(LatencyCase& device, int reports) {
    constexpr std::chrono::milliseconds longest{500};
    test::HidBus bus;
    const int number = bus.plug(device.hid);
    bus.send(number, device.report(false));
    const OpenedDevice opened = open_hid(std::move(device.protocol));
    if (!opened.device) {
        print_latency(device.name, reports, {}, "");
        return;
    }
    // One that senses a place has none before its first report.
    const Clock::time_point opened_at = Clock::now();
    while (!opened.device->read().valid && Clock::now() - opened_at < longest) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    AnsweringServo servo(*opened.device);
    std::mt19937 random(1);  // so that reports meet the servo at any moment of its tick
    std::uniform_int_distribution<int> wait_us(15'000, 25'000);
    std::vector<double> to_servo_us, to_device_us;
    for (int i = 0; i < reports; ++i) {
        const bool is_pressed = i % 2 == 0;
        std::this_thread::sleep_for(std::chrono::microseconds(wait_us(random)));
        (void)bus.take_written(number);
        const int answers = servo.answers();
        const Clock::time_point sent = Clock::now();
        bus.send(number, device.report(is_pressed));
        test::Bytes written;
        bool is_played = device.plays == nullptr;
        const double share = AnsweringServo::newton(is_pressed) / HidDevice::full_newton;
        while (Clock::now() - sent < longest && (servo.answers() == answers || !is_played)) {
            std::this_thread::sleep_for(std::chrono::microseconds(20));
            const test::Bytes more = bus.take_written(number);
            written.insert(written.end(), more.begin(), more.end());
            if (is_played || !device.plays(written, share)) continue;
            to_device_us.push_back(us_between(sent, Clock::now()));
            is_played = true;
        }
        if (servo.answers() > answers) to_servo_us.push_back(us_between(sent, servo.answered()));
    }
    (void)servo.stop();
    print_latency(device.name, reports, to_servo_us, "report in, to the servo's force");
    if (device.plays != nullptr)
        print_latency(device.name, reports, to_device_us, "report in, to report out");
}

}  // namespace

int main(int count, char** arguments) {
    try {
        const int reports = count > 1 ? std::stoi(arguments[1]) : 200;
        for (LatencyCase& device : list_cases()) measure(device, reports);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    fmt::print(
        "\nA report in is measured from its writing into the device's node: the reading thread, "
        "its mailbox, the\nwait for the servo's next tick, and the tick are in it; a report out "
        "adds the way back, the pause that\nits line needs between two reports (4 ms by cable, 12 "
        "ms by Bluetooth, 2 ms of the joystick), and up to 0.1 ms of this program.\nNot in it: USB "
        "or Bluetooth and the "
        "kernel's driver, of which umockdev stands in the place; the device's own\nperiod; the "
        "simulation, whose answer is one of its periods old.\n");
    return 0;
}
