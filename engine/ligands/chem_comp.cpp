#include "ligands/chem_comp.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/cif.h"
#include "formats/lines.h"
#include "molecule/element.h"

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <map>
#include <vector>

namespace palpa {
namespace {

enum AtomColumn : std::uint8_t { AtomComp, AtomId, Element, Charge, X, Y, Z };
constexpr auto atom_columns =
    std::to_array<std::string_view>({"COMP_ID", "ATOM_ID", "TYPE_SYMBOL", "CHARGE", "X", "Y", "Z"});
// What the same columns are called in the Chemical Component Dictionary.
constexpr auto other_atom_columns =
    std::to_array<std::string_view>({"", "", "", "", "PDBX_MODEL_CARTN_X_IDEAL",
                                     "PDBX_MODEL_CARTN_Y_IDEAL", "PDBX_MODEL_CARTN_Z_IDEAL"});
enum BondColumn : std::uint8_t { BondComp, First, Second, Order };
constexpr auto bond_columns =
    std::to_array<std::string_view>({"COMP_ID", "ATOM_ID_1", "ATOM_ID_2", "TYPE"});
constexpr auto other_bond_columns = std::to_array<std::string_view>({"", "", "", "VALUE_ORDER"});

class ChemComp : public CifListener {
public:
    ChemComp(const std::string& file, std::string_view name) : file_(file), name_(name) {}
    virtual ~ChemComp() = default;

    LigandFile result;

    void begin_loop() override {
        columns_.clear();
        filled_ = 0;
        in_ = Table::Neither;
    }
    void add_loop_tag(const CifToken& tag) override {
        const std::string name = upper_case(tag.text);
        constexpr std::string_view atoms = "_CHEM_COMP_ATOM.", bonds = "_CHEM_COMP_BOND.";
        if (name.starts_with(atoms)) {
            in_ = Table::Atoms;
            columns_.push_back(
                find_column(name.substr(atoms.size()), atom_columns, other_atom_columns));
        } else if (name.starts_with(bonds)) {
            in_ = Table::Bonds;
            columns_.push_back(
                find_column(name.substr(bonds.size()), bond_columns, other_bond_columns));
        } else {
            columns_.push_back(-1);
        }
    }
    void add_loop_value(const CifToken& value) override {
        if (in_ == Table::Neither || columns_.empty()) return;
        const int column = columns_[filled_];
        if (column >= 0) row_[static_cast<std::size_t>(column)] = value;
        if (++filled_ < columns_.size()) return;
        filled_ = 0;
        if (unquoted(row_[0].text) == name_) in_ == Table::Atoms ? add_atom() : add_bond();
        row_ = {};
    }
    void end_loop() override { in_ = Table::Neither; }
    void add_tag(const CifToken& /*tag*/) override {}
    void add_value(const CifToken& /*value*/) override {}

private:
    enum class Table : std::uint8_t { Neither, Atoms, Bonds };

    template <class Names>
    static int find_column(std::string_view name, const Names& names, const Names& others) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (name == names[i] || name == others[i]) return static_cast<int>(i);
        }
        return -1;
    }

    [[noreturn]] void fail(const CifToken& at, const std::string& what) const {
        throw LoadError({file_, at.line, at.column}, what);
    }

    void add_atom() {
        const std::string atom = upper_case(unquoted(row_[AtomId].text));
        if (atom.empty()) fail(row_[0], "an atom has no name (atom_id)");
        const std::string element = upper_case(unquoted(row_[Element].text));
        if (!is_element(element)) {
            fail(row_[0],
                 fmt::format("atom {}: '{}' is not an element; expected a symbol such as C",
                             shortened(atom), shortened(element)));
        }
        const std::uint32_t index = index_of(atom, row_[0]);
        GraphAtom& into = result.graph.atoms[index];
        into.element = element == "D" ? "H" : element;
        into.charge = static_cast<int>(find_integer(unquoted(row_[Charge].text)).value_or(0));
        const auto x = find_coordinate(unquoted(row_[X].text));
        const auto y = find_coordinate(unquoted(row_[Y].text));
        const auto z = find_coordinate(unquoted(row_[Z].text));
        if (x && y && z) into.position = Vec3(*x, *y, *z);
    }

    void add_bond() {
        const std::uint32_t a = index_of(upper_case(unquoted(row_[First].text)), row_[0]);
        const std::uint32_t b = index_of(upper_case(unquoted(row_[Second].text)), row_[0]);
        if (a == b) fail(row_[0], "a bond joins an atom to itself");
        for (const GraphBond& bond : result.graph.bonds) {
            if ((bond.a == a && bond.b == b) || (bond.a == b && bond.b == a)) return;
        }
        const std::string order = upper_case(unquoted(row_[Order].text)).substr(0, 4);
        result.graph.bonds.push_back({a, b, order == "DOUB" ? 2 : order == "TRIP" ? 3 : 1});
        result.open_bonds.push_back(order != "SING" && order != "DOUB" && order != "TRIP");
    }

    std::uint32_t index_of(const std::string& atom, const CifToken& at) {
        const auto [found, is_new] =
            index_.emplace(atom, static_cast<std::uint32_t>(result.graph.size()));
        if (is_new) {
            if (result.graph.size() == most_ligand_atoms) {
                fail(at, fmt::format("more than {} atoms of {}", most_ligand_atoms, name_));
            }
            result.graph.atoms.push_back(
                {atom, find_element_of_name(atom, name_), 0, std::nullopt});
        }
        return found->second;
    }

    const std::string& file_;
    std::string_view name_;
    Table in_ = Table::Neither;
    std::vector<int> columns_;
    std::size_t filled_ = 0;
    std::array<CifToken, 8> row_;
    std::map<std::string, std::uint32_t> index_;
};

}  // namespace

std::optional<LigandFile> find_chem_comp(std::string_view text, const std::string& file,
                                         std::string_view name) {
    ChemComp reader(file, name);
    parse_cif(text, file, reader);
    if (reader.result.graph.bonds.empty()) return std::nullopt;
    reader.result.graph.name = std::string(name);
    reader.result.names_atoms = true;
    return std::move(reader.result);
}

}  // namespace palpa
