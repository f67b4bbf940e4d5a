#include "formats/pdb.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/gzip.h"
#include "formats/lines.h"
#include "formats/links.h"
#include "formats/remark_350.h"
#include "formats/structure_builder.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr Columns record_columns{0, 6}, serial_columns{6, 5}, atom_columns{12, 4},
    alternate_columns{16, 1}, residue_columns{17, 4}, chain_columns{21, 1}, number_columns{22, 4},
    insertion_columns{26, 1}, model_columns{10, 4}, occupancy_columns{54, 6},
    b_factor_columns{60, 6}, segment_columns{72, 4}, element_columns{76, 2}, charge_columns{78, 2};
constexpr std::array<Columns, 3> position_columns{{{30, 8}, {38, 8}, {46, 8}}};

// Records that hold no atoms, of all versions of the format, and what programs add to them.
constexpr std::array other_records = std::to_array<std::string_view>(
    {"ANISOU", "AUTHOR", "CAVEAT", "CISPEP", "COMPND", "CONECT", "CRYST1", "DBREF",  "DBREF1",
     "DBREF2", "EXPDTA", "FORMUL", "FTNOTE", "HEADER", "HELIX",  "HET",    "HETNAM", "HETSYN",
     "HYDBND", "JRNL",   "KEYWDS", "LINK",   "LINKR",  "MASTER", "MDLTYP", "MODRES", "MTRIX1",
     "MTRIX2", "MTRIX3", "NUMMDL", "OBSLTE", "ORIGX1", "ORIGX2", "ORIGX3", "REMARK", "REVDAT",
     "SCALE1", "SCALE2", "SCALE3", "SEQADV", "SEQRES", "SHEET",  "SIGATM", "SIGUIJ", "SITE",
     "SLTBRG", "SOURCE", "SPLIT",  "SPRSDE", "SSBOND", "TITLE",  "TURN",   "TVECT",  "USER"});
static_assert(std::is_sorted(other_records.begin(), other_records.end()));
constexpr std::array atom_records =
    std::to_array<std::string_view>({"ATOM", "HETATM", "TER", "MODEL", "ENDMDL", "END"});

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }
bool is_upper(char letter) { return letter >= 'A' && letter <= 'Z'; }
bool is_letter(char letter) { return is_upper(letter) || (letter >= 'a' && letter <= 'z'); }

std::int64_t power(std::int64_t base, std::size_t exponent) {
    std::int64_t value = 1;
    for (std::size_t i = 0; i < exponent; ++i) value *= base;
    return value;
}

std::optional<std::int64_t> find_in_base(std::string_view text, int base) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// A whole number of up to `width` columns. What has no room goes on in hybrid-36: "A000" follows
// 9999, "ZZZZ" is followed by "a000"; or in hexadecimal digits, of which the first is no letter.
std::optional<std::int64_t> find_wide_number(std::string_view text, std::size_t width) {
    if (const auto value = find_integer(text)) return value;
    if (text.size() != width) return std::nullopt;
    if (is_digit(text[0])) return find_in_base(text, 16);
    if (!is_letter(text[0])) return std::nullopt;
    const bool one_case = std::none_of(text.begin(), text.end(), [&](char c) {
        return is_letter(c) && is_upper(c) != is_upper(text[0]);
    });
    const auto value = one_case ? find_in_base(text, 36) : std::nullopt;
    if (!value) return std::nullopt;
    const std::int64_t block = power(36, width - 1);
    return *value + power(10, width) + (is_upper(text[0]) ? -10 : 16) * block;
}

