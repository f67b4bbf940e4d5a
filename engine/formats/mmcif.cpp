#include "formats/mmcif.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/cif.h"
#include "formats/gzip.h"
#include "formats/lines.h"
#include "formats/links.h"
#include "formats/mmcif_assemblies.h"
#include "formats/structure_builder.h"
#include "molecule/element.h"

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// The columns that are read; `column_names` in the same order.
enum Column : std::uint8_t {
    Group,
    Serial,
    Element,
    Alternate,
    Insertion,
    X,
    Y,
    Z,
    Occupancy,
    BFactor,
    Charge,
    Model,
    AuthAtom,
    AuthResidue,
    AuthChain,
    AuthNumber,
    LabelAtom,
    LabelResidue,
    LabelChain,
    LabelNumber,
};
constexpr std::array column_names = std::to_array<std::string_view>({"group_PDB",
                                                                     "id",
                                                                     "type_symbol",
                                                                     "label_alt_id",
                                                                     "pdbx_PDB_ins_code",
                                                                     "Cartn_x",
                                                                     "Cartn_y",
                                                                     "Cartn_z",
                                                                     "occupancy",
                                                                     "B_iso_or_equiv",
                                                                     "pdbx_formal_charge",
                                                                     "pdbx_PDB_model_num",
                                                                     "auth_atom_id",
                                                                     "auth_comp_id",
                                                                     "auth_asym_id",
                                                                     "auth_seq_id",
                                                                     "label_atom_id",
                                                                     "label_comp_id",
                                                                     "label_asym_id",
                                                                     "label_seq_id"});
static_assert(column_names.size() == LabelNumber + 1);

constexpr std::string_view category = "_ATOM_SITE.";
constexpr std::string_view dictionary_category = "_CHEM_COMP_ATOM.";

// Takes the atoms out of what the grammar finds.
class AtomSites final : public CifListener {
public:
    AtomSites(const std::string& file, std::size_t atoms) : file_(file), builder_(file, atoms) {}

    void begin_loop() override {
        ++loop_;
        columns_.clear();
    }

    void add_loop_tag(const CifToken& tag) override { columns_.push_back(find_column(tag, loop_)); }

    void add_loop_value(const CifToken& value) override {
        if (table_ != loop_) return;
        if (const std::optional<Column> column = columns_[filled_]) row_[*column] = value;
        last_ = value;
        if (++filled_ < columns_.size()) return;
        filled_ = 0;
        add_atom();
    }

    void end_loop() override {
        if (table_ != loop_ || filled_ == 0) return;
        fail({{}, last_.line, 0}, fmt::format("a row of _atom_site ends after {} of {} values",
                                              filled_, columns_.size()));
    }

    void add_tag(const CifToken& tag) override { column_ = find_column(tag, single_row); }

    void add_value(const CifToken& value) override {
        if (column_) row_[*column_] = value;
    }

    // `end`: of what the file says.
    Structure build(const char* end, std::size_t last_line) {
        if (table_ == single_row) add_atom();
        if (last_.text.data() + last_.text.size() == end) {
            builder_.add_doubt("ends with its last atom: the file may have been cut off");
        }
        if (builder_.atom_count() == 0 && dictionary_line_ != 0) {
            fail({{}, dictionary_line_, 0},
                 "is a chemical component (_chem_comp_atom, ideal geometry of a residue), not a "
                 "structure; expected atoms in _atom_site");
        }
        builder_.end_chain();
        return builder_.build(last_line);
    }

private:
    [[noreturn]] void fail(const CifToken& token, const std::string& what) const {
        throw LoadError({file_, token.line, token.column}, what);
    }

    // Of tags that stand outside of any loop, with a value each: a table of one row.
    static constexpr std::size_t single_row = 0;

