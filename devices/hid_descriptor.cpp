#include "devices/hid_descriptor.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace palpa {
namespace {

// The kernel's own limits of a descriptor and a report are 4096 and 16384 bytes.
constexpr std::size_t longest_descriptor = 4096, most_fields = 4096, most_usages = 1024;
constexpr std::size_t most_pushed = 16, deepest = 32;
constexpr std::uint64_t longest_report_bits = std::uint64_t{8} * 4096;
constexpr std::uint32_t longest_value_bits = 32;

// Types and tags of short items, HID 1.11, 6.2.2.4 to 6.2.2.8.
enum class ItemType : std::uint8_t { Main, Global, Local };
enum class MainTag : std::uint8_t { Input = 8, Output, Collection, Feature, EndCollection };
enum class GlobalTag : std::uint8_t {
    UsagePage,
    LogicalMin,
    LogicalMax,
    PhysicalMin,
    PhysicalMax,
    UnitExponent,
    Unit,
    ReportSize,
    ReportId,
    ReportCount,
    Push,
    Pop
};
enum class LocalTag : std::uint8_t { Usage, UsageMin, UsageMax, Delimiter = 10 };

struct Item {
    std::uint8_t type = 0, tag = 0;
    std::uint32_t size = 0;  // bytes of data
    std::uint32_t data = 0;

    std::int64_t signed_data() const noexcept {
        if (size == 1) return static_cast<std::int8_t>(data);
        if (size == 2) return static_cast<std::int16_t>(data);
        return static_cast<std::int32_t>(data);
    }
};

// Both ends of a range: whether the upper one has a sign is up to the lower one.
struct Range {
    std::int64_t min = 0;
    Item max;

    std::int64_t upper() const noexcept {
        return min < 0 ? max.signed_data() : std::int64_t{max.data};
    }
};

struct Globals {
    std::uint32_t page = 0;
    Range logical, physical;
    std::uint32_t unit = 0, size = 0, count = 0;
    std::int32_t exponent = 0;
    std::uint8_t report = 0;
};

// A usage of four bytes has its page in it; the others get the one that holds at the main item.
struct LocalUsage {
    std::uint32_t usage = 0;
    bool has_page = false;
};

struct Locals {
    std::vector<LocalUsage> usages;
    LocalUsage min;
    bool is_delimited = false, has_first = false;  // in a set; its first usage was there
};

class DescriptorBuilder {
public:
    HidDescriptor build(HidBytes bytes) {
        if (bytes.size() > longest_descriptor) fail("it is longer than 4096 bytes");
        while (!bytes.empty() && is_sound()) bytes = take_item(bytes);
        if (is_sound() && open_ >= 0) fail("it ends in a collection");
        if (!is_sound()) return {{}, {}, {}, {}, out_.wrong};
        return std::move(out_);
    }

private:
    void fail(std::string_view why) { out_.wrong = why; }
    bool is_sound() const { return out_.wrong.empty(); }

    // What is left behind the first item.
    HidBytes take_item(HidBytes bytes) {
        constexpr std::uint8_t long_item = 0xfe;
        const std::uint8_t prefix = bytes[0];
        const bool is_long = prefix == long_item;
        if (is_long && bytes.size() < 2) return cut();
        const std::size_t size = is_long ? 2U + bytes[1] : (prefix & 3U) == 3 ? 4U : prefix & 3U;
        if (bytes.size() < 1 + size) return cut();
        if (!is_long) take(item_of(prefix, bytes.subspan(1, size)));
        return bytes.subspan(1 + size);
    }

    HidBytes cut() {
        fail("it ends in the middle of an item");
        return {};
    }

    static Item item_of(std::uint8_t prefix, HidBytes data) {
        Item item{static_cast<std::uint8_t>(prefix >> 2 & 3U),
                  static_cast<std::uint8_t>(prefix >> 4), static_cast<std::uint32_t>(data.size()),
                  0};
        for (std::size_t i = data.size(); i-- > 0;) item.data = item.data << 8 | data[i];
        return item;
    }

    void take(const Item& item) {
        switch (static_cast<ItemType>(item.type)) {
            case ItemType::Main:
                take_main(item);
                local_ = {};
                break;
            case ItemType::Global:
                take_global(item);
                break;
            case ItemType::Local:
                take_local(item);
                break;
        }
    }

    void take_main(const Item& item) {
        switch (static_cast<MainTag>(item.tag)) {
            case MainTag::Input:
                return add_fields(HidReportKind::Input, item.data);
            case MainTag::Output:
                return add_fields(HidReportKind::Output, item.data);
            case MainTag::Feature:
                return add_fields(HidReportKind::Feature, item.data);
            case MainTag::Collection:
                return open_collection(item);
            case MainTag::EndCollection:
                return close_collection();
        }
    }

