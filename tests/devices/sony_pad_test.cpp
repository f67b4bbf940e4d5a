#include "devices/sony_pad.h"

#include "tests/support/hid_reports.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>

using namespace palpa;
using test::Bytes;
using test::PadState;

namespace {

constexpr double fastest_stick = SonyPadProtocol::fastest_m_per_s;

// A model on one of its two lines, and how it reports there.
struct PadCase {
    SonyModel model;
    bool is_bluetooth;
    Bytes (*report)(const PadState&);
};

constexpr std::array pad_cases{
    PadCase{SonyModel::DualSense, false, test::dualsense_report},
    PadCase{SonyModel::DualSense, true, test::dualsense_bluetooth_report},
    PadCase{SonyModel::DualShock4, false, test::dualshock4_report},
    PadCase{SonyModel::DualShock4, true, test::dualshock4_bluetooth_report},
};

HidInput decoded_pad(const PadCase& pad, const PadState& state) {
    SonyPadProtocol protocol(pad.model);
    protocol.use_bluetooth(pad.is_bluetooth);
    HidInput input;
    CHECK(protocol.decode(pad.report(state), input));
    return input;
}

Bytes encoded(SonyPadProtocol& protocol, const HidOutput& output) {
    const HidBytes report = protocol.encode(output);
    return {report.begin(), report.end()};
}

}  // namespace

TEST_CASE("the test's own CRC has the published check value", "[devices][sony-pad]") {
    CHECK(test::slow_crc({'1', '2', '3', '4', '5', '6', '7', '8', '9'}) == 0xcbf43926);
}

TEST_CASE("sticks at rest move nothing, and pushed ones the handle along", "[devices][sony-pad]") {
    const PadCase pad = GENERATE(from_range(pad_cases));
    const int axis = GENERATE(0, 1, 2);
    const double side = GENERATE(-1.0, 1.0);
    const Vec3 push = side * Vec3::Unit(axis);

    const HidInput rest = decoded_pad(pad, {});
    const HidInput pushed = decoded_pad(pad, test::pushed_sticks(push));

    CHECK(rest.rate.m_per_s == Vec3::Zero());
    CHECK(rest.rate.rad_per_s == Vec3::Zero());
    CHECK(rest.buttons == 0);
    CHECK((pushed.rate.m_per_s - fastest_stick * push).norm() < 1e-12);
    CHECK(pushed.rate.rad_per_s == Vec3::Zero());
}

TEST_CASE("the right stick to the right turns the handle clockwise from above",
          "[devices][sony-pad]") {
    PadState state;
    state.right_x = 255;

    const HidInput input = decoded_pad(GENERATE(from_range(pad_cases)), state);

    CHECK(input.rate.m_per_s == Vec3::Zero());
    CHECK((input.rate.rad_per_s - Vec3(0, -SonyPadProtocol::fastest_rad_per_s, 0)).norm() < 1e-12);
}

TEST_CASE("with L1 held the handle turns as the pad does", "[devices][sony-pad]") {
    const PadCase pad = GENERATE(from_range(pad_cases));
    PadState state;
    // Ninety degrees a second of 2000 at 32768, to the nearest count.
    state.pitch = 1475;
    state.yaw = -1475;
    state.roll = 100;

    const HidInput released = decoded_pad(pad, state);
    state.shoulders = 0x01;
    const HidInput held = decoded_pad(pad, state);
    state.pitch = state.yaw = state.roll = 10;  // a degree a second: a pad on the table
    const HidInput resting = decoded_pad(pad, state);

    constexpr double quarter = std::numbers::pi / 2;
    CHECK(released.rate.rad_per_s == Vec3::Zero());
    CHECK(held.rate.rad_per_s.x() == Approx(quarter).epsilon(1e-3));
    CHECK(held.rate.rad_per_s.y() == Approx(-quarter).epsilon(1e-3));
    CHECK(held.rate.rad_per_s.z() == Approx(quarter * 100 / 1475).epsilon(1e-3));
    CHECK(resting.rate.rad_per_s == Vec3::Zero());
}

