// Parses the report descriptor of a human interface device: its reports and the fields in them.
// Pure: bytes in, a list of fields out.
//
// "Device Class Definition for Human Interface Devices (HID)" 1.11, 6.2.2; usages from "HID Usage
// Tables", both of the USB-IF. Not supported: long items, designators, strings, and all but the
// first usage of a delimited set.
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
    std::int32_t parent = -1;  // enclosing collection; -1: none
};

// One value of a report, or the values of an array, stored one after the other.
struct HidField {
    HidReportKind kind = HidReportKind::Input;
    std::uint8_t report = 0;  // report number; 0 if reports have none
    std::uint32_t bit = 0;    // bit offset in the report, including the report number
    std::uint32_t bits = 0;   // bits of one value, 1 to 32
    std::uint32_t count = 1;  // number of values; 1 unless it is an array
    std::int64_t logical_min = 0, logical_max = 0;
    std::int64_t physical_min = 0, physical_max = 0;  // equal to the logical range if not given
    std::uint32_t unit = 0;                           // in nibbles, see HID 1.11, 6.2.2.7
    std::int32_t unit_exponent = 0;                   // power of ten
    bool is_array = false;  // a value is the index of a usage, counted from logical_min
    bool is_relative = false;
    bool is_constant = false;
    std::uint32_t first_usage = 0, usages = 0;  // in HidDescriptor::usages
    std::int32_t collection = -1;
};

struct HidReport {
    HidReportKind kind = HidReportKind::Input;
    std::uint8_t number = 0;
    std::uint32_t bits = 0;  // length, including the report number

    std::size_t bytes() const noexcept { return (bits + 7) / 8; }
};

struct HidDescriptor {
    std::vector<HidField> fields;  // fields with a usage
    std::vector<HidReport> reports;
    std::vector<HidUsage> usages;
    std::vector<HidCollection> collections;
    std::string_view wrong;  // why the bytes are not a descriptor; all else is empty then

    std::span<const HidUsage> usages_of(const HidField& field) const {
        return std::span(usages).subspan(field.first_usage, field.usages);
    }
};

// A descriptor that is longer, deeper or larger than any device needs counts as wrong; only the
// first thousand usages of a range are stored.
HidDescriptor build_hid_descriptor(HidBytes bytes);

// The first field with this usage inside a collection with the usage `inside`, at any depth;
// `inside` 0: anywhere. Null if there is none.
const HidField* find_field(const HidDescriptor& descriptor, HidReportKind kind, HidUsage usage,
                           HidUsage inside = 0) noexcept;

// Null if there is none.
const HidReport* find_report(const HidDescriptor& descriptor, HidReportKind kind,
                             std::uint8_t number) noexcept;

// The value that stands for a usage of the field: its index in an array, else 1.
std::int64_t number_of(const HidDescriptor& descriptor, const HidField& field,
                       HidUsage usage) noexcept;

// The first value of a field, signed if its range is; empty if the report is too short.
std::optional<std::int64_t> read_field(HidBytes report, const HidField& field) noexcept;

// Writes the low bits of the value; does nothing if the report is too short.
void write_field(std::span<std::uint8_t> report, const HidField& field,
                 std::int64_t value) noexcept;

}  // namespace palpa