// Nothing where hybrid-36 has no room either.
std::optional<std::string> format_wide_number(std::int64_t value, std::size_t width) {
    const std::int64_t first = power(10, width), block = power(36, width - 1);
    if (value <= -power(10, width - 1) || value >= first + 52 * block) return std::nullopt;
    if (value < first) return fmt::format("{:{}}", value, width);
    const bool upper = value < first + 26 * block;
    std::int64_t rest = value - first + (upper ? 10 : -16) * block;
    std::string text(width, ' ');
    for (std::size_t i = width; i-- > 0; rest /= 36) {
        const auto digit = static_cast<char>(rest % 36);
        text[i] = static_cast<char>(digit < 10 ? '0' + digit : (upper ? 'A' : 'a') + digit - 10);
    }
    return text;
}

// "2+" as the format says, and "+2" and "+" as others do.
std::optional<std::int32_t> find_formal_charge(std::string_view text) {
    if (text.empty()) return 0;
    if (text.size() > 2) return std::nullopt;
    const std::size_t sign = text.find_first_of("+-");
    const char digit = text.size() == 1 ? '1' : text[1 - std::min<std::size_t>(sign, 1)];
    if (text == "0") return 0;
    if (sign == std::string_view::npos || !is_digit(digit)) return std::nullopt;
    return (text[sign] == '-' ? -1 : 1) * (digit - '0');
}

class PdbReader {
public:
    PdbReader(std::string_view text, const std::string& file)
        : file_(file),
          lines_(text),
          builder_(file, count_lines(text, "ATOM") + count_lines(text, "HETATM")),
          remark_350_(file) {}

    Structure read() {
        for (; !lines_.at_end(); lines_.advance()) read_line(lines_.line());
        if (model_line_ != 0) {
            fail_line(
                fmt::format("ends within the model of line {}; expected ENDMDL", model_line_));
        }
        if (end_line_ == 0) builder_.add_doubt("no END record: the file may be cut off");
        if (!unknown_.empty()) {
            builder_.add_doubt(
                fmt::format("records left out as unknown: {}", fmt::join(unknown_, ", ")));
        }
        Structure structure = builder_.build(lines_.number());
        remark_350_.move_into(structure);
        return structure;
    }

private:
    [[noreturn]] void fail_line(const std::string& what) const {
        throw LoadError({file_, lines_.number(), 0}, what);
    }

    // "file:line:column: 'text' in columns 31 to 38 is `what`"
    [[noreturn]] void fail(Columns columns, const std::string& what) const {
        const std::size_t first = columns.first + 1, last = columns.first + columns.count;
        const std::string where = first == last ? fmt::format("column {}", first)
                                                : fmt::format("columns {} to {}", first, last);
        throw LoadError({file_, lines_.number(), first},
                        fmt::format("'{}' in {} is {}", field(columns), where, what));
    }

    std::string_view field(Columns columns) const { return find_field(lines_.line(), columns); }

    void read_line(std::string_view line) {
        const std::string_view record = field(record_columns);
        // The last of six digits of a serial may stand where the record's name ends.
        const bool wide = line.starts_with("ATOM ") && record.size() == 6 && is_digit(record[5]);
        if (line.starts_with("HETATM") || (record == "ATOM" && line[0] == 'A') || wide) {
            if (end_line_ != 0) {
                fail_line(fmt::format(
                    "an atom after the END of line {}; expected MODEL and ENDMDL around each model",
                    end_line_));
            }
            read_atom(line[0] == 'H', wide);
        } else if (line.starts_with("MODEL ")) {
            begin_model();
        } else if (line.starts_with("ENDMDL")) {
            if (model_line_ == 0) fail_line("ENDMDL without a MODEL before it");
            model_line_ = 0;
            residue_offset_ = 0;
        } else if (line.starts_with("TER") && record == "TER") {
            builder_.end_chain();
            residue_offset_ = 0;
        } else if (line.starts_with("END") && record == "END") {
            end_line_ = lines_.number();
        } else if (line.starts_with("REMARK 350")) {
            remark_350_.add_line(line, lines_.number());
        } else if (record == "HETNAM") {
            builder_.add_component_name(field({11, 3}), field({15, 55}));
        } else if (record == "LINK" || record == "SSBOND") {
            if (auto link = find_pdb_link(line, lines_.number())) {
                builder_.add_link(std::move(*link));
            }
        } else if (!trimmed(line).empty()) {
            check_other(record);
        }
    }