TEST_CASE("R1 is the clutch and the triangle the camera", "[devices][sony-pad]") {
    const PadCase pad = GENERATE(from_range(pad_cases));
    PadState r1, triangle, others;
    r1.shoulders = 0x02;
    triangle.shapes = 0x88;
    others.shapes = 0x70;     // the other three
    others.shoulders = 0xfc;  // both triggers and below

    CHECK(decoded_pad(pad, r1).buttons == 1);
    CHECK(decoded_pad(pad, triangle).buttons == 2);
    CHECK(decoded_pad(pad, others).buttons == 0);
}

TEST_CASE("the short report of a pad by Bluetooth has sticks and buttons", "[devices][sony-pad]") {
    const SonyModel model = GENERATE(SonyModel::DualSense, SonyModel::DualShock4);
    SonyPadProtocol protocol(model);
    PadState state = test::pushed_sticks(Vec3(0, 1, 0));
    state.shoulders = 0x03;
    const Bytes report = test::short_pad_report(state);
    HidInput input;

    CHECK_FALSE(protocol.decode(report, input));  // by cable there is none
    protocol.use_bluetooth(true);
    REQUIRE(protocol.decode(report, input));

    CHECK((input.rate.m_per_s - Vec3(0, fastest_stick, 0)).norm() < 1e-12);
    CHECK(input.rate.rad_per_s == Vec3::Zero());  // it has no gyroscope
    CHECK(input.buttons == 1);
}