    void take_global(const Item& item) {
        switch (static_cast<GlobalTag>(item.tag)) {
            case GlobalTag::UsagePage:
                global_.page = item.data & 0xffffU;
                break;
            case GlobalTag::LogicalMin:
                global_.logical.min = item.signed_data();
                break;
            case GlobalTag::LogicalMax:
                global_.logical.max = item;
                break;
            case GlobalTag::PhysicalMin:
                global_.physical.min = item.signed_data();
                break;
            case GlobalTag::PhysicalMax:
                global_.physical.max = item;
                break;
            case GlobalTag::UnitExponent:
                // A nibble with a sign; many give a whole byte.
                global_.exponent = item.data > 7 && item.data < 16
                                       ? static_cast<std::int32_t>(item.data) - 16
                                       : static_cast<std::int32_t>(item.signed_data());
                break;
            case GlobalTag::Unit:
                global_.unit = item.data;
                break;
            case GlobalTag::ReportSize:
                global_.size = item.data;
                break;
            case GlobalTag::ReportCount:
                global_.count = item.data;
                break;
            case GlobalTag::ReportId:
                if (item.data == 0 || item.data > 0xff)
                    return fail("a report has an invalid number");
                global_.report = static_cast<std::uint8_t>(item.data);
                break;
            case GlobalTag::Push:
                if (pushed_.size() == most_pushed) return fail("it has too many PUSH items");
                pushed_.push_back(global_);
                break;
            case GlobalTag::Pop:
                if (pushed_.empty()) return fail("it has a POP item without a PUSH");
                global_ = pushed_.back();
                pushed_.pop_back();
                break;
        }
    }

    void take_local(const Item& item) {
        const LocalUsage usage{item.data, item.size == 4};
        switch (static_cast<LocalTag>(item.tag)) {
            case LocalTag::Usage:
                add_usage(usage);
                break;
            case LocalTag::UsageMin:
                local_.min = usage;
                break;
            case LocalTag::UsageMax:
                add_range(usage);
                break;
            case LocalTag::Delimiter:
                local_.is_delimited = item.data == 1;
                local_.has_first = false;
                break;
        }
    }

    void add_usage(const LocalUsage& usage) {
        if (local_.is_delimited && std::exchange(local_.has_first, true)) return;
        if (local_.usages.size() < most_usages) local_.usages.push_back(usage);
    }

    void add_range(const LocalUsage& last) {
        const std::uint64_t first = local_.min.usage;
        if (last.usage < first) return;
        const auto count = std::min<std::uint64_t>(last.usage - first + 1, most_usages);
        for (std::uint64_t i = 0; i < count; ++i) {
            add_usage({static_cast<std::uint32_t>(first + i), last.has_page});
        }
    }

    HidUsage whole(const LocalUsage& usage) const {
        return usage.has_page ? usage.usage : global_.page << 16 | (usage.usage & 0xffffU);
    }

    void open_collection(const Item& item) {
        if (++depth_ > deepest) return fail("its collections are nested too deeply");
        const HidUsage usage = local_.usages.empty() ? 0 : whole(local_.usages.front());
        out_.collections.push_back({usage, static_cast<std::uint8_t>(item.data), open_});
        open_ = static_cast<std::int32_t>(out_.collections.size()) - 1;
    }

    void close_collection() {
        if (open_ < 0) return fail("it ends a collection that did not begin");
        --depth_;
        open_ = out_.collections[static_cast<std::size_t>(open_)].parent;
    }

    HidReport& report_of(HidReportKind kind) {
        const auto found =
            std::find_if(out_.reports.begin(), out_.reports.end(), [&](const HidReport& report) {
                return report.kind == kind && report.number == global_.report;
            });
        if (found != out_.reports.end()) return *found;
        out_.reports.push_back({kind, global_.report, global_.report == 0 ? 0U : 8U});
        return out_.reports.back();
    }

    void add_fields(HidReportKind kind, std::uint32_t flags) {
        HidReport& report = report_of(kind);
        const std::uint64_t bits = std::uint64_t{global_.size} * global_.count;
        if (bits > longest_report_bits || report.bits + bits > longest_report_bits) {
            return fail("a report of it is longer than 4096 bytes");
        }
        HidField field = field_of(kind, flags);
        field.bit = report.bits;
        report.bits += static_cast<std::uint32_t>(bits);
        const bool has_value = field.bits > 0 && field.bits <= longest_value_bits && bits > 0;
        if (!has_value || local_.usages.empty()) return;  // to fill up
        field.first_usage = static_cast<std::uint32_t>(out_.usages.size());
        for (const LocalUsage& usage : local_.usages) out_.usages.push_back(whole(usage));
        field.is_array ? add_array(field) : add_variables(field);
    }

