#include "formats/gro.h"

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
#include <optional>

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
        fail_gro(structure, atom,
                 fmt::format("'{}' is no residue number of a GRO file; expected a "
                             "whole number from -9999",
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

}  // namespace

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