TEST_CASE("a report by Bluetooth with a wrong bit is none", "[devices][sony-pad]") {
    const PadCase pad =
        GENERATE(filter([](const PadCase& c) { return c.is_bluetooth; }, from_range(pad_cases)));
    SonyPadProtocol protocol(pad.model);
    protocol.use_bluetooth(true);
    const Bytes sound = pad.report(test::pushed_sticks(Vec3(1, 0, 0)));
    HidInput input;

    for (std::size_t bit = 0; bit < 8 * sound.size(); ++bit) {
        Bytes report = sound;
        report[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
        CHECK_FALSE(protocol.decode(report, input));
    }

    CHECK(input.rate.m_per_s == Vec3::Zero());
    CHECK(protocol.decode(sound, input));
}

TEST_CASE("DualSense by cable: the report that stiffens and rumbles, byte by byte",
          "[devices][sony-pad]") {
    SonyPadProtocol protocol(SonyModel::DualSense);
    Bytes none(63, 0), some(63, 0);
    none[0] = some[0] = 0x02;
    none[1] = some[1] = 0x0f;    // rumble (0x03) and both triggers (0x0c) are told
    none[11] = none[22] = 0x05;  // right and left: nothing
    some[4] = 70;                // the left motor
    some[11] = some[22] = 0x01;  // both resist, from 0 on,
    some[13] = some[24] = 200;   // as much

    CHECK(encoded(protocol, {0, 0, true}) == none);
    CHECK(encoded(protocol, {200, 70, true}) == some);
    CHECK(encoded(protocol, {0, 0, false}) == none);
}

TEST_CASE("DualSense by Bluetooth: the same behind a counter, before a CRC",
          "[devices][sony-pad]") {
    SonyPadProtocol protocol(SonyModel::DualSense);
    protocol.use_bluetooth(true);

    for (int i = 0; i < 20; ++i) {
        Bytes wanted(78, 0);
        wanted[0] = 0x31;
        wanted[1] = static_cast<std::uint8_t>(i % 16 * 16);
        wanted[2] = 0x10;
        wanted[3] = 0x0f;
        wanted[6] = 70;
        wanted[13] = wanted[24] = 0x01;
        wanted[15] = wanted[26] = 200;
        CHECK(encoded(protocol, {200, 70, true}) == test::sealed(wanted, 0xa2));
    }
}

TEST_CASE("DualShock 4: the report that rumbles, byte by byte", "[devices][sony-pad]") {
    SonyPadProtocol protocol(SonyModel::DualShock4);
    Bytes cable(32, 0), bluetooth(78, 0);
    cable[0] = 0x05;
    cable[1] = 0x01;
    cable[4] = 200;  // the small motor
    cable[5] = 70;   // the large one
    bluetooth[0] = 0x11;
    bluetooth[1] = 0xc4;
    bluetooth[3] = 0x01;
    bluetooth[6] = 200;
    bluetooth[7] = 70;

    CHECK(encoded(protocol, {200, 70, true}) == cable);
    protocol.use_bluetooth(true);
    CHECK(encoded(protocol, {200, 70, true}) == test::sealed(bluetooth, 0xa2));
}

TEST_CASE("pads are known by maker, number and usage", "[devices][sony-pad]") {
    const SonyPadProtocol dualsense(SonyModel::DualSense), dualshock(SonyModel::DualShock4);
    const auto place = [](std::uint16_t vendor, std::uint16_t product, std::uint16_t usage) {
        return HidPlace{"/dev/hidraw0", {vendor, product}, 1, usage, false, ""};
    };

    CHECK(dualsense.is_ours(place(0x054c, 0x0ce6, 5)));
    CHECK(dualsense.is_ours(place(0x054c, 0x0df2, 5)));
    CHECK_FALSE(dualsense.is_ours(place(0x054c, 0x09cc, 5)));
    CHECK_FALSE(dualsense.is_ours(place(0x054c, 0x0ce6, 2)));
    CHECK_FALSE(dualsense.is_ours(place(0x054d, 0x0ce6, 5)));
    CHECK(dualshock.is_ours(place(0x054c, 0x05c4, 5)));
    CHECK(dualshock.is_ours(place(0x054c, 0x09cc, 5)));
    CHECK_FALSE(dualshock.is_ours(place(0x054c, 0x0ce6, 5)));
}

TEST_CASE("a million random reports of pads ask for no more than they can", "[devices][sony-pad]") {
    std::mt19937 random(11);
    const double fastest_turn = 35 * std::sqrt(3.0) + 2;  // 2000 degrees a second, three times
    int understood = 0, long_by_bluetooth = 0;

    for (int i = 0; i < 1'000'000; ++i) {
        const PadCase& pad = pad_cases[random() % pad_cases.size()];
        SonyPadProtocol protocol(pad.model);
        protocol.use_bluetooth(pad.is_bluetooth);
        std::array<std::uint8_t, 96> bytes{};
        for (std::size_t at = 0; at < bytes.size(); at += 4) {
            const auto four = static_cast<std::uint32_t>(random());
            for (std::size_t k = 0; k < 4; ++k) {
                bytes[at + k] = static_cast<std::uint8_t>(four >> (8 * k));
            }
        }
        constexpr std::array<std::uint8_t, 4> numbers{1, 0x11, 0x31, 0};
        constexpr std::array<std::size_t, 4> sizes{64, 78, 10, 0};
        bytes[0] = numbers[random() % numbers.size()];
        std::size_t size = sizes[random() % sizes.size()];
        if (random() % 4 == 0) size = random() % (bytes.size() + 1);
        Bytes report(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        const bool is_sealed = pad.is_bluetooth && size > 4 && random() % 2 == 0;
        if (is_sealed) report = test::sealed(report, 0xa1);
        HidInput input;
        const bool is_one = protocol.decode(report, input);
        understood += is_one ? 1 : 0;
        long_by_bluetooth += is_one && is_sealed && size == 78 ? 1 : 0;
        const double speed = input.rate.m_per_s.cwiseAbs().maxCoeff();
        const double turn = input.rate.rad_per_s.norm();
        if (!(speed <= fastest_stick && turn <= fastest_turn && input.buttons < 4))
            FAIL("report " << i);
    }

    CHECK(understood > 40'000);
    CHECK(long_by_bluetooth > 5'000);
}
