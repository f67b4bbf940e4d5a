#include "formats/psf.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/gzip.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// What every file has, in the order in which a missing one is reported.
constexpr std::array required_sections = std::to_array<std::string_view>(
    {"NATOM", "NBOND", "NTHETA", "NPHI", "NIMPHI", "NDON", "NACC", "NNB", "NGRP"});
constexpr std::array known_flags =
    std::to_array<std::string_view>({"EXT", "CMAP", "CHEQ", "XPLOR", "NAMD"});

// Of an atom's line: nine fields of one letter, and what is between them.
constexpr std::size_t shortest_atom = 18;

class PsfReader {
public:
    PsfReader(std::string_view text, const std::string& file) : lines_(text), text_(text) {
        connectivity_.file = file;
    }

    Connectivity read() {
        read_flags();
        while (skip_blank_lines()) read_section();
        for (const std::string_view section : required_sections) require(section);
        if (has_cmap_) require("NCRTERM");
        return std::move(connectivity_);
    }

private:
    [[noreturn]] void fail(std::size_t line, const std::string& what) const {
        throw LoadError({connectivity_.file, line, 0}, what);
    }

    void require(std::string_view section) const {
        if (!sections_.contains(section)) {
            fail(lines_.number(), fmt::format("ends without a section !{}", section));
        }
    }

    // False at the end of the file.
    bool skip_blank_lines() {
        while (!lines_.at_end() && trimmed(lines_.line()).empty()) lines_.advance();
        return !lines_.at_end();
    }

    void read_flags() {
        const std::vector<std::string_view> words = split_words(lines_.line());
        if (words.empty() || words[0] != "PSF")
            fail(1, "is not a PSF file; expected PSF on line 1");
        for (const std::string_view flag : std::span(words).subspan(1)) {
            if (std::find(known_flags.begin(), known_flags.end(), flag) == known_flags.end()) {
                fail(1, fmt::format("the PSF format '{}' is not supported; expected {}",
                                    shortened(flag), fmt::join(known_flags, ", ")));
            }
            has_cmap_ = has_cmap_ || flag == "CMAP";
        }
        lines_.advance();
    }

    // "count ... !NAME: text", then what it holds.
    void read_section() {
        header_line_ = lines_.number();
        const std::string_view line = lines_.line();
        const std::size_t mark = line.find('!');
        if (mark == std::string_view::npos) {
            fail(header_line_,
                 fmt::format("'{}' is not the header of a section; expected a count and !NAME",
                             shortened(trimmed(line))));
        }
        std::vector<std::size_t> counts;
        for (const std::string_view word : split_words(line.substr(0, mark))) {
            counts.push_back(whole_number(word, header_line_, "count"));
        }
        const std::vector<std::string_view> name = split_words(line.substr(mark + 1));
        if (counts.empty() || name.empty())
            fail(header_line_, "a section has no count or no name; expected a count and !NAME");
        const std::string section(name[0].substr(0, name[0].find(':')));
        const auto [first, is_new] = sections_.emplace(section, header_line_);
        if (!is_new) {
            fail(header_line_, fmt::format("section !{} is repeated, first on line {}",
                                           shortened(section), first->second));
        }
        if (section != "NTITLE" && section != "NATOM" && !sections_.contains("NATOM")) {
            fail(header_line_,
                 fmt::format("section !{} stands before the atoms; expected !NATOM first",
                             shortened(section)));
        }
        lines_.advance();
        read_content(section, counts);
    }

    void read_content(const std::string& section, const std::vector<std::size_t>& counts) {
        const std::size_t count = counts[0];
        if (section == "NTITLE") {
            for (std::size_t i = 0; i < count; ++i, lines_.advance()) {
                if (lines_.at_end()) {
                    fail(lines_.number(), fmt::format("ends within {} titles", count));
                }
            }
        } else if (section == "NATOM") {
            read_atoms(count);
        } else if (section == "NBOND") {
            read_tuples(count, connectivity_.bonds);
            check_bonds();
        } else if (section == "NTHETA") {
            read_tuples(count, connectivity_.angles);
        } else if (section == "NPHI") {
            read_tuples(count, connectivity_.dihedrals);
        } else if (section == "NIMPHI") {
            read_tuples(count, connectivity_.impropers);
        } else if (section == "NCRTERM") {
            read_tuples(count, connectivity_.cmaps);
        } else if (section == "NDON" || section == "NACC") {
            read_numbers(2 * whole_count(count));  // 0: no hydrogen, no antecedent
        } else if (section == "NNB") {
            read_exclusions(count);
        } else if (section == "NGRP") {
            read_numbers(3 * whole_count(count));
        } else if (section == "MOLNT") {
            read_numbers(connectivity_.names.size());
        } else if (std::any_of(counts.begin(), counts.end(), [](std::size_t n) { return n > 0; })) {
            fail(header_line_, fmt::format("section !{} is not supported; expected it to be empty",
                                           shortened(section)));
        }
    }

