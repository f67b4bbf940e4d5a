// A table with a residue of each kind, written down by hand.
#pragma once
#include "molecule/atoms.h"

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>

namespace palpa::test {

// Adds a residue whose atoms stand in a row from `x` on, 1 Å apart. Elements are the first letters
// of the names unless `element` names one; `bonds` are of atoms of the residue.
inline AtomRange add_residue(
    AtomTable& atoms, const AtomName& residue, std::initializer_list<const char*> names, double x,
    std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> bonds = {},
    const std::string& element = "") {
    const auto first = static_cast<std::uint32_t>(atoms.size());
    for (const char* const name : names) {
        const double at = x + static_cast<double>(atoms.size() - first);
        atoms.names.push_back({residue.segment, residue.residue, residue.number, name});
        atoms.positions.emplace_back(at, 0, 0);
        atoms.element.push_back(element.empty() ? std::string(1, name[0]) : element);
        atoms.mass.push_back(atoms.element.back() == "H" ? 1.008 : 12.011);
        atoms.charge.push_back(0);
    }
    for (const auto& [a, b] : bonds) atoms.bonds.push_back({first + a, first + b});
    return {first, static_cast<std::uint32_t>(names.size())};
}

// By their first atoms: alanine -1 (0), serine 27 (8), glycine 27A (16), adenosines 1 (21) and 2
// (27), a water (34), sodium (37), a glucose (38), a lipid (40), a ligand (42).
inline AtomTable one_of_each() {
    AtomTable atoms;
    add_residue(atoms, {"PROA", "ALA", "-1", ""}, {"N", "HN", "CA", "HA", "CB", "HB1", "C", "O"}, 0,
                {{0, 1}, {0, 2}, {2, 3}, {2, 4}, {4, 5}, {2, 6}, {6, 7}});
    add_residue(atoms, {"PROA", "SER", "27", ""}, {"N", "HN", "CA", "CB", "OG", "HG1", "C", "O"}, 8,
                {{0, 1}, {0, 2}, {2, 3}, {3, 4}, {4, 5}, {2, 6}, {6, 7}});
    add_residue(atoms, {"PROA", "GLY", "27A", ""}, {"N", "CA", "HA1", "C", "OT1"}, 16,
                {{0, 1}, {1, 2}, {1, 3}, {3, 4}});
    add_residue(atoms, {"B", "ADE", "1", ""}, {"P", "O5'", "C1'", "H1'", "N9", "O3'"}, 100,
                {{2, 3}});
    add_residue(atoms, {"B", "XXA", "2", ""}, {"P", "O4'", "C5'", "C1'", "C3'", "C4'", "N9"}, 106);
    atoms.bonds.push_back({26, 27});  // O3' to P
    add_residue(atoms, {"WA", "TIP3", "5", ""}, {"OH2", "H1", "H2"}, 200, {{0, 1}, {0, 2}});
    add_residue(atoms, {"IA", "SOD", "6", ""}, {"SOD"}, 210, {}, "NA");
    add_residue(atoms, {"CARA", "BGLC", "1", ""}, {"C1", "O1"}, 220);
    add_residue(atoms, {"MEMB", "POPC", "1", ""}, {"P", "C21"}, 230);
    add_residue(atoms, {"HETA", "LIG", "1", ""}, {"C1", "SH"}, 240);
    return atoms;
}

}  // namespace palpa::test
