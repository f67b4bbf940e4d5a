#include "devices/hid_descriptor.h"

#include "tests/support/pid_stick.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <random>

using namespace palpa;
using test::Bytes;

namespace {

const HidField& field_in(const HidDescriptor& descriptor, HidReportKind kind, HidUsage usage,
                         HidUsage inside = 0) {
    const HidField* const field = find_field(descriptor, kind, usage, inside);
    REQUIRE(field);
    return *field;
}

// The simplest of things around the bytes that are tested.
HidDescriptor built(Bytes middle) {
    Bytes bytes{0x05, 0x01, 0x09, 0x04, 0xa1, 0x01};
    bytes.insert(bytes.end(), middle.begin(), middle.end());
    bytes.push_back(0xc0);
    return build_hid_descriptor(bytes);
}

constexpr auto input = HidReportKind::Input, output = HidReportKind::Output,
               feature = HidReportKind::Feature;

}  // namespace

TEST_CASE("a plain joystick's axes and buttons stand where its descriptor puts them",
          "[devices][hid-descriptor]") {
    // Three buttons, five bits to fill up, two axes of a byte, a wheel of ten bits.
    const HidDescriptor descriptor =
        built({0x05, 0x09, 0x19, 0x01, 0x29, 0x03, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95,
               0x03, 0x81, 0x02, 0x75, 0x05, 0x95, 0x01, 0x81, 0x03, 0x05, 0x01, 0x09, 0x30,
               0x09, 0x31, 0x15, 0x81, 0x25, 0x7f, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02, 0x09,
               0x38, 0x16, 0x00, 0xfe, 0x26, 0xff, 0x01, 0x75, 0x0a, 0x95, 0x01, 0x81, 0x06});

    REQUIRE(descriptor.wrong.empty());
    CHECK(descriptor.fields.size() == 6);
    REQUIRE(descriptor.reports.size() == 1);
    CHECK(descriptor.reports[0].number == 0);
    CHECK(descriptor.reports[0].bits == 34);
    CHECK(descriptor.reports[0].bytes() == 5);
    const HidField& third = field_in(descriptor, input, 0x090003);
    CHECK(third.bit == 2);
    CHECK(third.bits == 1);
    const HidField& y = field_in(descriptor, input, 0x010031);
    CHECK(y.bit == 16);
    CHECK(y.bits == 8);
    CHECK(y.logical_min == -127);
    CHECK(y.logical_max == 127);
    CHECK(y.physical_min == -127);
    CHECK_FALSE(y.is_relative);
    const HidField& wheel = field_in(descriptor, input, 0x010038);
    CHECK(wheel.bit == 24);
    CHECK(wheel.bits == 10);
    CHECK(wheel.is_relative);
    CHECK_FALSE(find_field(descriptor, input, 0x010032));
    CHECK_FALSE(find_field(descriptor, output, 0x010031));
    CHECK(find_field(descriptor, input, 0x010031, 0x010004));
    CHECK_FALSE(find_field(descriptor, input, 0x010031, 0x010005));
}

TEST_CASE("a force-feedback joystick's fields stand where its descriptor puts them",
          "[devices][hid-descriptor]") {
    const HidDescriptor descriptor = build_hid_descriptor(test::joined(test::stick_parts()));

    REQUIRE(descriptor.wrong.empty());
    // Counted by hand, in tests/support/pid_stick.h; the number is the first byte.
    const auto bytes_of = [&](HidReportKind kind, std::uint8_t number) {
        const HidReport* const report = find_report(descriptor, kind, number);
        return report ? report->bytes() : 0;
    };
    CHECK(bytes_of(input, 0x01) == 6);
    CHECK(bytes_of(input, 0x02) == 2);
    CHECK(bytes_of(output, 0x21) == 18);
    CHECK(bytes_of(output, 0x22) == 4);
    CHECK(bytes_of(output, 0x23) == 4);
    CHECK(bytes_of(output, 0x24) == 2);
    CHECK(bytes_of(output, 0x25) == 2);
    CHECK(bytes_of(feature, 0x31) == 4);
    CHECK(bytes_of(feature, 0x32) == 5);
    CHECK(bytes_of(feature, 0x21) == 0);
    const HidField& y = field_in(descriptor, input, 0x010031);
    CHECK(y.report == 1);
    CHECK(y.bit == 24);
    CHECK(y.logical_min == -2048);
    CHECK(y.logical_max == 2047);
    // The same usage in three reports.
    CHECK(field_in(descriptor, output, 0x0f0022, 0x0f0021).report == 0x21);
    CHECK(field_in(descriptor, output, 0x0f0022, 0x0f0073).report == 0x22);
    CHECK(field_in(descriptor, output, 0x0f0022, 0x0f0077).report == 0x23);
    // An array deep inside, whose values number its usages from 1.
    const HidField& type = field_in(descriptor, output, 0x0f0026, 0x0f0021);
    CHECK(type.is_array);
    CHECK(type.bit == 16);
    CHECK(number_of(descriptor, type, 0x0f0026) == 1);
    CHECK(number_of(descriptor, type, 0x0f0030) == 2);
    const HidField& duration = field_in(descriptor, output, 0x0f0050);
    CHECK(duration.bit == 24);
    CHECK(duration.unit == 0x1003);  // seconds
    CHECK(duration.unit_exponent == -3);
    CHECK(field_in(descriptor, output, 0x0f0052).bit == 72);
    CHECK(field_in(descriptor, output, 0x0f0052).physical_max == 10000);
    CHECK(field_in(descriptor, output, 0x010031, 0x0f0055).bit == 89);
    CHECK(field_in(descriptor, output, 0x0f0056).bit == 90);
    const HidField& direction = field_in(descriptor, output, 0x0a0002, 0x0f0057);
    CHECK(direction.bit == 112);
    CHECK(direction.logical_max == 36000);
    CHECK(direction.unit_exponent == -2);
    CHECK(field_in(descriptor, output, 0x0f00a7).bit == 128);
    const HidField& magnitude = field_in(descriptor, output, 0x0f0070, 0x0f0073);
    CHECK(magnitude.bit == 16);
    CHECK(magnitude.bits == 16);
    CHECK(magnitude.logical_min == -10000);
    CHECK(magnitude.logical_max == 10000);
    CHECK(field_in(descriptor, feature, 0x01003b).bits == 10);
    CHECK(field_in(descriptor, feature, 0x0f00ac).logical_max == 65535);
}

