#include "charmm/packed_fields.h"
#include "charmm/packed_force_field.h"
#include "core/text.h"

#include <fmt/format.h>
#include <zlib.h>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <new>
#include <utility>

namespace palpa {
namespace {

class PackWriter {
public:
    std::string take() { return std::move(bytes_); }

    template <class Whole>
    void count(Whole value) {
        auto rest = static_cast<std::uint64_t>(value);
        for (; rest >= 128; rest >>= 7) byte(static_cast<unsigned char>(rest | 128));
        byte(static_cast<unsigned char>(rest));
    }
    void optional_count(std::int64_t value) { count(value + 1); }
    void flag(bool value) { byte(value ? 1 : 0); }

    void name(const std::string& name, PackedName = PackedName::Any) {
        const auto [known, is_new] = names_.try_emplace(name, names_.size());
        if (!is_new) return count(known->second + 1);
        count(0);
        count(name.size());
        bytes_ += name;
    }

    void number(double value, PackedNumber = PackedNumber::Any) {
        const bool is_minus_zero = value == 0 && std::signbit(value);  // which no whole number is
        for (std::size_t decimals = is_minus_zero ? packed_powers.size() : 0;
             decimals < packed_powers.size(); ++decimals) {
            const double digits = std::round(value * packed_powers[decimals]);
            if (std::abs(digits) > 9e15) break;
            const double read = digits / packed_powers[decimals];
            if (std::bit_cast<std::uint64_t>(read) != std::bit_cast<std::uint64_t>(value)) continue;
            byte(static_cast<unsigned char>(decimals));
            const auto whole = static_cast<std::int64_t>(digits);
            return count(whole >= 0 ? 2 * whole : -2 * whole - 1);
        }
        byte(255);
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (int i = 0; i < 8; ++i) byte(static_cast<unsigned char>(bits >> (8 * i)));
    }

    template <class List, class Each>
    void list(const List& values, const Each& each) {
        count(values.size());
        for (const auto& value : values) each(value);
    }
    template <class Map, class Key, class Value>
    void map(const Map& values, const Key& key, const Value& value) {
        count(values.size());
        for (const auto& [one_key, one_value] : values) {
            key(one_key);
            value(one_value);
        }
    }
    template <class Value>
    void finish(const Value&) const noexcept {}

private:
    void byte(unsigned char value) { bytes_ += static_cast<char>(value); }

    std::string bytes_;
    std::map<std::string, std::size_t> names_;
};

std::string compressed(const std::string& plain) {
    uLongf size = compressBound(static_cast<uLong>(plain.size()));
    std::string packed(size, '\0');
    const int code = compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                               reinterpret_cast<const Bytef*>(plain.data()),
                               static_cast<uLong>(plain.size()), Z_BEST_COMPRESSION);
    if (code != Z_OK) throw std::bad_alloc();  // the buffer is large enough
    packed.resize(size);
    return packed;
}

}  // namespace

std::string pack_force_field(const ForceField& force_field, std::span<const std::string> about) {
    std::string text = fmt::format("{}\n", packed_mark);
    for (const std::string& line : about) {
        if (line.empty() || printable(line) != line) {
            throw LoadError(
                {"about"},
                fmt::format(
                    "the line '{}' has characters that cannot be printed; expected plain text",
                    printable(line)));
        }
        text += line + '\n';
    }
    if (about.empty()) throw LoadError({"about"}, "is empty; expected at least a title line");
    PackWriter writer;
    visit_force_field(writer, force_field);
    const std::string plain = writer.take(), packed = compressed(plain);
    return text + fmt::format("\n{} {}\n", packed.size(), plain.size()) + packed;
}

}  // namespace palpa
