// Reports as the devices send them, byte by byte from what is published about them; nothing of the
// code under test.
#pragma once
#include "math/vec.h"
#include "tests/support/hid_bus.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpa::test {

using Bytes = std::vector<std::uint8_t>;

inline const MockHid space_mouse_hid{0x256f, 0xc635, 1, 8, false, "SpaceMouse Compact"};
inline const MockHid dualsense_hid{0x054c, 0x0ce6, 1, 5, false, "DualSense Wireless Controller"};
inline const MockHid dualshock4_hid{0x054c, 0x09cc, 1, 5, false, "Wireless Controller"};

inline MockHid by_bluetooth(MockHid device) {
    device.is_bluetooth = true;
    return device;
}

// CRC-32 of IEEE 802.3, bit by bit; of "123456789" it is 0xcbf43926.
inline std::uint32_t slow_crc(const Bytes& bytes) {
    std::uint32_t crc = 0xffffffff;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320 : 0);
    }
    return ~crc;
}

// Its last four bytes: CRC-32 of `kind` (0xa1 to the host, 0xa2 to the device) and all before them.
inline Bytes sealed(Bytes report, std::uint8_t kind) {
    Bytes covered(report.begin(), report.end() - 4);
    covered.insert(covered.begin(), kind);
    const std::uint32_t crc = slow_crc(covered);
    for (std::size_t i = 0; i < 4; ++i) {
        report[report.size() - 4 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
    }
    return report;
}

// The cap of a new SpaceMouse, pushed along the handle's axes: 1 is the end of its way.
inline Bytes pushed_cap(const Vec3& push) {
    Bytes report(13, 0);
    report[0] = 1;
    const Vec3 cap(push.x(), push.z(), -push.y());  // its axes: right, towards the user, down
    for (std::size_t i = 0; i < 3; ++i) {
        const auto count =
            static_cast<std::int16_t>(std::lround(350 * cap(static_cast<Eigen::Index>(i))));
        const auto word = static_cast<std::uint16_t>(count);
        report[1 + 2 * i] = static_cast<std::uint8_t>(word & 0xff);
        report[2 + 2 * i] = static_cast<std::uint8_t>(word >> 8);
    }
    return report;
}

// What every report of a pad has, wherever it has it.
struct PadState {
    std::uint8_t left_x = 128, left_y = 128, right_x = 128, right_y = 128;
    std::uint8_t shapes = 8;     // the cross of four in its low half, 8 at rest; triangle 0x80
    std::uint8_t shoulders = 0;  // L1 0x01, R1 0x02
    std::int16_t pitch = 0, yaw = 0, roll = 0;
};

// The sticks pushed along the handle's axes.
inline PadState pushed_sticks(const Vec3& push) {
    const auto byte = [](double way) {
        return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * way));
    };
    PadState state;
    state.left_x = byte(push.x());
    state.left_y = byte(-push.y());
    state.right_y = byte(push.z());
    return state;
}

inline void put_pad(Bytes& report, std::size_t sticks, std::size_t buttons, std::size_t gyro,
                    const PadState& state) {
    report[sticks] = state.left_x;
    report[sticks + 1] = state.left_y;
    report[sticks + 2] = state.right_x;
    report[sticks + 3] = state.right_y;
    report[buttons] = state.shapes;
    report[buttons + 1] = state.shoulders;
    if (gyro == 0) return;
    std::size_t at = gyro;
    for (const std::int16_t rate : {state.pitch, state.yaw, state.roll}) {
        const auto word = static_cast<std::uint16_t>(rate);
        report[at++] = static_cast<std::uint8_t>(word & 0xff);
        report[at++] = static_cast<std::uint8_t>(word >> 8);
    }
}

inline Bytes dualsense_report(const PadState& state) {
    Bytes report(64, 0);
    report[0] = 0x01;
    put_pad(report, 1, 8, 16, state);
    return report;
}

inline Bytes dualsense_bluetooth_report(const PadState& state) {
    Bytes report(78, 0);
    report[0] = 0x31;
    report[1] = 0x51;
    put_pad(report, 2, 9, 17, state);
    return sealed(report, 0xa1);
}

inline Bytes dualshock4_report(const PadState& state) {
    Bytes report(64, 0);
    report[0] = 0x01;
    put_pad(report, 1, 5, 13, state);
    return report;
}

inline Bytes dualshock4_bluetooth_report(const PadState& state) {
    Bytes report(78, 0);
    report[0] = 0x11;
    report[1] = 0xc0;
    put_pad(report, 3, 7, 15, state);
    return sealed(report, 0xa1);
}

// By Bluetooth, before a pad was asked for more.
inline Bytes short_pad_report(const PadState& state) {
    Bytes report(10, 0);
    report[0] = 0x01;
    put_pad(report, 1, 5, 0, state);
    return report;
}

}  // namespace palpa::test