    HidField field_of(HidReportKind kind, std::uint32_t flags) const {
        HidField field;
        field.kind = kind;
        field.report = global_.report;
        field.bits = global_.size;
        field.logical_min = global_.logical.min;
        field.logical_max = global_.logical.upper();
        const bool is_told = global_.physical.min != 0 || global_.physical.upper() != 0;
        field.physical_min = is_told ? global_.physical.min : field.logical_min;
        field.physical_max = is_told ? global_.physical.upper() : field.logical_max;
        field.unit = global_.unit;
        field.unit_exponent = global_.exponent;
        field.is_constant = (flags & 1U) != 0;
        field.is_array = (flags & 2U) == 0;
        field.is_relative = (flags & 4U) != 0;
        field.collection = open_;
        return field;
    }

    void add_array(HidField field) {
        field.count = global_.count;
        field.usages = static_cast<std::uint32_t>(local_.usages.size());
        add_field(field);
    }

    // The last usage is that of all that are left.
    void add_variables(HidField field) {
        const std::uint32_t first_usage = field.first_usage;
        const auto last = static_cast<std::uint32_t>(local_.usages.size()) - 1;
        field.usages = 1;
        for (std::uint32_t i = 0; i < global_.count && is_sound(); ++i) {
            field.first_usage = first_usage + std::min(i, last);
            add_field(field);
            field.bit += field.bits;
        }
    }

    void add_field(const HidField& field) {
        if (out_.fields.size() == most_fields) return fail("it has more than 4096 fields");
        out_.fields.push_back(field);
    }

    HidDescriptor out_;
    Globals global_;
    Locals local_;
    std::vector<Globals> pushed_;
    std::int32_t open_ = -1;  // the innermost collection
    std::size_t depth_ = 0;
};

bool is_inside(const HidDescriptor& descriptor, std::int32_t collection, HidUsage usage) noexcept {
    while (collection >= 0) {
        const HidCollection& one = descriptor.collections[static_cast<std::size_t>(collection)];
        if (one.usage == usage) return true;
        collection = one.parent;
    }
    return false;
}

std::size_t bytes_up_to(const HidField& field) noexcept {
    return (std::size_t{field.bit} + field.bits + 7) / 8;
}

}  // namespace

HidDescriptor build_hid_descriptor(HidBytes bytes) { return DescriptorBuilder().build(bytes); }

const HidField* find_field(const HidDescriptor& descriptor, HidReportKind kind, HidUsage usage,
                           HidUsage inside) noexcept {
    for (const HidField& field : descriptor.fields) {
        const auto usages = descriptor.usages_of(field);
        if (field.kind == kind && std::find(usages.begin(), usages.end(), usage) != usages.end() &&
            (inside == 0 || is_inside(descriptor, field.collection, inside))) {
            return &field;
        }
    }
    return nullptr;
}

const HidReport* find_report(const HidDescriptor& descriptor, HidReportKind kind,
                             std::uint8_t number) noexcept {
    const auto found = std::find_if(
        descriptor.reports.begin(), descriptor.reports.end(),
        [&](const HidReport& report) { return report.kind == kind && report.number == number; });
    return found == descriptor.reports.end() ? nullptr : &*found;
}

std::int64_t number_of(const HidDescriptor& descriptor, const HidField& field,
                       HidUsage usage) noexcept {
    if (!field.is_array) return 1;
    const auto usages = descriptor.usages_of(field);
    return field.logical_min + (std::find(usages.begin(), usages.end(), usage) - usages.begin());
}

std::optional<std::int64_t> read_field(HidBytes report, const HidField& field) noexcept {
    if (field.bits == 0 || report.size() < bytes_up_to(field)) return {};
    std::uint64_t value = 0;
    for (std::uint32_t i = 0; i < field.bits; ++i) {
        const std::uint32_t bit = field.bit + i;
        value |= std::uint64_t{report[bit / 8] >> bit % 8 & 1U} << i;
    }
    const bool is_negative = field.logical_min < 0 && (value >> (field.bits - 1) & 1U) != 0;
    return static_cast<std::int64_t>(value) -
           (is_negative ? std::int64_t{1} << field.bits : std::int64_t{0});
}

void write_field(std::span<std::uint8_t> report, const HidField& field,
                 std::int64_t value) noexcept {
    if (report.size() < bytes_up_to(field)) return;
    for (std::uint32_t i = 0; i < field.bits; ++i) {
        const std::uint32_t bit = field.bit + i;
        const auto mask = static_cast<std::uint8_t>(1U << bit % 8);
        const bool is_set = (static_cast<std::uint64_t>(value) >> i & 1U) != 0;
        report[bit / 8] =
            static_cast<std::uint8_t>(is_set ? report[bit / 8] | mask : report[bit / 8] & ~mask);
    }
}

}  // namespace palpa
