#include "formats/gro.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/units.h"
#include "formats/box.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace palpa {
namespace {

[[noreturn]] void fail_gro(const Structure& structure, std::size_t atom, const std::string& what) {
    const std::size_t line = structure.lines.empty() ? 0 : structure.lines[atom];
    throw LoadError({structure.file, line},
                    fmt::format("{}: {}", to_string(structure.names[atom]), what));
}

// Five digits, which begin again behind 99999.
std::int64_t wrapped_number(std::int64_t number) { return number % 100'000; }

std::int64_t gro_residue_number(const Structure& structure, std::size_t atom) {
    std::string_view text = structure.names[atom].number;
    const bool has_code = !text.empty() && (text.back() < '0' || text.back() > '9');
    if (has_code) text.remove_suffix(1);
    const std::optional<std::int64_t> number = find_integer(text);
    if (!number || *number < -9999) {
        fail_gro(
            structure, atom,
            fmt::format(
                "'{}' is not a residue number of a GRO file; expected a whole number from -9999",
                structure.names[atom].number));
    }
    return wrapped_number(*number);
}

std::string gro_name(const Structure& structure, std::size_t atom, const std::string& name,
                     const char* what) {
    if (is_name(name) && name.size() <= 5) return name;
    fail_gro(structure, atom,
             fmt::format("the {} '{}' does not fit the 5 columns of a GRO file", what, name));
}

std::string gro_coordinate(const Structure& structure, std::size_t atom, double value,
                           int decimals) {
    const int columns = decimals + 5;
    const std::string text =
        fmt::format("{:{}.{}f}", value / units::angstrom_per_nm, columns, decimals);
    if (std::isfinite(value) && text.size() == static_cast<std::size_t>(columns)) return text;
    fail_gro(structure, atom,
             fmt::format("the coordinate {} Å does not fit the {} columns of a GRO file", value,
                         columns));
}

std::string gro_box(const Structure& structure, const std::optional<Mat3>& box) {
    if (!box) return "   0.00000   0.00000   0.00000\n";
    if (!is_lower_box(*box)) {
        throw LoadError({structure.file},
                        "a box that a GRO file cannot tell; expected its edge a along x and b in "
                        "the plane of x and y");
    }
    const Mat3 nm = *box / units::angstrom_per_nm;
    // Edges a, b, c as v1, v2, v3: v1x v2y v3z v1y v1z v2x v2z v3x v3y.
    const std::array<double, 9> numbers{nm(0, 0), nm(1, 1), nm(2, 2), 0,       0,
                                        nm(0, 1), 0,        nm(0, 2), nm(1, 2)};
    const bool rectangular =
        std::all_of(numbers.begin() + 3, numbers.end(), [](double v) { return v == 0; });
    std::string text;
    for (std::size_t i = 0; i < (rectangular ? 3U : 9U); ++i) {
        text += fmt::format("{:10.5f}", numbers[i]);
    }
    return text + "\n";
}

constexpr std::array<std::string_view, 14> water_names{"SOL", "HOH", "WAT",  "TIP3", "TIP4",
                                                       "TP3", "TIP", "TIP5", "SPC",  "SPCE",
                                                       "H2O", "T3P", "T4P",  "OPC"};

// As read_gro says.
void name_segments(Structure& structure) {
    std::vector<AtomName>& names = structure.names;
    std::map<std::string, int> counts;  // of segments of a kind so far
    std::string kind, segment;
    std::int64_t last = 0;
    for (std::size_t first = 0, next = 0; first < names.size(); first = next) {
        while (next < names.size() && names[next].number == names[first].number &&
               names[next].residue == names[first].residue)
            ++next;
        const bool is_water = is_water_residue(names[first].residue);
        const std::string now = is_water ? "WAT" : next - first == 1 ? "ION" : "M";
        const std::int64_t number = find_integer(names[first].number).value_or(0);
        if (now != kind || (now == "M" && number < last)) {
            kind = now;
            const int count = ++counts[kind];
            segment = kind == "M" || count > 1 ? fmt::format("{}{}", kind, count) : kind;
        }
        last = number;
        for (std::size_t i = first; i < next; ++i) names[i].segment = segment;
    }
}

class GroReader {
public:
    GroReader(std::string_view text, const std::string& file)
        : lines_(text), size_(text.size()), structure_{file, {}, {}, {}} {}

    Structure read() {
        if (lines_.at_end()) fail("is empty; expected a title, a number of atoms, and atoms");
        lines_.advance();
        read_count();
        constexpr std::size_t shortest = 44;
        structure_.names.reserve(std::min(count_, size_ / shortest));
        for (; structure_.names.size() < count_; lines_.advance()) {
            if (lines_.at_end()) {
                fail(fmt::format("ends after {} of {} atoms", structure_.names.size(), count_));
            }
            read_atom();
        }
        if (lines_.at_end() || trimmed(lines_.line()).empty())
            fail("has no line of the box behind its atoms; expected three numbers, nm");
        for (lines_.advance(); !lines_.at_end(); lines_.advance()) {
            if (!trimmed(lines_.line()).empty())
                fail("goes on behind the box; expected one frame (a trajectory is .xtc or .trr)");
        }
        name_segments(structure_);
        return std::move(structure_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw LoadError({structure_.file, lines_.number()}, what);
    }

    void read_count() {
        const auto count = find_integer(lines_.line());
        constexpr std::int64_t most = 100'000'000;
        if (!count || *count < 1 || *count > most) {
            fail(fmt::format("'{}' is not a number of atoms; expected a count from 1",
                             shortened(trimmed(lines_.line()))));
        }
        count_ = static_cast<std::size_t>(*count);
        lines_.advance();
    }

    std::string word(Columns columns, const char* what) const {
        const std::string_view text = find_field(lines_.line(), columns);
        if (!is_name(text)) fail(fmt::format("no {} in column {}", what, columns.first + 1));
        return std::string(text);
    }

    // Columns of a coordinate: from one decimal point to the next.
    std::size_t find_width() const {
        constexpr std::size_t first = 20;
        const std::string_view line = lines_.line();
        const std::size_t one = line.find('.', first);
        const std::size_t two = one == line.npos ? one : line.find('.', one + 1);
        if (two == line.npos || two - one > 30) fail("has no three coordinates, nm");
        return two - one;
    }

    void read_atom() {
        if (width_ == 0) width_ = find_width();
        AtomName name{"", word({5, 5}, "residue name"), word({0, 5}, "residue number"),
                      word({10, 5}, "atom name")};
        if (!find_integer(name.number))
            fail(fmt::format("'{}' is not a residue number", name.number));
        Vec3 place;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string_view text = find_field(lines_.line(), {20 + i * width_, width_});
            const std::optional<double> nm = find_coordinate(text);
            if (!nm || std::abs(*nm) * units::angstrom_per_nm > farthest_coordinate) {
                fail(fmt::format("'{}' is not a coordinate; expected nm within ±{}",
                                 shortened(text), farthest_coordinate / units::angstrom_per_nm));
            }
            place[static_cast<Eigen::Index>(i)] = *nm * units::angstrom_per_nm;
        }
        structure_.names.push_back(std::move(name));
        structure_.positions.push_back(place);
        structure_.lines.push_back(lines_.number());
    }

    LineReader lines_;
    std::size_t size_, count_ = 0, width_ = 0;
    Structure structure_;
};

}  // namespace

bool is_water_residue(std::string_view residue) noexcept {
    return std::ranges::find(water_names, residue) != water_names.end();
}

Structure parse_gro(std::string_view text, const std::string& file) {
    return GroReader(text, file).read();
}

Structure read_gro(const std::filesystem::path& path) {
    return parse_gro(read_text_file(path), path.string());
}

std::string format_gro(const Structure& structure, std::string_view title,
                       const std::optional<Mat3>& box, int decimals) {
    const bool models = std::any_of(
        structure.records.begin(), structure.records.end(),
        [&](const AtomRecord& record) { return record.model != structure.records[0].model; });
    if (models) {
        throw LoadError({structure.file},
                        "several models, of which a GRO file holds one; expected "
                        "a choice of one");
    }
    const std::string_view first_line = title.substr(0, title.find('\n'));
    std::string text = fmt::format("{}\n{:5}\n", first_line, structure.names.size());
    for (std::size_t atom = 0; atom < structure.names.size(); ++atom) {
        const AtomName& name = structure.names[atom];
        text += fmt::format("{:5}{:<5}{:>5}{:5}", gro_residue_number(structure, atom),
                            gro_name(structure, atom, name.residue, "residue name"),
                            gro_name(structure, atom, name.atom, "atom name"),
                            wrapped_number(static_cast<std::int64_t>(atom) + 1));
        for (const double value : structure.positions[atom]) {
            text += gro_coordinate(structure, atom, value, decimals);
        }
        text += '\n';
    }
    return text + gro_box(structure, box);
}

}  // namespace palpa
