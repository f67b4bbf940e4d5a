// What palpa devices --latency tells of devices on hidapi: the real libhidapi, threads, mailboxes
// and servo, on devices that umockdev shows it. Started as 'umockdev-wrapper hid_latency
// [REPORTS]'.
#include "devices/hid_device.h"
#include "devices/sony_pad.h"
#include "devices/space_mouse.h"
#include "tests/support/hid_reports.h"
#include "tools/latency.h"

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
    std::size_t size = 0, force_byte = 0;  // of its reports out; 0: it plays none
};

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
         [](bool is_pressed) { return test::dualsense_report(pressed_pad(is_pressed)); }, 63, 13});
    cases.push_back(
        {"DualSense, Bluetooth", test::by_bluetooth(test::dualsense_hid),
         std::make_unique<SonyPadProtocol>(SonyModel::DualSense),
         [](bool is_pressed) { return test::dualsense_bluetooth_report(pressed_pad(is_pressed)); },
         78, 15});
    cases.push_back(
        {"DualShock 4", test::dualshock4_hid,
         std::make_unique<SonyPadProtocol>(SonyModel::DualShock4),
         [](bool is_pressed) { return test::dualshock4_report(pressed_pad(is_pressed)); }, 32, 4});
    return cases;
}

double us_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::micro>(to - from).count();
}

// Whether the last report that the device got has that force.
bool plays(const test::Bytes& written, const LatencyCase& device, bool is_pressed) {
    if (written.size() < device.size) return false;
    const double share = AnsweringServo::newton(is_pressed) / HidDevice::full_newton;
    const std::size_t last = written.size() - device.size;
    return written[last + device.force_byte] == std::lround(255 * share);
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
        bool is_played = device.size == 0;
        while (Clock::now() - sent < longest && (servo.answers() == answers || !is_played)) {
            std::this_thread::sleep_for(std::chrono::microseconds(20));
            const test::Bytes more = bus.take_written(number);
            written.insert(written.end(), more.begin(), more.end());
            if (is_played || !plays(written, device, is_pressed)) continue;
            to_device_us.push_back(us_between(sent, Clock::now()));
            is_played = true;
        }
        if (servo.answers() > answers) to_servo_us.push_back(us_between(sent, servo.answered()));
    }
    (void)servo.stop();
    print_latency(device.name, reports, to_servo_us, "report in, to the servo's force");
    if (device.size > 0)
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
        "ms by Bluetooth), and up to 0.1 ms of this program.\nNot in it: USB or Bluetooth and the "
        "kernel's driver, of which umockdev stands in the place; the device's own\nperiod; the "
        "simulation, whose answer is one of its periods old.\n");
    return 0;
}