    // A count that the file has no room for is wrong, however large it is.
    std::size_t whole_count(std::size_t count) const {
        if (count > text_.size()) {
            fail(header_line_,
                 fmt::format("{} entries announced, more than the file holds", count));
        }
        return count;
    }

    std::size_t whole_number(std::string_view word, std::size_t line, const char* what) const {
        const std::optional<std::int64_t> value = find_integer(word);
        if (!value || *value < 0) {
            fail(line, fmt::format("'{}' is not a {}; expected a whole number from 0",
                                   shortened(word), what));
        }
        return static_cast<std::size_t>(*value);
    }

    // `word` is one of this line's.
    [[noreturn]] void fail_word(std::string_view word, const std::string& what) const {
        const auto column = static_cast<std::size_t>(word.data() - lines_.line().data()) + 1;
        throw LoadError({connectivity_.file, lines_.number(), column}, what);
    }

    // `what`: "mass; expected a number, in amu"
    double real(std::string_view word, const char* what) const {
        const std::optional<double> value = find_real(word);
        if (!value) fail_word(word, fmt::format("'{}' is not a {}", shortened(word), what));
        return *value;
    }

    void read_atoms(std::size_t count) {
        if (count == 0) fail(header_line_, "the file has no atoms; expected a count from 1");
        reserve_atoms(std::min({count, text_.size() / shortest_atom, count_lines(text_, "")}));
        for (std::size_t atom = 0; atom < count; ++atom, lines_.advance()) {
            if (trimmed(lines_.line()).empty()) {
                fail(lines_.number(), fmt::format("ends after {} of {} atoms", atom, count));
            }
            read_atom(atom, split_words(lines_.line()));
        }
    }

    void reserve_atoms(std::size_t count) {
        connectivity_.names.reserve(count);
        connectivity_.type.reserve(count);
        connectivity_.charge.reserve(count);
        connectivity_.mass.reserve(count);
        connectivity_.lines.reserve(count);
    }

    // number segment residue-number residue atom type charge mass imove [two numbers of CHEQ]
    void read_atom(std::size_t atom, std::span<const std::string_view> words) {
        if (words.size() != 9 && words.size() != 11) {
            fail(lines_.number(),
                 fmt::format("{} fields; expected the 9 of an atom (number, segment, residue "
                             "number, residue, atom, type, charge, mass, 0) or 11 with CHEQ",
                             words.size()));
        }
        if (whole_number(words[0], lines_.number(), "number of an atom") != atom + 1) {
            fail(lines_.number(),
                 fmt::format("atom number {}; expected {}", shortened(words[0]), atom + 1));
        }
        AtomName name{std::string(words[1]), std::string(words[3]), std::string(words[2]),
                      std::string(words[4])};
        const auto [first, is_new] = seen_.emplace(
            std::tuple(name.segment, name.residue, name.number, name.atom), lines_.number());
        if (!is_new) {
            fail(lines_.number(), fmt::format("atom {} is repeated, first on line {}",
                                              to_string(name), first->second));
        }
        const double charge = real(words[6], "charge; expected a number, in e");
        const double mass = real(words[7], "mass; expected a number, in amu");
        if (mass < 0)
            fail_word(words[7], fmt::format("a mass of {} amu; expected 0 or more", mass));
        for (const std::string_view word : words.subspan(8)) {
            real(word, "number; expected 0, or what CHEQ writes");
        }
        connectivity_.names.push_back(std::move(name));
        connectivity_.type.push_back(upper_case(words[5]));
        connectivity_.charge.push_back(charge);
        connectivity_.mass.push_back(mass);
        connectivity_.lines.push_back(lines_.number());
    }

    // Calls use(number, line) for `count` numbers, however many stand on a line.
    template <class Use>
    void each_number(std::size_t count, const Use& use) {
        for (std::size_t read = 0; read < count; lines_.advance()) {
            const bool ends = lines_.at_end() || lines_.line().find('!') != std::string::npos;
            if (ends || (trimmed(lines_.line()).empty() && read > 0)) {
                fail(lines_.number(), fmt::format("ends after {} of {} numbers", read, count));
            }
            const std::vector<std::string_view> words = split_words(lines_.line());
            if (words.size() > count - read) {
                fail(lines_.number(), fmt::format("more than the {} numbers announced", count));
            }
            for (const std::string_view word : words) use(word, lines_.number());
            read += words.size();
        }
    }

    void read_numbers(std::size_t count) {
        each_number(count, [this](std::string_view word, std::size_t line) {
            if (!find_integer(word))
                fail(line, fmt::format("'{}' is not a whole number", shortened(word)));
        });
    }

