#include "formats/crd.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace palpa {
namespace {

// Where the fields of one atom stand, and how long its line is at least.
struct Layout {
    Columns residue, atom, x, y, z, segment, number, weight;
    std::size_t shortest = number.first + 1;
};

// (I5,I5,1X,A4,1X,A4,3F10.5,1X,A4,1X,A4,F10.5) and (2I10,2X,A8,2X,A8,3F20.10,2X,A8,2X,A8,F20.10)
constexpr Layout normal_layout{{11, 4},  {16, 4}, {20, 10}, {30, 10},
                               {40, 10}, {51, 4}, {56, 4},  {60, 10}};
constexpr Layout extended_layout{{22, 8},  {32, 8},  {40, 20}, {60, 20},
                                 {80, 20}, {102, 8}, {112, 8}, {120, 20}};

class Reader {
public:
    Reader(std::string_view text, std::string file)
        : lines_(text), size_(text.size()), structure_{std::move(file), {}, {}, {}} {}

    Structure read() {
        while (lines_.line().starts_with('*')) lines_.advance();
        read_atom_count();
        // A count that the file has no room for gets no memory.
        const std::size_t room = std::min(count_, size_ / layout_.shortest);
        structure_.names.reserve(room);
        structure_.positions.reserve(room);
        structure_.lines.reserve(room);
        for (; structure_.names.size() < count_; lines_.advance()) {
            if (lines_.at_end()) fail(0, "ends" + describe_progress());
            read_atom(lines_.line());
        }
        for (; !lines_.at_end(); lines_.advance()) {
            if (!trimmed(lines_.line()).empty()) {
                fail(0, fmt::format("more lines than the {} atoms announced on line {}", count_,
                                    count_line_));
            }
        }
        if (std::ranges::all_of(structure_.weights, [](double weight) { return weight == 0; }))
            structure_.weights.clear();
        return std::move(structure_);
    }

private:
    [[noreturn]] void fail(std::size_t column, const std::string& what) const {
        throw LoadError({structure_.file, lines_.number(), column}, what);
    }

    std::string describe_progress() const {
        return fmt::format(" after {} of the {} atoms announced on line {}",
                           structure_.names.size(), count_, count_line_);
    }

    // A file that was cut short ends within a line.
    std::string cut_hint() const {
        if (!lines_.at_last_line() || structure_.names.size() + 1 == count_) return {};
        return "; the file ends here" + describe_progress();
    }

    void read_atom_count() {
        if (lines_.at_end()) fail(0, "ends before the number of atoms");
        const std::vector<std::string_view> words = split_words(lines_.line());
        const auto count = words.empty() ? std::nullopt : find_integer(words[0]);
        const bool extended = words.size() == 2 && upper_case(words[1]) == "EXT";
        if (!count || *count < 1 || (words.size() > 1 && !extended)) {
            fail(0, fmt::format("'{}' is not a number of atoms; expected a count from 1, with EXT "
                                "behind it for the extended format",
                                shortened(trimmed(lines_.line()))));
        }
        layout_ = extended ? extended_layout : normal_layout;
        count_ = static_cast<std::size_t>(*count);
        count_line_ = lines_.number();
        lines_.advance();
    }

    std::string word(std::string_view line, Columns columns, const char* what) const {
        const std::string_view text = find_field(line, columns);
        if (text.empty()) {
            fail(columns.first + 1, fmt::format("the {} is missing{}", what, cut_hint()));
        }
        return std::string(text);
    }

    double coordinate(std::string_view line, Columns columns) const {
        const std::string text = word(line, columns, "coordinate");
        const std::optional<double> value = find_coordinate(text);
        if (!value) {
            fail(columns.first + 1,
                 fmt::format("'{}' is not a coordinate; expected a number within ±{} Å in columns "
                             "{} to {}{}",
                             text, farthest_coordinate, columns.first + 1,
                             columns.first + columns.count, cut_hint()));
        }
        return *value;
    }

    void read_atom(std::string_view line) {
        AtomName name{word(line, layout_.segment, "segment name"),
                      word(line, layout_.residue, "residue name"),
                      word(line, layout_.number, "residue number"),
                      word(line, layout_.atom, "atom name")};
        const auto [first, is_new] = seen_.emplace(
            std::tuple(name.segment, name.residue, name.number, name.atom), lines_.number());
        if (!is_new) {
            fail(0, fmt::format("atom {} is repeated, first on line {}", to_string(name),
                                first->second));
        }
        // One by one: a call may evaluate its arguments in any order, and the first error counts.
        const double x = coordinate(line, layout_.x);
        const double y = coordinate(line, layout_.y);
        const double z = coordinate(line, layout_.z);
        structure_.positions.emplace_back(x, y, z);
        structure_.weights.push_back(find_real(find_field(line, layout_.weight)).value_or(0));
        structure_.names.push_back(std::move(name));
        structure_.lines.push_back(lines_.number());
    }

    LineReader lines_;                        // at the line to be read next
    std::size_t size_;                        // of the text
    std::size_t count_ = 0, count_line_ = 0;  // of atoms, and the line that announces them
    Layout layout_ = normal_layout;
    Structure structure_;
    std::map<std::tuple<std::string, std::string, std::string, std::string>, std::size_t> seen_;
};

}  // namespace

Structure parse_crd(std::string_view text, const std::string& file) {
    return Reader(text, file).read();
}

Structure read_crd(const std::filesystem::path& path) {
    return parse_crd(read_text_file(path), path.string());
}

std::string format_crd(const Structure& structure, std::string_view title) {
    std::string text;
    for (const std::string_view line : split_lines(title)) text += fmt::format("* {}\n", line);
    text += fmt::format("*\n{:10}  EXT\n", structure.names.size());
    std::size_t residue = 0;
    for (std::size_t atom = 0; atom < structure.names.size(); ++atom) {
        const AtomName& name = structure.names[atom];
        const bool same = atom > 0 && structure.names[atom - 1].segment == name.segment &&
                          structure.names[atom - 1].number == name.number;
        if (!same) ++residue;
        const Vec3& p = structure.positions[atom];
        fmt::format_to(
            std::back_inserter(text),
            "{:10}{:10}  {:<8}  {:<8}{:20.10f}{:20.10f}{:20.10f}  {:<8}  {:<8}{:20.10f}\n",
            atom + 1, residue, name.residue, name.atom, p.x(), p.y(), p.z(), name.segment,
            name.number, b_factor_of(structure, atom));
    }
    return text;
}

}  // namespace palpa
