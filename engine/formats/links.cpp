#include "formats/links.h"

#include "core/text.h"
#include "formats/lines.h"

#include <fmt/format.h>
#include <cstdint>
#include <string>
#include <utility>

namespace palpa {
namespace {

constexpr std::size_t most_links = 100'000;

// Where a record names one atom; SSBOND has no atom and no location.
struct AtomColumns {
    Columns atom, alternate, residue, chain, number, insertion, symmetry;
};
constexpr std::array<AtomColumns, 2> of_link{
    {{{12, 4}, {16, 1}, {17, 4}, {21, 1}, {22, 4}, {26, 1}, {59, 6}},
     {{42, 4}, {46, 1}, {47, 4}, {51, 1}, {52, 4}, {56, 1}, {66, 6}}}};
constexpr std::array<AtomColumns, 2> of_disulphide{
    {{{0, 0}, {0, 0}, {11, 3}, {15, 1}, {17, 4}, {21, 1}, {59, 6}},
     {{0, 0}, {0, 0}, {25, 3}, {29, 1}, {31, 4}, {35, 1}, {66, 6}}}};

// As readers of atoms number residues; empty where it is no number.
std::string linked_number(std::string_view number, std::string_view insertion) {
    const auto value = find_integer(number);
    return value ? fmt::format("{}{}", *value, insertion) : std::string();
}

bool is_whole(const LinkedAtom& atom) {
    return is_name(atom.atom) && is_name(atom.residue) && !atom.number.empty();
}

LinkedAtom read_linked_atom(std::string_view line, const AtomColumns& columns,
                            std::string_view atom) {
    const std::string_view alternate = find_field(line, columns.alternate);
    return {std::string(find_field(line, columns.chain)),
            std::string(find_field(line, columns.residue)),
            linked_number(find_field(line, columns.number), find_field(line, columns.insertion)),
            std::string(atom.empty() ? find_field(line, columns.atom) : atom),
            alternate.empty() ? ' ' : alternate.front()};
}

// The columns of _struct_conn, of the first atom; the second's have a 2 for the 1.
enum class LinkColumn : std::uint8_t {
    Chain,
    Residue,
    Number,
    Insertion,
    Atom,
    Alternate,
    Symmetry
};
constexpr auto first_names = std::to_array<std::string_view>(
    {"PTNR1_AUTH_ASYM_ID", "PTNR1_AUTH_COMP_ID", "PTNR1_AUTH_SEQ_ID", "PDBX_PTNR1_PDB_INS_CODE",
     "PTNR1_LABEL_ATOM_ID", "PDBX_PTNR1_LABEL_ALT_ID", "PTNR1_SYMMETRY"});
constexpr std::string_view link_category = "_STRUCT_CONN.";

}  // namespace

std::optional<StructureLink> find_pdb_link(std::string_view line, std::size_t number) {
    const bool is_disulphide = line.starts_with("SSBOND");
    const auto& columns = is_disulphide ? of_disulphide : of_link;
    const std::string_view atom = is_disulphide ? "SG" : "";
    StructureLink link{read_linked_atom(line, columns[0], atom),
                       read_linked_atom(line, columns[1], atom), number};
    if (!is_whole(link.a) || !is_whole(link.b)) return std::nullopt;
    // Two atoms of one copy are bonded in every copy.
    if (find_field(line, columns[0].symmetry) != find_field(line, columns[1].symmetry)) {
        return std::nullopt;
    }
    return link;
}

std::optional<std::size_t> MmcifLinks::find_column(std::string_view tag) {
    std::string name = upper_case(tag.substr(0, 64));
    if (!name.starts_with(link_category)) return std::nullopt;
    name.erase(0, link_category.size());
    if (name == "CONN_TYPE_ID") return 0;
    const std::size_t digit = name.find("PTNR2");
    if (digit != std::string::npos) name[digit + 4] = '1';
    for (std::size_t i = 0; i < first_names.size(); ++i) {
        if (first_names[i] != name) continue;
        return 1 + i + (digit != std::string::npos ? first_names.size() : 0);
    }
    return columns;  // of the table, and not read
}

void MmcifLinks::begin_loop() {
    columns_.clear();
    is_table_ = false;
    filled_ = 0;
}

void MmcifLinks::add_loop_tag(const CifToken& tag) {
    columns_.push_back(find_column(tag.text));
    is_table_ = is_table_ || columns_.back().has_value();
}

void MmcifLinks::add_loop_value(const CifToken& value) {
    if (!is_table_) return;
    const std::optional<std::size_t> column = columns_[filled_];
    if (column && *column < columns) row_[*column] = value;
    if (++filled_ < columns_.size()) return;
    filled_ = 0;
    add_row();
    row_.fill({});
}

void MmcifLinks::end_loop() { is_table_ = false; }

void MmcifLinks::add_tag(const CifToken& tag) { column_ = find_column(tag.text); }

void MmcifLinks::add_value(const CifToken& value) {
    if (!column_ || *column_ >= columns) return;
    row_[*column_] = value;
    has_single_row_ = true;
}

void MmcifLinks::add_row() {
    const std::string type = upper_case(unquoted(row_[0].text).substr(0, 8));
    const bool is_bond =
        type.starts_with("COVALE") || type.starts_with("DISULF") || type.starts_with("METALC");
    if (!is_bond || links_.size() == most_links) return;
    const auto text = [&](std::size_t atom, LinkColumn column) {
        return unquoted(
            row_[1 + atom * first_names.size() + static_cast<std::size_t>(column)].text);
    };
    const auto atom = [&](std::size_t i) {
        const std::string_view alternate = text(i, LinkColumn::Alternate);
        return LinkedAtom{
            std::string(text(i, LinkColumn::Chain)), std::string(text(i, LinkColumn::Residue)),
            linked_number(text(i, LinkColumn::Number), text(i, LinkColumn::Insertion)),
            std::string(text(i, LinkColumn::Atom)), alternate.empty() ? ' ' : alternate.front()};
    };
    StructureLink link{atom(0), atom(1), row_[0].line};
    const bool is_here = text(0, LinkColumn::Symmetry) == text(1, LinkColumn::Symmetry);
    if (is_here && is_whole(link.a) && is_whole(link.b)) links_.push_back(std::move(link));
}

std::vector<StructureLink> MmcifLinks::take() {
    if (has_single_row_) add_row();
    return std::move(links_);
}

}  // namespace palpa