TEST_CASE("what is pushed comes back when it is popped", "[devices][hid-descriptor]") {
    const HidDescriptor descriptor =
        built({0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x01, 0xa4, 0x05, 0x0f, 0x25,
               0x7f, 0x75, 0x08, 0x09, 0x50, 0x81, 0x02, 0xb4, 0x09, 0x30, 0x81, 0x02});

    const HidField& inner = field_in(descriptor, input, 0x0f0050);
    const HidField& outer = field_in(descriptor, input, 0x010030);
    CHECK(inner.bits == 8);
    CHECK(inner.logical_max == 127);
    CHECK(outer.bits == 1);
    CHECK(outer.bit == 8);
    CHECK(outer.logical_max == 1);
}

TEST_CASE("usages get the page that holds at the main item, unless they bring their own",
          "[devices][hid-descriptor]") {
    const HidDescriptor descriptor = built(
        {0x75, 0x08, 0x95, 0x02, 0x09, 0x30, 0x0b, 0x31, 0x00, 0x02, 0x00, 0x05, 0x0f, 0x81, 0x02});

    CHECK(field_in(descriptor, input, 0x0f0030).bit == 0);
    CHECK(field_in(descriptor, input, 0x020031).bit == 8);
}

TEST_CASE("values beyond the usages share the last one", "[devices][hid-descriptor]") {
    const HidDescriptor descriptor =
        built({0x75, 0x04, 0x95, 0x03, 0x09, 0x30, 0x09, 0x31, 0x81, 0x02});

    REQUIRE(descriptor.fields.size() == 3);
    CHECK(descriptor.usages_of(descriptor.fields[0])[0] == 0x010030);
    CHECK(descriptor.usages_of(descriptor.fields[1])[0] == 0x010031);
    CHECK(descriptor.usages_of(descriptor.fields[2])[0] == 0x010031);
    CHECK(descriptor.fields[2].bit == 8);
}

TEST_CASE("an array is one field with all its usages", "[devices][hid-descriptor]") {
    // Six keys of a keyboard, of 0 to 101.
    const HidDescriptor descriptor = built({0x05, 0x07, 0x19, 0x00, 0x29, 0x65, 0x15, 0x00, 0x25,
                                            0x65, 0x75, 0x08, 0x95, 0x06, 0x81, 0x00});

    REQUIRE(descriptor.fields.size() == 1);
    const HidField& keys = descriptor.fields[0];
    CHECK(keys.is_array);
    CHECK(keys.count == 6);
    CHECK(keys.usages == 102);
    CHECK(number_of(descriptor, keys, 0x070004) == 4);
    CHECK(descriptor.reports[0].bits == 48);
}

TEST_CASE("long items and delimiters are passed over", "[devices][hid-descriptor]") {
    const HidDescriptor descriptor =
        built({0xfe, 0x03, 0x10, 0x81, 0x02, 0xc0,              // three bytes of anything
               0x75, 0x08, 0x95, 0x02,                          //
               0xa9, 0x01, 0x09, 0x30, 0x09, 0x32, 0xa9, 0x00,  // X, or else Z
               0x09, 0x31, 0x81, 0x02});

    REQUIRE(descriptor.wrong.empty());
    CHECK(field_in(descriptor, input, 0x010030).bit == 0);
    CHECK(field_in(descriptor, input, 0x010031).bit == 8);
    CHECK_FALSE(find_field(descriptor, input, 0x010032));
}

TEST_CASE("the upper end of a range has a sign if the lower one does",
          "[devices][hid-descriptor]") {
    const HidDescriptor descriptor = built({0x75, 0x08, 0x95, 0x01, 0x25, 0xff, 0x15, 0x00, 0x09,
                                            0x30, 0x81, 0x02, 0x15, 0x80, 0x09, 0x31, 0x81, 0x02});

    CHECK(field_in(descriptor, input, 0x010030).logical_max == 255);
    CHECK(field_in(descriptor, input, 0x010031).logical_max == -1);
    CHECK(field_in(descriptor, input, 0x010031).logical_min == -128);
}

