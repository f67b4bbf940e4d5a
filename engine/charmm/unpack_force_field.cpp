#include "charmm/packed_fields.h"
#include "charmm/packed_force_field.h"
#include "core/text.h"

#include <fmt/format.h>
#include <zlib.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t most_plain_bytes = std::size_t{1} << 28;
constexpr std::size_t most_about_bytes = std::size_t{1} << 16;
constexpr std::size_t longest_name = 100;
constexpr int most_multiplicity = 12;
constexpr std::size_t most_reserved = 1000;  // elements, before any has been read

class PackReader {
public:
    PackReader(std::string_view bytes, const std::string& file)
        : bytes_(bytes), file_(file), place_{std::filesystem::path(file).filename().string()} {}

    // That all bytes were read, and no name was new twice: then places stand for names.
    void finish_all() const {
        if (at_ != bytes_.size()) fail("extra bytes");
        std::vector<std::string_view> names;
        for (const KnownName& known : names_) names.push_back(known.text);
        std::ranges::sort(names);
        if (std::ranges::adjacent_find(names) != names.end()) fail("a repeated name");
    }

    [[noreturn]] void fail(std::string_view what) const {
        throw LoadError({file_}, fmt::format("the packed force field is damaged: {} at byte {} of "
                                             "its content",
                                             what, at_));
    }

    std::uint64_t whole() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 63; shift += 7) {
            const std::uint64_t group = byte();
            value |= (group & 127) << shift;
            if (group < 128) return value;
        }
        fail("a number too large");
    }
    template <class Whole>
    void count(Whole& value) {
        const std::uint64_t read = whole();
        if (read > std::uint64_t{std::numeric_limits<int>::max()}) fail("a number too large");
        value = static_cast<Whole>(read);
    }
    void optional_count(std::int64_t& value) {
        std::uint32_t read = 0;
        count(read);
        value = std::int64_t{read} - 1;
    }
    void flag(bool& value) { value = byte() != 0; }

    void name(std::string& name, PackedName kind = PackedName::Any) {
        const std::uint64_t index = whole();
        if (index == 0) names_.push_back({read_name()});
        const std::size_t at = index == 0 ? names_.size() - 1 : index - 1;
        if (at >= names_.size()) fail("an unknown name");
        KnownName& known = names_[at];
        if (known.text.empty() && kind != PackedName::MayBeEmpty) fail("an empty name");
        if (kind == PackedName::Atom && std::exchange(known.atom_of, residue_) == residue_) {
            fail("a repeated atom");
        }
        if (kind == PackedName::Term && std::exchange(known.term_of, residue_) != residue_) {
            in_terms_.push_back(at);
        }
        name = known.text;
    }

    void number(double& value, PackedNumber kind = PackedNumber::Any) {
        const std::size_t decimals = byte();
        if (decimals < packed_powers.size()) {
            const std::uint64_t read = whole();
            const auto digits = static_cast<double>((read + 1) / 2);
            value = (read % 2 == 0 ? digits : -digits) / packed_powers[decimals];
        } else {
            std::uint64_t bits = 0;
            for (int i = 0; i < 8; ++i) bits |= std::uint64_t{byte()} << (8 * i);
            value = std::bit_cast<double>(bits);
        }
        if (!std::isfinite(value) || (kind == PackedNumber::NotNegative && value < 0)) {
            fail("a number out of range");
        }
    }

    template <class List, class Each>
    void list(List& values, const Each& each) {
        const std::size_t size = size_of_list();
        values.reserve(std::min(size, most_reserved));
        for (std::size_t i = 0; i < size; ++i) each(values.emplace_back());
    }
    template <class Map, class Key, class Value>
    void map(Map& values, const Key& key, const Value& value) {
        const std::size_t size = size_of_list();
        for (std::size_t i = 0; i < size; ++i) {
            typename Map::key_type one_key;
            key(one_key);
            if (!values.empty() && !(std::prev(values.end())->first < one_key))
                fail("a repeated key");
            check_key(one_key);
            value(values.try_emplace(values.end(), std::move(one_key))->second);
        }
    }

    template <class Value>
    void finish(Value& value) const {
        value.place = place_;
    }
    void finish(CmapParameter& map) const {
        map.place = place_;
        const auto side = static_cast<std::size_t>(
            std::lround(std::sqrt(static_cast<double>(map.energies.size()))));
        if (side < 2 || side > 360 || side * side != map.energies.size())
            fail("a CMAP that is not square");
    }
    void finish(Residue& residue) {
        residue.place = place_;
        for (ResidueAtom& atom : residue.atoms) atom.place = place_;
        std::ranges::sort(in_terms_, {},
                          [&](std::size_t at) { return std::string_view(names_[at].text); });
        for (const std::size_t at : in_terms_) {
            residue.named_on.emplace_hint(residue.named_on.end(), names_[at].text, 0);
        }
        in_terms_.clear();
        ++residue_;
    }

