#include "molecule/hydropathy.h"

#include <algorithm>
#include <array>
#include <utility>

namespace palpa {
namespace {

using Row = std::pair<std::string_view, double>;

constexpr std::array table = std::to_array<Row>({{"ALA", 1.8},
                                                 {"ARG", -4.5},
                                                 {"ASN", -3.5},
                                                 {"ASP", -3.5},
                                                 {"CYS", 2.5},
                                                 {"GLN", -3.5},
                                                 {"GLU", -3.5},
                                                 {"GLY", -0.4},
                                                 {"HIS", -3.2},
                                                 {"ILE", 4.5},
                                                 {"LEU", 3.8},
                                                 {"LYS", -3.9},
                                                 {"MET", 1.9},
                                                 {"PHE", 2.8},
                                                 {"PRO", -1.6},
                                                 {"SER", -0.8},
                                                 {"THR", -0.7},
                                                 {"TRP", -0.9},
                                                 {"TYR", -1.3},
                                                 {"VAL", 4.2},
                                                 // As CHARMM and others call states of these.
                                                 {"HSD", -3.2},
                                                 {"HSE", -3.2},
                                                 {"HSP", -3.2},
                                                 {"HID", -3.2},
                                                 {"HIE", -3.2},
                                                 {"HIP", -3.2},
                                                 {"ASPP", -3.5},
                                                 {"ASH", -3.5},
                                                 {"GLUP", -3.5},
                                                 {"GLH", -3.5},
                                                 {"LSN", -3.9},
                                                 {"LYN", -3.9},
                                                 {"CYM", 2.5},
                                                 {"CYX", 2.5},
                                                 {"MSE", 1.9}});

}  // namespace

std::optional<double> find_hydropathy(std::string_view residue) noexcept {
    const auto* const row = std::ranges::find(table, residue, &Row::first);
    if (row == table.end()) return std::nullopt;
    return row->second;
}

}  // namespace palpa