    template <std::size_t Size>
    void read_tuples(std::size_t count, std::vector<std::array<std::uint32_t, Size>>& into) {
        std::array<std::uint32_t, Size> tuple{};
        std::size_t filled = 0;
        each_number(Size * whole_count(count), [&](std::string_view word, std::size_t line) {
            const std::size_t index = whole_number(word, line, "number of an atom");
            if (index < 1 || index > connectivity_.names.size()) {
                fail(line, fmt::format("atom number {}; expected 1 to {}", index,
                                       connectivity_.names.size()));
            }
            tuple[filled++] = static_cast<std::uint32_t>(index - 1);
            if (filled < Size) return;
            // Of a cross-term's eight atoms, each dihedral has four of its own.
            for (std::size_t i = 0; i < Size; ++i) {
                for (std::size_t j = i + 1; j < std::min(Size, i / 4 * 4 + 4); ++j) {
                    if (tuple[i] == tuple[j]) {
                        fail(line, fmt::format("atom number {} twice in one entry", index));
                    }
                }
            }
            into.push_back(tuple);
            filled = 0;
        });
    }

    void check_bonds() const {
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        for (const auto& [a, b] : connectivity_.bonds) {
            if (seen.insert(std::minmax(a, b)).second) continue;
            fail(header_line_,
                 fmt::format("the bond between {} and {} is listed twice",
                             to_string(connectivity_.names[a]), to_string(connectivity_.names[b])));
        }
    }

    // The excluded atoms, then for each atom where its own end; some files leave the latter out
    // where there are none.
    void read_exclusions(std::size_t count) {
        read_numbers(whole_count(count));
        if (skip_blank_lines() && lines_.line().find('!') == std::string::npos) {
            read_numbers(connectivity_.names.size());
        }
    }

    LineReader lines_;  // at the line to be read next
    std::string_view text_;
    std::size_t header_line_ = 0;
    bool has_cmap_ = false;
    std::map<std::string, std::size_t, std::less<>> sections_;
    std::map<std::tuple<std::string, std::string, std::string, std::string>, std::size_t> seen_;
    Connectivity connectivity_;
};

// Entries side by side, up to `width` on a line.
template <std::size_t Size>
void append_tuples(const std::vector<std::array<std::uint32_t, Size>>& tuples, std::size_t width,
                   std::string_view name, std::string& text) {
    text += fmt::format("\n{:10} !{}\n", tuples.size(), name);
    for (std::size_t i = 0; i < tuples.size(); ++i) {
        for (const std::uint32_t atom : tuples[i]) text += fmt::format("{:10}", atom + 1);
        if ((i + 1) % width == 0 || i + 1 == tuples.size()) text += "\n";
    }
}

}  // namespace

Connectivity parse_psf(std::string_view text, const std::string& file) {
    return PsfReader(text, file).read();
}

Connectivity read_psf(const std::filesystem::path& path) {
    return parse_psf(read_packed_text_file(path), path.string());
}

std::string format_psf(const Connectivity& connectivity, std::string_view title) {
    const std::vector<std::string_view> titles = split_lines(title);
    std::string text = fmt::format("PSF EXT {}XPLOR\n\n{:10} !NTITLE\n",
                                   connectivity.cmaps.empty() ? "" : "CMAP ", titles.size());
    for (const std::string_view line : titles) text += fmt::format(" REMARKS {}\n", line);
    text += fmt::format("\n{:10} !NATOM\n", connectivity.names.size());
    for (std::size_t i = 0; i < connectivity.names.size(); ++i) {
        const AtomName& name = connectivity.names[i];
        fmt::format_to(std::back_inserter(text),
                       "{:10} {:<8} {:<8} {:<8} {:<8} {:<6} {:14.6f} {:13.4f} {:7}\n", i + 1,
                       name.segment, name.number, name.residue, name.atom, connectivity.type[i],
                       connectivity.charge[i], connectivity.mass[i], 0);
    }
    append_tuples(connectivity.bonds, 4, "NBOND: bonds", text);
    append_tuples(connectivity.angles, 3, "NTHETA: angles", text);
    append_tuples(connectivity.dihedrals, 2, "NPHI: dihedrals", text);
    append_tuples(connectivity.impropers, 2, "NIMPHI: impropers", text);
    for (const char* const empty : {"NDON: donors", "NACC: acceptors", "NNB"}) {
        text += fmt::format("\n{:10} !{}\n", 0, empty);
    }
    for (std::size_t i = 0; i < connectivity.names.size(); ++i) {
        text += fmt::format("{:10}", 0);
        if ((i + 1) % 8 == 0 || i + 1 == connectivity.names.size()) text += "\n";
    }
    text += fmt::format("\n{:10}{:10} !NGRP NST2\n{:10}{:10}{:10}\n", 1, 0, 0, 0, 0);
    if (!connectivity.cmaps.empty())
        append_tuples(connectivity.cmaps, 1, "NCRTERM: cross-terms", text);
    return text;
}

}  // namespace palpa