    void check_other(std::string_view record) {
        if (std::binary_search(other_records.begin(), other_records.end(), record)) return;
        const std::string hint = near_name_hint(record, atom_records);
        if (!hint.empty()) {
            fail_line(fmt::format("'{}' in columns 1 to 6 is not a record{}", record, hint));
        }
        if (unknown_.size() < 10) {
            unknown_.insert(is_name(record) ? std::string(record)
                                            : fmt::format("line {}", lines_.number()));
        }
    }

    void begin_model() {
        if (model_line_ != 0) {
            fail_line(fmt::format("a MODEL inside the model of line {}; expected ENDMDL before it",
                                  model_line_));
        }
        // Some write the number a column further left or right.
        const std::string_view text = trimmed(lines_.line().substr(5));
        const std::optional<std::int64_t> number = find_integer(text);
        if (!number || *number < 0 || *number > 1'000'000'000) {
            fail(model_columns, "not a model number; expected a whole number from 0");
        }
        if (!models_.insert(*number).second) {
            fail_line(fmt::format("model {} again", *number));
        }
        model_ = static_cast<std::int32_t>(*number);
        model_line_ = lines_.number();
    }

    void read_atom(bool hetero, bool wide_serial) {
        constexpr std::size_t end = position_columns[2].first + position_columns[2].count;
        if (lines_.line().size() < end) {
            fail_line(fmt::format("ends with column {}; expected coordinates up to column {}",
                                  lines_.line().size(), end));
        }
        AtomRecord record;
        record.hetero = hetero;
        record.model = model_;
        record.serial = serial(wide_serial);
        AtomName name;
        name.atom = word(atom_columns, "an atom name");
        record.alternate = letter(alternate_columns);
        name.residue = word(residue_columns, "a residue name");
        const char chain = letter(chain_columns);
        if (chain != ' ') record.chain = chain;
        name.segment =
            field(segment_columns).empty() ? record.chain : word(segment_columns, "a segment name");
        read_residue_number(record, name);
        Vec3 position;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            position[static_cast<Eigen::Index>(axis)] = coordinate(position_columns[axis]);
        }
        if (!field(occupancy_columns).empty()) {
            record.occupancy =
                real(occupancy_columns, "an occupancy; expected a number, often 1.00");
        }
        if (!field(b_factor_columns).empty()) {
            record.b_factor = real(b_factor_columns, "a B-factor; expected a number in Å^2");
        }
        record.element = upper_case(field(element_columns));
        const std::optional<std::int32_t> charge = find_formal_charge(field(charge_columns));
        if (!charge) fail(charge_columns, "not a charge; expected a digit and its sign, as 1+");
        record.formal_charge = *charge;
        builder_.add_atom(std::move(name), position, std::move(record), lines_.number());
    }

    std::int64_t serial(bool wide) {
        Columns columns = serial_columns;
        if (wide) --columns.first;
        if (wide || is_digit(lines_.line()[11])) ++columns.count;
        const std::string_view text = field(columns);
        if (!text.empty() && text.find_first_not_of('*') == std::string_view::npos) {
            return ++last_serial_;
        }
        const std::optional<std::int64_t> value = find_wide_number(text, columns.count);
        if (!value) fail(columns, "not an atom serial number; expected a whole number");
        last_serial_ = *value;
        return *value;
    }

    void read_residue_number(AtomRecord& record, AtomName& name) {
        Columns columns = number_columns;
        const char insertion = letter(insertion_columns);
        const bool fifth_digit = is_digit(insertion) && is_digit(lines_.line()[columns.first]);
        if (fifth_digit) {
            ++columns.count;
        } else if (insertion != ' ' && !is_letter(insertion)) {
            fail(insertion_columns, "not an insertion code; expected a letter or a blank");
        } else {
            record.insertion_code = insertion;
        }
        const std::optional<std::int64_t> value = find_wide_number(field(columns), columns.count);
        if (!value) fail(columns, "not a residue number; expected a whole number");
        if (*value == 0 && last_residue_ == 9999 && record.chain == last_chain_) {
            residue_offset_ += 10'000;
        } else if (record.chain != last_chain_) {
            residue_offset_ = 0;
        }
        last_residue_ = *value;
        last_chain_ = record.chain;
        record.residue_number = static_cast<std::int32_t>(*value + residue_offset_);
        name.number = fmt::format("{}", record.residue_number);
        if (record.insertion_code != ' ') name.number += record.insertion_code;
    }

    char letter(Columns column) const {
        const char value = lines_.line()[column.first];
        if (value < ' ' || value > '~') fail(column, "not a letter that can be printed");
        return value;
    }

    std::string word(Columns columns, const char* what) const {
        const std::string_view text = field(columns);
        if (!is_name(text)) {
            fail(columns,
                 fmt::format("not {}; expected letters without blanks between them", what));
        }
        return std::string(text);
    }

    double real(Columns columns, const char* what) const {
        const std::optional<double> value = find_real(field(columns));
        if (!value) fail(columns, fmt::format("not {}", what));
        return *value;
    }

    double coordinate(Columns columns) const {
        const std::optional<double> value = find_coordinate(field(columns));
        if (!value) {
            fail(columns, fmt::format("not a coordinate; expected a number within ±{} Å",
                                      farthest_coordinate));
        }
        return *value;
    }

    const std::string& file_;
    LineReader lines_;
    StructureBuilder builder_;
    Remark350 remark_350_;
    std::int32_t model_ = 1;
    std::size_t model_line_ = 0;  // of the model that is open
    std::size_t end_line_ = 0;
    std::set<std::int64_t> models_;
    std::set<std::string> unknown_;  // records
    std::int64_t last_serial_ = 0, last_residue_ = 0;
    std::string last_chain_;
    std::int64_t residue_offset_ = 0;  // of numbers that started over
};

