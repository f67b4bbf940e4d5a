#include "prepare/check_coordinates.h"

#include "charmm/missing.h"
#include "math/vec.h"
#include "molecule/coincident_atoms.h"
#include "prepare/residues.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace palpa {
namespace {

void refuse_coincident(const Structure& structure, std::span<const std::uint8_t> is_added) {
    constexpr double closest = 0.5;  // Å
    std::vector<std::size_t> atoms;
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < is_added.size(); ++i) {
        if (is_added[i] != 0) continue;
        atoms.push_back(i);
        positions.push_back(structure.positions[i]);
    }
    Missing missing;
    for (const auto& [first, second] : find_coincident_atoms(positions, closest)) {
        const std::size_t a = atoms[first], b = atoms[second];
        missing.add({structure.file, structure.lines[b], 0},
                    fmt::format("{} is {:.2f} Å from {} (line {}); expected atoms apart (leave one "
                                "residue out with --without)",
                                to_string(structure.names[b]),
                                (structure.positions[a] - structure.positions[b]).norm(),
                                to_string(structure.names[a]), structure.lines[a]));
    }
    missing.throw_if_any();
}

void check_bonds(const Structure& structure, const Topology& topology,
                 std::span<const std::uint8_t> is_added, Report& report) {
    constexpr double most_off = 0.4;  // Å
    std::vector<double> ratios;
    std::vector<std::string> strange;
    for (const Bond& bond : topology.bonds) {
        if (is_added[bond.a] != 0 || is_added[bond.b] != 0 || !(bond.r0 > 0)) continue;
        if (element_of(structure, bond.a) == "H" || element_of(structure, bond.b) == "H") continue;
        const double length = (structure.positions[bond.a] - structure.positions[bond.b]).norm();
        ratios.push_back(length / bond.r0);
        if (std::abs(length - bond.r0) < most_off) continue;
        strange.push_back(fmt::format("{} to {}, {:.2f} Å", to_string(structure.names[bond.a]),
                                      structure.names[bond.b].atom, length));
    }
    if (ratios.empty()) return;
    const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    if (*middle < 0.7 || *middle > 1.5) {
        throw LoadError(
            {structure.file},
            fmt::format("bonds are {:.2f} times their normal length; expected coordinates in Å",
                        *middle));
    }
    if (!strange.empty()) {
        report.warn(fmt::format("bonds of unusual length: {}", join_some(strange)));
    }
}

void check_hands(const Structure& structure, std::span<const std::uint8_t> is_added,
                 Report& report) {
    std::vector<std::string> wrong;
    for (const ResidueRange& residue : find_residues(structure)) {
        const auto n = find_atom(structure, residue, "N");
        const auto ca = find_atom(structure, residue, "CA");
        const auto c = find_atom(structure, residue, "C");
        const auto cb = find_atom(structure, residue, "CB");
        if (!n || !ca || !c || !cb || is_added[*cb] != 0) continue;
        const Vec3& centre = structure.positions[*ca];
        const Vec3 to_n = structure.positions[*n] - centre, to_c = structure.positions[*c] - centre;
        const Vec3 to_cb = structure.positions[*cb] - centre;
        // Looking from the hydrogen, CO, R, N stand clockwise in an L-amino acid.
        if (to_n.cross(to_c).dot(to_cb) < 0) wrong.push_back(residue_label(structure, residue));
    }
    if (wrong.empty()) return;
    report.warn(fmt::format(
        "D-amino acids, or a mirror image: {}; the force field has CMAPs for L-amino acids only",
        join_some(wrong)));
}

}  // namespace

void check_coordinates(const Structure& structure, const Topology& topology,
                       std::span<const std::uint8_t> is_added, Report& report) {
    check_bonds(structure, topology, is_added, report);
    refuse_coincident(structure, is_added);
    check_hands(structure, is_added, report);
}

}  // namespace palpa
