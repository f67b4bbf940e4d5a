// The report descriptor of a human interface device: which reports it has, and what stands where in
// them. Pure: bytes in, a list of fields out.
//
// "Device Class Definition for Human Interface Devices (HID)" 1.11, 6.2.2; usages by "HID Usage
// Tables", both of the USB-IF. Left out: long items, designators, strings, and of a delimited set
// of usages all but the first.
#pragma once
#include "devices/hid_bus.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

// The usage page in the upper half, the usage in the lower one.
using HidUsage = std::uint32_t;

enum class HidReportKind : std::uint8_t { Input, Output, Feature };

// A group of fields.
struct HidCollection {
    HidUsage usage = 0;
    std::uint8_t type = 0;     // 0 physical, 1 application, 2 logical
    std::int32_t parent = -1;  // the collection that it stands in, -1: none
};

// One value of a report, or the values of an array, one behind the other.
struct HidField {
    HidReportKind kind = HidReportKind::Input;
    std::uint8_t report = 0;  // its number; 0 where reports have none
    std::uint32_t bit = 0;    // from the first, which is of its number if it has one
    std::uint32_t bits = 0;   // of one value, 1 to 32
    std::uint32_t count = 1;  // of values; 1 unless it is an array
    std::int64_t logical_min = 0, logical_max = 0;
    std::int64_t physical_min = 0, physical_max = 0;  // the logical ones where none are given
    std::uint32_t unit = 0;                           // in nibbles, HID 1.11, 6.2.2.7
    std::int32_t unit_exponent = 0;                   // of ten
    bool is_array = false;  // a value is the number of one of the usages, from logical_min
    bool is_relative = false;
    bool is_constant = false;
    std::uint32_t first_usage = 0, usages = 0;  // in HidDescriptor::usages
    std::int32_t collection = -1;
};

struct HidReport {
    HidReportKind kind = HidReportKind::Input;
    std::uint8_t number = 0;
    std::uint32_t bits = 0;  // with the number, where it has one

    std::size_t bytes() const noexcept { return (bits + 7) / 8; }
};

struct HidDescriptor {
    std::vector<HidField> fields;  // those that have a usage
    std::vector<HidReport> reports;
    std::vector<HidUsage> usages;
    std::vector<HidCollection> collections;
    std::string_view wrong;  // why the bytes are no descriptor, and all else is empty

    std::span<const HidUsage> usages_of(const HidField& field) const {
        return std::span(usages).subspan(field.first_usage, field.usages);
    }
};

// What is longer, deeper or more than any device needs counts as wrong; of a range of usages the
// first thousand are kept.
HidDescriptor build_hid_descriptor(HidBytes bytes);

// The first field with that usage, in a collection with the usage `inside`, however deep; 0: in
// any.
const HidField* find_field(const HidDescriptor& descriptor, HidReportKind kind, HidUsage usage,
                           HidUsage inside = 0) noexcept;

// Null where there is none.
const HidReport* find_report(const HidDescriptor& descriptor, HidReportKind kind,
                             std::uint8_t number) noexcept;

// The value that stands for a usage of the field: its number in an array, else 1.
std::int64_t number_of(const HidDescriptor& descriptor, const HidField& field,
                       HidUsage usage) noexcept;

// The first value of a field, signed where its range is; nothing where the report is too short.
std::optional<std::int64_t> read_field(HidBytes report, const HidField& field) noexcept;

// Its low bits; nothing where the report is too short.
void write_field(std::span<std::uint8_t> report, const HidField& field,
                 std::int64_t value) noexcept;

}  // namespace palpa