// `value` as it stands in the file; throws if it is wider than its columns.
std::string fitted(const Structure& structure, std::size_t atom, const char* what,
                   std::optional<std::string> value, std::size_t width) {
    if (value && value->size() <= width) return *value;
    const std::size_t line = structure.lines.empty() ? 0 : structure.lines[atom];
    throw LoadError({structure.file, line, 0},
                    fmt::format("the {} of {}{} does not fit the {} columns of a PDB file", what,
                                to_string(structure.names[atom]),
                                value ? fmt::format(", '{}',", *value) : "", width));
}

std::string format_serial(const Structure& structure, std::size_t atom, std::size_t serial) {
    return fitted(structure, atom, "serial",
                  format_wide_number(static_cast<std::int64_t>(serial), 5), 5);
}

// Columns 18 to 27: residue name, chain, residue number, insertion code.
std::string format_residue(const Structure& structure, std::size_t atom) {
    const AtomName& name = structure.names[atom];
    const std::string chain = structure.records.empty() ? "" : structure.records[atom].chain;
    const bool insertion = !name.number.empty() && is_letter(name.number.back());
    const std::string_view digits =
        std::string_view(name.number).substr(0, name.number.size() - (insertion ? 1 : 0));
    const std::optional<std::int64_t> number = find_integer(digits);
    const std::string residue = fmt::format("{:>3}", name.residue);
    return fmt::format("{:<4}{:1}{}{}", fitted(structure, atom, "residue name", residue, 4),
                       fitted(structure, atom, "chain", chain, 1),
                       fitted(structure, atom, "residue number",
                              number ? format_wide_number(*number, 4) : std::nullopt, 4),
                       insertion ? name.number.back() : ' ');
}

std::string without_end_blanks(const std::string& line) {
    return line.substr(0, line.find_last_not_of(' ') + 1);
}

