// Any report changes what a device asks of its handle within its limits, or nothing at all.
#include "devices/sony_pad.h"
#include "devices/space_mouse.h"
#include "tests/fuzz/expect.h"
#include "tests/support/hid_reports.h"

#include <cstddef>
#include <cstdint>

using namespace palpa;

namespace {

// The sticks' turn, and that of a gyroscope whose three words are at their ends.
constexpr double fastest_turn_rad_per_s = 63;

void expect_within_limits(HidProtocol& protocol, HidBytes report) {
    HidInput input;
    const bool is_one = protocol.decode(report, input);
    PALPA_EXPECT(input.rate.m_per_s.allFinite() && input.rate.rad_per_s.allFinite());
    PALPA_EXPECT(input.rate.m_per_s.cwiseAbs().maxCoeff() <= 0.060);
    PALPA_EXPECT(input.rate.rad_per_s.norm() <= fastest_turn_rad_per_s);
    PALPA_EXPECT(input.buttons < 4);
    const bool is_changed = input.buttons != 0 || input.rate.m_per_s != Vec3::Zero() ||
                            input.rate.rad_per_s != Vec3::Zero();
    PALPA_EXPECT(is_one || !is_changed);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const HidBytes report(data, size);
    SpaceMouseProtocol mouse;
    expect_within_limits(mouse, report);
    for (const SonyModel model : {SonyModel::DualSense, SonyModel::DualShock4}) {
        for (const bool is_bluetooth : {false, true}) {
            SonyPadProtocol pad(model);
            pad.use_bluetooth(is_bluetooth);
            expect_within_limits(pad, report);
            if (!is_bluetooth || size <= 4) continue;
            const test::Bytes sealed = test::sealed({data, data + size}, 0xa1);
            expect_within_limits(pad, sealed);
        }
    }
    return 0;
}