    // Nothing for what is not read.
    std::optional<Column> find_column(const CifToken& tag, std::size_t table) {
        const std::string full_name = upper_case(tag.text);
        if (dictionary_line_ == 0 && full_name.starts_with(dictionary_category)) {
            dictionary_line_ = tag.line;
        }
        if (!full_name.starts_with(category)) return {};
        if (table_ && *table_ != table) {
            fail(tag,
                 fmt::format(
                     "a second table of atoms, first on line {}; expected one table _atom_site",
                     table_line_));
        }
        if (!table_) table_line_ = tag.line;
        table_ = table;
        const std::string_view name = std::string_view(full_name).substr(category.size());
        for (std::size_t i = 0; i < column_names.size(); ++i) {
            if (upper_case(column_names[i]) != name) continue;
            if (given_[i]) fail(tag, fmt::format("column {} is repeated", tag.text));
            given_[i] = true;
            return static_cast<Column>(i);
        }
        return {};
    }

    [[noreturn]] void fail_value(Column column, std::string_view expected) const {
        const CifToken& cell = row_[column];
        if (!given_[column]) {
            fail({{}, table_line_, 0},
                 fmt::format("the column _atom_site.{} is missing; expected {}",
                             column_names[column], expected));
        }
        fail(cell, fmt::format("'{}' in _atom_site.{} is not {}", shortened(cell.text),
                               column_names[column], expected));
    }

    std::string_view text(Column column) const { return unquoted(row_[column].text); }

    // What the author calls it, or else the archive.
    Column either(Column author, Column label) const {
        return text(author).empty() ? label : author;
    }

    std::string word(Column column, const char* what) const {
        const std::string_view word = text(column);
        if (!is_name(word)) fail_value(column, what);
        return std::string(word);
    }

    double real(Column column, const char* what) const {
        const std::optional<double> value = find_real(text(column));
        if (!value) fail_value(column, what);
        return *value;
    }

    double coordinate(Column column) const {
        const std::optional<double> value = find_coordinate(text(column));
        if (!value) {
            fail_value(column, fmt::format("a coordinate within ±{} Å", farthest_coordinate));
        }
        return *value;
    }

    std::int32_t integer(Column column, const char* what) const {
        const std::optional<std::int64_t> value = find_integer(text(column));
        using Limits = std::numeric_limits<std::int32_t>;
        if (!value || *value < Limits::min() || *value > Limits::max()) fail_value(column, what);
        return static_cast<std::int32_t>(*value);
    }

    char letter(Column column, const char* what) const {
        const std::string_view letter = text(column);
        if (letter.empty()) return ' ';
        if (letter.size() > 1 || !is_name(letter)) fail_value(column, what);
        return letter[0];
    }

    void add_atom() {
        AtomRecord record;
        AtomName name;
        const std::string_view group = text(Group);
        if (!group.empty() && group != "ATOM" && group != "HETATM") {
            fail_value(Group, "ATOM or HETATM");
        }
        record.hetero = group == "HETATM";
        if (!text(Serial).empty()) record.serial = integer(Serial, "a whole number");
        record.element = upper_case(text(Element));
        name.atom = word(either(AuthAtom, LabelAtom), "the name of an atom");
        record.alternate = letter(Alternate, "one letter");
        name.residue = word(either(AuthResidue, LabelResidue), "the name of a residue");
        record.chain = word(either(AuthChain, LabelChain), "the name of a chain");
        name.segment = record.chain;
        record.label_chain = text(LabelChain);
        record.residue_number =
            integer(either(AuthNumber, LabelNumber), "a residue number, a whole number");
        record.insertion_code = letter(Insertion, "one letter");
        name.number = fmt::format("{}", record.residue_number);
        if (record.insertion_code != ' ') name.number += record.insertion_code;
        // One by one: the first error counts.
        const double x = coordinate(X);
        const double y = coordinate(Y);
        const double z = coordinate(Z);
        if (!text(Occupancy).empty()) record.occupancy = real(Occupancy, "a number, often 1.00");
        if (!text(BFactor).empty()) record.b_factor = real(BFactor, "a number in Å^2");
        if (!text(Charge).empty()) record.formal_charge = integer(Charge, "a whole number");
        if (!text(Model).empty()) record.model = integer(Model, "a whole number");
        if (text(LabelChain) != last_label_chain_) builder_.end_chain();
        last_label_chain_ = text(LabelChain);
        builder_.add_atom(std::move(name), Vec3(x, y, z), std::move(record), row_[X].line);
    }

