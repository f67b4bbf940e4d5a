// Any bytes are a report descriptor with fields inside its reports, or none that says why; and a
// joystick with that descriptor reads any report within its stick's way.
#include "devices/force_joystick.h"
#include "devices/hid_descriptor.h"
#include "tests/fuzz/expect.h"

#include <cstddef>
#include <cstdint>
#include <vector>

using namespace palpa;

namespace {

void expect_inside(const HidDescriptor& descriptor, const HidField& field) {
    const HidReport* const report = find_report(descriptor, field.kind, field.report);
    PALPA_EXPECT(report);
    PALPA_EXPECT(field.bits >= 1 && field.bits <= 32 && field.count >= 1);
    PALPA_EXPECT(field.bit + std::uint64_t{field.bits} * field.count <= report->bits);
    PALPA_EXPECT(!descriptor.usages_of(field).empty());
    PALPA_EXPECT(field.collection < static_cast<std::int64_t>(descriptor.collections.size()));
    const HidUsage usage = descriptor.usages_of(field).back();
    PALPA_EXPECT(number_of(descriptor, field, usage) >= (field.is_array ? field.logical_min : 1));
}

// What is written is read, and nothing else has changed.
void expect_kept(const HidDescriptor& descriptor, const HidField& field) {
    std::vector<std::uint8_t> report(find_report(descriptor, field.kind, field.report)->bytes(),
                                     0xa5);
    const std::vector<std::uint8_t> before = report;
    const auto old = read_field(report, field);
    PALPA_EXPECT(old);
    const std::int64_t least = field.logical_min < 0 ? -1 : 1;
    write_field(report, field, least);
    PALPA_EXPECT(read_field(report, field) == least);
    write_field(report, field, *old);
    PALPA_EXPECT(report == before);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const HidBytes bytes(data, size);
    const HidDescriptor descriptor = build_hid_descriptor(bytes);
    PALPA_EXPECT(descriptor.wrong.empty() || descriptor.fields.empty());
    for (const HidField& field : descriptor.fields) expect_inside(descriptor, field);
    if (!descriptor.fields.empty()) {
        expect_kept(descriptor, descriptor.fields.front());
        expect_kept(descriptor, descriptor.fields.back());
    }
    ForceJoystickProtocol stick;
    if (!stick.use(bytes).empty()) return 0;
    HidInput input;
    for (std::size_t from = 0; from < size; ++from) (void)stick.decode(bytes.subspan(from), input);
    const Vec3 place = input.place_m.value_or(Vec3::Zero());
    PALPA_EXPECT(place.cwiseAbs().maxCoeff() <= ForceJoystickProtocol::half_travel_m);
    PALPA_EXPECT(input.buttons < 2);
    return 0;
}
