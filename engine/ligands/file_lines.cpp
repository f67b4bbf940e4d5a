#include "ligands/file_lines.h"

#include "core/load_error.h"
#include "core/text.h"
#include "molecule/element.h"

#include <fmt/format.h>

namespace palpa {

std::string_view FileLines::take(const char* what) {
    if (lines_.at_end()) fail(fmt::format("the file ends here; expected {}", what));
    const std::string_view line = lines_.line();
    lines_.advance();
    return line;
}

void FileLines::fail(const std::string& what) const {
    throw LoadError({file_, lines_.number(), 0}, what);
}

std::size_t FileLines::count(std::string_view text, const char* what) const {
    const auto found = find_integer(text);
    if (!found || *found < 0 || *found > 1'000'000) {
        fail(fmt::format("'{}' is not a whole number; expected the {}", shortened(text), what));
    }
    return static_cast<std::size_t>(*found);
}

Vec3 FileLines::position(std::string_view x, std::string_view y, std::string_view z) const {
    Vec3 place;
    Eigen::Index i = 0;
    for (const std::string_view text : {x, y, z}) {
        const auto found = find_coordinate(text);
        if (!found) {
            fail(fmt::format("'{}' is not a coordinate; expected a number within ±{:g} Å",
                             shortened(text), farthest_coordinate));
        }
        place(i++) = *found;
    }
    return place;
}

std::string FileLines::element(std::string_view text) const {
    const std::string symbol = upper_case(text);
    if (!is_element(symbol)) {
        fail(fmt::format("'{}' is not an element; expected a symbol such as C or Cl",
                         shortened(text)));
    }
    return symbol == "D" ? "H" : symbol;
}

void FileLines::add_bond(std::size_t a, std::size_t b, int order, MoleculeGraph& graph) const {
    if (a < 1 || b < 1 || a > graph.size() || b > graph.size() || a == b) {
        fail(fmt::format("a bond of atoms {} and {}; expected two different atoms from 1 to {}", a,
                         b, graph.size()));
    }
    for (const GraphBond& bond : graph.bonds) {
        if ((bond.a == a - 1 && bond.b == b - 1) || (bond.a == b - 1 && bond.b == a - 1)) {
            fail(fmt::format("the bond of atoms {} and {} is repeated", a, b));
        }
    }
    graph.bonds.push_back(
        {static_cast<std::uint32_t>(a - 1), static_cast<std::uint32_t>(b - 1), order});
}

}  // namespace palpa