    const std::string& file_;
    StructureBuilder builder_;
    std::size_t loop_ = 0;                        // number of the loop, from 1
    std::vector<std::optional<Column>> columns_;  // of this loop
    std::size_t filled_ = 0;                      // values of the row so far
    CifToken last_;                               // its last value
    std::optional<Column> column_;                // of the last tag outside of a loop
    std::optional<std::size_t> table_;            // the loop of _atom_site
    std::size_t table_line_ = 0;
    std::size_t dictionary_line_ = 0;  // of the first _chem_comp_atom
    std::array<bool, column_names.size()> given_{};
    std::array<CifToken, column_names.size()> row_{};
    std::string_view last_label_chain_;
};

// Tells several listeners.
class All final : public CifListener {
public:
    explicit All(std::array<CifListener*, 3> listeners) : listeners_(listeners) {}

    void begin_loop() override {
        for (CifListener* const one : listeners_) one->begin_loop();
    }
    void add_loop_tag(const CifToken& tag) override {
        for (CifListener* const one : listeners_) one->add_loop_tag(tag);
    }
    void add_loop_value(const CifToken& value) override {
        for (CifListener* const one : listeners_) one->add_loop_value(value);
    }
    void end_loop() override {
        for (CifListener* const one : listeners_) one->end_loop();
    }
    void add_tag(const CifToken& tag) override {
        for (CifListener* const one : listeners_) one->add_tag(tag);
    }
    void add_value(const CifToken& value) override {
        for (CifListener* const one : listeners_) one->add_value(value);
    }

private:
    std::array<CifListener*, 3> listeners_;
};

// A value as CIF writes it: as it is, or in the quotes that it does not hold.
std::string quoted(const Structure& structure, std::size_t atom, const std::string& value) {
    if (!is_name(value)) {
        const std::size_t line = structure.lines.empty() ? 0 : structure.lines[atom];
        throw LoadError({structure.file, line},
                        fmt::format("'{}' of {} cannot be a name in a CIF file; expected printable "
                                    "letters without blanks",
                                    value, to_string(structure.names[atom])));
    }
    // What the grammar takes for something else, and what would be "not given".
    const std::string upper = upper_case(value);
    const bool plain = std::string_view("_#$'\"[];").find(value[0]) == std::string_view::npos &&
                       value != "?" && value != "." && !upper.starts_with("DATA_") &&
                       !upper.starts_with("SAVE_") && upper != "LOOP_" && upper != "STOP_" &&
                       upper != "GLOBAL_";
    if (plain) return value;
    // Quotes end a value only where a blank follows, and names have none.
    return value.back() == '"' ? fmt::format("'{}'", value) : fmt::format("\"{}\"", value);
}

// A to Z, AA to ZA, AB to ZB and so on, as the archive names chains.
std::string chain_name(std::size_t number) {
    std::string name;
    for (++number; number > 0; number = (number - 1) / 26) {
        name += static_cast<char>('A' + (number - 1) % 26);
    }
    return name;
}

// Residue number and insertion code, '?' without one.
std::pair<std::string, std::string> number_and_code(const Structure& structure, std::size_t atom) {
    std::string number = structure.names[atom].number;
    std::string code = "?";
    if (!number.empty() && (number.back() < '0' || number.back() > '9')) {
        code = quoted(structure, atom, number.substr(number.size() - 1));
        number.pop_back();
    }
    if (!find_integer(number)) {
        const std::size_t line = structure.lines.empty() ? 0 : structure.lines[atom];
        throw LoadError(
            {structure.file, line},
            fmt::format("'{}' of {} is not a residue number of a CIF file; expected a whole number "
                        "with one letter behind it, or none",
                        structure.names[atom].number, to_string(structure.names[atom])));
    }
    return {number, code};
}