private:
    unsigned char byte() {
        if (at_ == bytes_.size()) fail("an unexpected end");
        return static_cast<unsigned char>(bytes_[at_++]);
    }

    // Each element has a byte at least.
    std::size_t size_of_list() {
        const std::uint64_t size = whole();
        if (size > bytes_.size() - at_) fail("a list too long");
        return static_cast<std::size_t>(size);
    }

    // Empty only where a type has no element.
    std::string read_name() {
        const std::uint64_t size = whole();
        if (size > longest_name || size > bytes_.size() - at_) fail("a name too long");
        std::string name(bytes_.substr(at_, size));
        at_ += size;
        constexpr std::string_view not_in_names = " \t\r\n!abcdefghijklmnopqrstuvwxyz";
        if (name.find_first_of(not_in_names) != std::string::npos)
            fail("a name with forbidden characters");
        return name;
    }

    // Of two ways to read types the lower stands for both, but for CMAP.
    void check_key(const std::string&) const noexcept {}
    void check_key(const std::array<std::string, 8>&) const noexcept {}
    void check_key(const std::pair<std::string, std::string>& types) const {
        if (types.second < types.first) fail("types in another order");
    }
    void check_key(const std::array<std::string, 3>& types) const {
        if (types[2] < types[0]) fail("types in another order");
    }
    void check_key(const std::array<std::string, 4>& types) const {
        if (std::tie(types[3], types[2]) < std::tie(types[0], types[1])) {
            fail("types in another order");
        }
    }

    struct KnownName {
        std::string text;
        std::size_t atom_of = 0, term_of = 0;  // the last residue that has it so, from 1
    };

    std::string_view bytes_;
    std::size_t at_ = 0;
    const std::string& file_;
    TextPlace place_;
    std::vector<KnownName> names_;
    std::size_t residue_ = 1;            // that is read now
    std::vector<std::size_t> in_terms_;  // places in names_ of what its terms name
};

// What the text reader would have refused, as far as other code relies on it.
void check_dihedrals(const PackReader& reader,
                     const std::map<std::array<std::string, 4>, std::vector<DihedralTerm>>& all) {
    for (const auto& [types, terms] : all) {
        if (terms.empty()) reader.fail("a dihedral without terms");
        std::array<bool, most_multiplicity + 1> is_there{};
        for (const DihedralTerm& term : terms) {
            if (term.multiplicity > most_multiplicity ||
                (term.multiplicity == 0 && terms.size() > 1) ||
                std::exchange(is_there.at(static_cast<std::size_t>(term.multiplicity)), true)) {
                reader.fail("a multiplicity out of range");
            }
        }
    }
}

// The first line from `at` on, which moves behind its end; nothing if it does not end.
std::optional<std::string_view> take_line(std::string_view bytes, std::size_t& at) {
    const std::size_t end = bytes.substr(0, most_about_bytes).find('\n', at);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = bytes.substr(at, end - at);
    at = end + 1;
    return line;
}

struct PackedHead {
    std::vector<std::string> about;
    std::size_t packed_bytes = 0, plain_bytes = 0, begin = 0;
};

PackedHead read_head(std::string_view bytes, const std::string& file) {
    const auto cut = [&] {
        return LoadError({file}, "the packed force field is cut off; load it again");
    };
    if (!is_packed_force_field(bytes)) {
        throw LoadError(
            {file},
            fmt::format(
                "is not a packed force field of this version; expected it to begin with '{}'",
                packed_mark));
    }
    PackedHead head;
    std::size_t at = packed_mark.size() + 1;
    for (;;) {
        const auto line = take_line(bytes, at);
        if (!line) throw cut();
        if (line->empty()) break;
        head.about.push_back(printable(*line));
    }
    const auto sizes = take_line(bytes, at);
    if (!sizes) throw cut();
    const std::vector<std::string_view> words = split_words(*sizes);
    const auto packed = words.size() == 2 ? find_integer(words[0]) : std::nullopt;
    const auto plain = words.size() == 2 ? find_integer(words[1]) : std::nullopt;
    if (!packed || !plain || *packed < 0 || *plain < 0 || head.about.empty() ||
        *plain > std::int64_t{most_plain_bytes}) {
        throw LoadError(
            {file}, fmt::format("'{}' is not the size of a packed force field; load the file again",
                                printable(*sizes)));
    }
    head.packed_bytes = static_cast<std::size_t>(*packed);
    head.plain_bytes = static_cast<std::size_t>(*plain);
    head.begin = at;
    if (bytes.size() - at < head.packed_bytes) throw cut();
    return head;
}

// zlib makes at most 1032 bytes of one.
std::string expand(std::string_view bytes, const PackedHead& head, const std::string& file) {
    const auto damaged = [&] { return LoadError({file}, "the packed force field is damaged"); };
    if (head.plain_bytes / 1100 > head.packed_bytes ||
        bytes.size() != head.begin + head.packed_bytes)
        throw damaged();
    std::string plain(head.plain_bytes, '\0');
    auto size = static_cast<uLongf>(plain.size());
    const int code = uncompress(reinterpret_cast<Bytef*>(plain.data()), &size,
                                reinterpret_cast<const Bytef*>(bytes.data() + head.begin),
                                static_cast<uLong>(head.packed_bytes));
    if (code != Z_OK || size != plain.size()) throw damaged();
    return plain;
}

}  // namespace

bool is_packed_force_field(std::string_view bytes) noexcept {
    return bytes.size() > packed_mark.size() && bytes.starts_with(packed_mark) &&
           bytes[packed_mark.size()] == '\n';
}

std::vector<std::string> read_packed_about(std::string_view bytes, const std::string& file) {
    return read_head(bytes, file).about;
}

ForceField unpack_fields(std::string_view plain, const std::string& file) {
    ForceField force_field;
    PackReader reader(plain, file);
    visit_force_field(reader, force_field);
    reader.finish_all();
    check_dihedrals(reader, force_field.dihedrals);
    check_dihedrals(reader, force_field.impropers);
    return force_field;
}

ForceField unpack_force_field(std::string_view bytes, const std::string& file) {
    const PackedHead head = read_head(bytes, file);
    ForceField force_field = unpack_fields(expand(bytes, head, file), file);
    force_field.about = head.about;
    force_field.files = {head.about.front()};
    return force_field;
}

}  // namespace palpa