TEST_CASE("a descriptor that is none says why", "[devices][hid-descriptor]") {
    const auto why = [](const Bytes& bytes) {
        const HidDescriptor descriptor = build_hid_descriptor(bytes);
        CHECK(descriptor.fields.empty());
        CHECK(descriptor.reports.empty());
        return std::string(descriptor.wrong);
    };
    const Bytes value{0x09, 0x30, 0x75, 0x08, 0x95, 0x01, 0x81, 0x02};
    const auto behind = [&](const Bytes& bytes) {
        Bytes all = value;
        all.insert(all.end(), bytes.begin(), bytes.end());
        return why(all);
    };
    const auto often = [](const Bytes& bytes, int times) {
        Bytes all;
        for (int i = 0; i < times; ++i) all.insert(all.end(), bytes.begin(), bytes.end());
        return all;
    };

    CHECK(build_hid_descriptor(value).wrong.empty());
    CHECK(behind({0x26, 0xff}) == "it ends in the middle of an item");
    CHECK(behind({0xfe}) == "it ends in the middle of an item");
    CHECK(behind({0xfe, 0x02, 0x10, 0x00}) == "it ends in the middle of an item");
    CHECK(behind({0xa1, 0x01}) == "it ends in a collection");
    CHECK(behind({0xc0}) == "it ends a collection that did not begin");
    CHECK(behind({0xb4}) == "it has a POP item without a PUSH");
    CHECK(behind({0x85, 0x00}) == "a report has an invalid number");
    CHECK(behind({0x86, 0x00, 0x01}) == "a report has an invalid number");
    CHECK(behind(often({0xa4}, 17)) == "it has too many PUSH items");
    CHECK(behind(often({0xa1, 0x01}, 33)) == "its collections are nested too deeply");
    CHECK(behind({0x97, 0xff, 0xff, 0xff, 0xff, 0x77, 0xff, 0xff, 0xff, 0xff, 0x81, 0x02}) ==
          "a report of it is longer than 4096 bytes");
    CHECK(behind({0x09, 0x30, 0x75, 0x01, 0x96, 0x01, 0x10, 0x81, 0x02}) ==
          "it has more than 4096 fields");
    CHECK(why(Bytes(4097, 0)) == "it is longer than 4096 bytes");
}

TEST_CASE("a field is read and written where it stands, across bytes and with its sign",
          "[devices][hid-descriptor]") {
    HidField field;
    field.bit = 13;
    field.bits = 11;
    const bool is_signed = GENERATE(false, true);
    field.logical_min = is_signed ? -1024 : 0;
    // Bits 13 to 23: three of byte 1, eight of byte 2.
    Bytes report{0xff, 0x5f, 0x80, 0xff};  // 010 and 10000000

    CHECK(read_field(report, field) == 0x402 - (is_signed ? 0x800 : 0));
    write_field(report, field, is_signed ? -3 : 0x7fd);
    CHECK(report == Bytes{0xff, 0xbf, 0xff, 0xff});  // 101 and 11111111
    CHECK(read_field(report, field) == (is_signed ? -3 : 0x7fd));
    write_field(report, field, 0);
    CHECK(report == Bytes{0xff, 0x1f, 0x00, 0xff});

    report.resize(2);
    CHECK_FALSE(read_field(report, field));
    write_field(report, field, -1);
    CHECK(report == Bytes{0xff, 0x1f});
}

TEST_CASE("a whole word is read with and without its sign", "[devices][hid-descriptor]") {
    HidField field;
    field.bits = 32;
    const Bytes report{0xfe, 0xff, 0xff, 0xff};

    CHECK(read_field(report, field) == 0xfffffffe);
    field.logical_min = -1;
    CHECK(read_field(report, field) == -2);
}

TEST_CASE("a descriptor with wrong bits or an early end never gives a field beyond its report",
          "[devices][hid-descriptor]") {
    const Bytes sound = test::joined(test::stick_parts());
    std::mt19937 random(3);
    int built = 0;

    for (int i = 0; i < 20'000; ++i) {
        Bytes bytes = sound;
        const std::size_t flips = 1 + random() % 4;
        for (std::size_t k = 0; k < flips; ++k) {
            bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
        }
        if (random() % 3 == 0) bytes.resize(random() % bytes.size());
        const HidDescriptor descriptor = build_hid_descriptor(bytes);
        built += descriptor.wrong.empty() ? 1 : 0;
        for (const HidField& field : descriptor.fields) {
            const HidReport* const report = find_report(descriptor, field.kind, field.report);
            const bool is_inside =
                report && field.bits >= 1 && field.bits <= 32 &&
                field.bit + std::uint64_t{field.bits} * field.count <= report->bits;
            if (!is_inside || descriptor.usages_of(field).empty()) FAIL("descriptor " << i);
        }
    }

    CHECK(built > 2000);
}