std::string format_atom(const Structure& structure, std::size_t atom, std::size_t serial) {
    const auto fit = [&](const char* what, std::optional<std::string> value, std::size_t width) {
        return fitted(structure, atom, what, std::move(value), width);
    };
    const AtomName& name = structure.names[atom];
    const AtomRecord record = structure.records.empty() ? AtomRecord{} : structure.records[atom];
    const std::string segment = name.segment == record.chain ? "" : name.segment;
    // The element stands right in columns 13 and 14, but for names that need all four.
    const bool indent = name.atom.size() < 4 && record.element.size() < 2;
    std::string text = fmt::format("{:<6}{} {:<4}{}{}   ", record.hetero ? "HETATM" : "ATOM",
                                   format_serial(structure, atom, serial),
                                   fit("atom name", (indent ? " " : "") + name.atom, 4),
                                   record.alternate, format_residue(structure, atom));
    for (const double coordinate : structure.positions[atom]) {
        text += fit("coordinate", fmt::format("{:8.3f}", coordinate), 8);
    }
    const std::int32_t charge = record.formal_charge;
    text += fmt::format(
        "{}{}      {:<4}{:>2}{:2}", fit("occupancy", fmt::format("{:6.2f}", record.occupancy), 6),
        fit("B-factor", fmt::format("{:6.2f}", record.b_factor), 6), fit("segment", segment, 4),
        fit("element", record.element, 2),
        fit("charge",
            charge == 0 ? "" : fmt::format("{}{}", std::abs(charge), charge < 0 ? '-' : '+'), 2));
    return without_end_blanks(text) + "\n";
}

}  // namespace

Structure parse_pdb(std::string_view text, const std::string& file) {
    return PdbReader(text, file).read();
}

Structure read_pdb(const std::filesystem::path& path) {
    return parse_pdb(read_packed_text_file(path), path.string());
}

Structure with_short_chains(Structure structure) {
    constexpr std::string_view letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
    std::map<std::string, std::string> names;
    std::set<std::string> taken;
    for (const AtomRecord& record : structure.records) {
        if (record.chain.size() <= 1) taken.insert(record.chain);
    }
    for (AtomRecord& record : structure.records) {
        if (record.chain.size() <= 1) continue;
        const auto [name, is_new] = names.try_emplace(record.chain);
        if (is_new) {
            std::size_t at = 0;
            while (at < letters.size() && taken.contains(std::string(1, letters[at]))) ++at;
            name->second = std::string(1, letters[at < letters.size() ? at : 0]);
            taken.insert(name->second);
        }
        record.chain = name->second;
    }
    return structure;
}

std::string format_pdb(const Structure& structure, std::string_view title) {
    const auto model_of = [&](std::size_t atom) {
        return structure.records.empty() ? 1 : structure.records[atom].model;
    };
    const bool models = std::any_of(structure.records.begin(), structure.records.end(),
                                    [](const AtomRecord& record) { return record.model != 1; });
    std::string text;
    for (const std::string_view line : split_lines(title)) {
        text += fmt::format("REMARK   1 {}\n", line);
    }
    std::size_t serial = 0;
    auto end = structure.chain_ends.begin();
    for (std::size_t atom = 0; atom < structure.names.size(); ++atom) {
        if (models && (atom == 0 || model_of(atom) != model_of(atom - 1))) {
            if (atom > 0) text += "ENDMDL\n";
            text += fmt::format("MODEL     {:4}\n", model_of(atom));
            serial = 0;
        }
        text += format_atom(structure, atom, ++serial);
        for (; end != structure.chain_ends.end() && *end <= atom + 1; ++end) {
            text += without_end_blanks(fmt::format("TER   {}      {}",
                                                   format_serial(structure, atom, ++serial),
                                                   format_residue(structure, atom))) +
                    "\n";
        }
    }
    return text + (models ? "ENDMDL\nEND\n" : "END\n");
}

}  // namespace palpa