std::string element_of(const Structure& structure, std::size_t atom) {
    if (!structure.records.empty()) return structure.records[atom].element;
    const AtomName& name = structure.names[atom];
    std::string element = find_element_of_name(name.atom, name.residue);
    if (element.empty()) {
        const std::size_t line = structure.lines.empty() ? 0 : structure.lines[atom];
        throw LoadError({structure.file, line},
                        fmt::format("the name of {} gives no element, which a CIF file needs",
                                    to_string(name)));
    }
    return element;
}

}  // namespace

Structure parse_mmcif(std::string_view text, const std::string& file) {
    AtomSites sites(file, count_lines(text, "ATOM") + count_lines(text, "HETATM"));
    MmcifAssemblies assemblies(file);
    MmcifLinks links;
    All all({&sites, &assemblies, &links});
    parse_cif(text, file, all);
    const std::size_t length = text.find_last_not_of(" \t\r\n") + 1;  // 0 without any
    Structure structure = sites.build(text.data() + length, count_lines(text, ""));
    assemblies.move_into(structure);
    structure.links = links.take();
    return structure;
}

Structure read_mmcif(const std::filesystem::path& path) {
    return parse_mmcif(read_packed_text_file(path), path.string());
}

std::string format_mmcif(const Structure& structure, std::string_view name) {
    std::string block;
    for (const char c : name) {
        const bool plain =
            (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-';
        block += plain ? c : '_';
    }
    if (block.empty()) block = "structure";
    std::string text = fmt::format("data_{}\n#\nloop_\n", block);
    for (const std::string_view column : {"group_PDB",         "id",
                                          "type_symbol",       "label_atom_id",
                                          "label_alt_id",      "label_comp_id",
                                          "label_asym_id",     "label_entity_id",
                                          "label_seq_id",      "pdbx_PDB_ins_code",
                                          "Cartn_x",           "Cartn_y",
                                          "Cartn_z",           "occupancy",
                                          "B_iso_or_equiv",    "pdbx_formal_charge",
                                          "auth_seq_id",       "auth_comp_id",
                                          "auth_asym_id",      "auth_atom_id",
                                          "pdbx_PDB_model_num"}) {
        text += fmt::format("_atom_site.{}\n", column);
    }
    std::size_t chain = 0;
    auto end = structure.chain_ends.begin();
    for (std::size_t atom = 0; atom < structure.names.size(); ++atom) {
        const AtomName& names = structure.names[atom];
        const AtomRecord record =
            structure.records.empty() ? AtomRecord{} : structure.records[atom];
        const auto chain_of = [&](std::size_t i) {
            const bool has_chain =
                !structure.records.empty() && !structure.records[i].chain.empty();
            return has_chain ? structure.records[i].chain : structure.names[i].segment;
        };
        if (atom > 0) {
            bool is_end = chain_of(atom) != chain_of(atom - 1);
            for (; end != structure.chain_ends.end() && *end <= atom; ++end) is_end = true;
            if (is_end) ++chain;
            const bool is_next_model =
                !structure.records.empty() && record.model != structure.records[atom - 1].model;
            if (is_next_model) chain = 0;
        }
        const std::string author = chain_of(atom);
        const auto [number, code] = number_and_code(structure, atom);
        const auto quote = [&](const std::string& value) { return quoted(structure, atom, value); };
        const Vec3& p = structure.positions[atom];
        fmt::format_to(
            std::back_inserter(text),
            "{} {} {} {} {} {} {} ? . {} {:.5f} {:.5f} {:.5f} {:.2f} {:.2f} {} {} {} {} {} {}\n",
            record.hetero ? "HETATM" : "ATOM", atom + 1, element_of(structure, atom),
            quote(names.atom), record.alternate == ' ' ? "." : quote({record.alternate}),
            quote(names.residue),
            quote(record.label_chain.empty() ? chain_name(chain) : record.label_chain), code, p.x(),
            p.y(), p.z(), record.occupancy, record.b_factor,
            record.formal_charge == 0 ? "?" : fmt::format("{}", record.formal_charge), number,
            quote(names.residue), quote(author.empty() ? chain_name(chain) : author),
            quote(names.atom), record.model);
    }
    return text + "#\n";
}

}  // namespace palpa
