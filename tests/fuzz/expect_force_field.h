// What every force field is that was read without an error.
#pragma once
#include "charmm/force_field.h"
#include "charmm/packed_force_field.h"
#include "core/text.h"
#include "tests/fuzz/expect.h"
#include "tests/support/same_force_field.h"

#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace palpa::test {

struct ExpectedPlace {
    std::string file;
    std::size_t first_line, last_line;
};

inline void expect_name(const std::string& name) {
    PALPA_EXPECT(!name.empty());
    PALPA_EXPECT(upper_case(name) == name);
    PALPA_EXPECT(name.find_first_of(" \t\r\n!") == std::string::npos);
}

inline void expect_place(const TextPlace& place, const ExpectedPlace& expected) {
    PALPA_EXPECT(place.file == expected.file);
    PALPA_EXPECT(place.line >= expected.first_line && place.line <= expected.last_line);
}

inline void expect_residue(const Residue& residue, const ExpectedPlace& expected) {
    expect_place(residue.place, expected);
    PALPA_EXPECT(std::isfinite(residue.charge));
    std::set<std::string> atoms;
    for (const ResidueAtom& atom : residue.atoms) {
        expect_name(atom.name);
        expect_name(atom.type);
        expect_place(atom.place, expected);
        PALPA_EXPECT(std::isfinite(atom.charge));
        PALPA_EXPECT(atoms.insert(atom.name).second);
    }
    for (const auto& bond : residue.bonds) {
        for (const std::string& name : bond) expect_name(name);
    }
    for (const auto& cmap : residue.cmaps) {
        for (const std::string& name : cmap) expect_name(name);
    }
    for (const InternalCoordinate& ic : residue.internal_coordinates) {
        for (const std::string& name : ic.atoms) expect_name(name);
        PALPA_EXPECT(std::isfinite(ic.first_bond) && std::isfinite(ic.dihedral_deg));
    }
}

inline void expect_terms(const std::vector<DihedralTerm>& terms, const ExpectedPlace& expected) {
    PALPA_EXPECT(!terms.empty());
    std::set<int> multiplicities;
    for (const DihedralTerm& term : terms) {
        expect_place(term.place, expected);
        PALPA_EXPECT(std::isfinite(term.k) && std::isfinite(term.phase_deg));
        PALPA_EXPECT(term.multiplicity >= 0 && term.multiplicity <= 12);
        PALPA_EXPECT(multiplicities.insert(term.multiplicity).second);
        PALPA_EXPECT(term.multiplicity > 0 || terms.size() == 1);
    }
}

inline void expect_force_field(const ForceField& force_field, const ExpectedPlace& expected) {
    for (const auto& [name, type] : force_field.types) {
        expect_name(name);
        expect_place(type.place, expected);
        PALPA_EXPECT(std::isfinite(type.mass) && type.mass >= 0);
    }
    for (const auto* residues : {&force_field.residues, &force_field.patches}) {
        for (const auto& [name, residue] : *residues) {
            expect_name(name);
            expect_residue(residue, expected);
        }
    }
    for (const auto& [name, type] : force_field.nonbonded) {
        expect_name(name);
        expect_place(type.place, expected);
        PALPA_EXPECT(std::isfinite(type.epsilon) && type.epsilon >= 0);
        PALPA_EXPECT(std::isfinite(type.half_rmin) && type.half_rmin >= 0);
    }
    for (const auto& [types, bond] : force_field.bonds) {
        PALPA_EXPECT(types.first <= types.second);
        PALPA_EXPECT(std::isfinite(bond.k) && std::isfinite(bond.value));
    }
    for (const auto& [types, angle] : force_field.angles) {
        PALPA_EXPECT(types[0] <= types[2]);
        PALPA_EXPECT(std::isfinite(angle.k) && std::isfinite(angle.value));
    }
    for (const auto* dihedrals : {&force_field.dihedrals, &force_field.impropers}) {
        for (const auto& [types, terms] : *dihedrals) {
            PALPA_EXPECT(in_order(types) == types);
            expect_terms(terms, expected);
        }
    }
    for (const auto& [types, map] : force_field.cmaps) {
        expect_place(map.place, expected);
        PALPA_EXPECT(map.energies.size() >= 4 && map.energies.size() <= 129600);
    }
    for (const auto& [types, pair] : force_field.nbfix) {
        PALPA_EXPECT(types.first <= types.second);
        expect_place(pair.place, expected);
        PALPA_EXPECT(std::isfinite(pair.epsilon) && pair.epsilon >= 0);
        PALPA_EXPECT(std::isfinite(pair.rmin) && pair.rmin >= 0);
    }
}

// Packing keeps all of it.
inline void expect_packed(const ForceField& force_field) {
    const std::string bytes = pack_force_field(force_field, std::vector<std::string>{"fuzz"});
    PALPA_EXPECT(is_same_force_field(unpack_force_field(bytes, "fuzz.ff"), force_field));
}

}  // namespace palpa::test
