// Any text is a CHARMM file or a LoadError; what was read is finite, and its residues get their
// numbers, their bonds and the terms of those, or another LoadError.
#include "charmm/assign.h"
#include "charmm/build_topology.h"
#include "charmm/complete.h"
#include "charmm/force_field.h"
#include "charmm/generate.h"
#include "core/load_error.h"
#include "core/text.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;

namespace {

std::optional<ForceField> read_or_refuse(std::string_view text) {
    return test::or_refused([&] {
        ForceField force_field;
        parse_force_field(text, "fuzz.str", force_field);
        return force_field;
    });
}

void expect_name(const std::string& name) {
    PALPA_EXPECT(!name.empty());
    PALPA_EXPECT(upper_case(name) == name);
    PALPA_EXPECT(name.find_first_of(" \t\r\n!") == std::string::npos);
}

void expect_place(const TextPlace& place, std::size_t line_count) {
    PALPA_EXPECT(place.file == "fuzz.str" && place.line >= 1 && place.line <= line_count);
}

void expect_residue(const Residue& residue, std::size_t line_count) {
    expect_place(residue.place, line_count);
    PALPA_EXPECT(std::isfinite(residue.charge));
    std::set<std::string> atoms;
    for (const ResidueAtom& atom : residue.atoms) {
        expect_name(atom.name);
        expect_name(atom.type);
        expect_place(atom.place, line_count);
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

void expect_terms(const std::vector<DihedralTerm>& terms, std::size_t line_count) {
    PALPA_EXPECT(!terms.empty());
    std::set<int> multiplicities;
    for (const DihedralTerm& term : terms) {
        expect_place(term.place, line_count);
        PALPA_EXPECT(std::isfinite(term.k) && std::isfinite(term.phase_deg));
        PALPA_EXPECT(term.multiplicity >= 0 && multiplicities.insert(term.multiplicity).second);
        PALPA_EXPECT(term.multiplicity > 0 || terms.size() == 1);
    }
}

void expect_consistent(const ForceField& force_field, std::size_t line_count) {
    for (const auto& [name, type] : force_field.types) {
        expect_name(name);
        expect_place(type.place, line_count);
        PALPA_EXPECT(std::isfinite(type.mass) && type.mass >= 0);
    }
    for (const auto* residues : {&force_field.residues, &force_field.patches}) {
        for (const auto& [name, residue] : *residues) {
            expect_name(name);
            expect_residue(residue, line_count);
        }
    }
    for (const auto& [name, type] : force_field.nonbonded) {
        expect_name(name);
        expect_place(type.place, line_count);
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
            expect_terms(terms, line_count);
        }
    }
    for (const auto& [types, map] : force_field.cmaps) {
        expect_place(map.place, line_count);
        PALPA_EXPECT(map.energies.size() >= 4 && map.energies.size() <= 129600);
    }
    for (const auto& [types, pair] : force_field.nbfix) {
        PALPA_EXPECT(types.first <= types.second);
        expect_place(pair.place, line_count);
        PALPA_EXPECT(std::isfinite(pair.epsilon) && pair.epsilon >= 0);
        PALPA_EXPECT(std::isfinite(pair.rmin) && pair.rmin >= 0);
    }
}

// One whole residue of each kind, all in one segment.
Structure one_of_each(const ForceField& force_field) {
    Structure structure;
    structure.file = "fuzz.crd";
    for (const auto& [name, residue] : force_field.residues) {
        for (const ResidueAtom& atom : residue.atoms) {
            structure.names.push_back({"A", name, "1", atom.name});
            structure.positions.push_back(Vec3::Zero());
            structure.lines.push_back(structure.names.size());
        }
    }
    return structure;
}

// Of every other atom the rest is found again, or refused; what is whole then has all of its lines.
void expect_completed(const ForceField& force_field, const Structure& whole) {
    Structure half;
    half.file = whole.file;
    for (std::size_t i = 0; i < whole.names.size(); i += 2) {
        half.names.push_back(whole.names[i]);
        half.positions.push_back(whole.positions[i]);
        half.lines.push_back(whole.lines[i]);
    }
    try {
        const CompletedStructure completed = add_missing_atoms(force_field, half);
        const std::size_t count = completed.structure.names.size();
        PALPA_EXPECT(count == half.names.size() + completed.added.size());
        for (const std::uint32_t atom : completed.added) PALPA_EXPECT(atom < count);
        for (const AtomCoordinate& line :
             find_internal_coordinates(force_field, completed.structure)) {
            for (const std::uint32_t atom : line.atoms) PALPA_EXPECT(atom < count);
        }
    } catch (const LoadError&) {
        return;
    }
}

// Chains of the residues in their order, so close that most bonds are short enough: with the
// patches that templates name and with none, of the atoms that are left or of all, and completed.
void expect_generated(const ForceField& force_field) {
    Structure structure = one_of_each(force_field);
    for (std::size_t i = 0; i < structure.positions.size(); ++i) {
        structure.positions[i].x() = 0.05 * static_cast<double>(i);
    }
    for (const bool is_patched : {false, true}) {
        GenerateSettings settings;
        if (!is_patched) settings.segments.push_back({"A", "NONE", "NONE", true});
        if (is_patched && !force_field.patches.empty() && !structure.names.empty()) {
            const AtomName& first = structure.names.front();
            const ResidueId residue{first.segment, first.number};
            settings.patches.push_back({force_field.patches.begin()->first, {residue, residue}});
        }
        try {
            const Connectivity connectivity = build_connectivity(force_field, structure, settings);
            PALPA_EXPECT(connectivity.type.size() == structure.names.size());
            const Topology topology = build_topology(connectivity, force_field);
            PALPA_EXPECT(topology.size() == structure.names.size());
            for (const Dihedral& dihedral : topology.dihedrals) {
                PALPA_EXPECT(dihedral.multiplicity > 0);
            }
        } catch (const LoadError&) {
            continue;
        }
    }
    expect_completed(force_field, structure);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const std::optional<ForceField> force_field = read_or_refuse(text);
    if (!force_field) return 0;
    expect_consistent(*force_field, split_lines(text).size());
    expect_generated(*force_field);

    const Structure structure = one_of_each(*force_field);
    AtomTable table;
    try {
        const AtomRange range = add_segment_atoms(*force_field, structure, "A", table);
        PALPA_EXPECT(range.first == 0 && range.count == structure.names.size());
    } catch (const LoadError&) {
        PALPA_EXPECT(table.size() == 0);
        return 0;
    }
    PALPA_EXPECT(table.size() == structure.names.size());
    for (std::size_t i = 0; i < table.size(); ++i) {
        PALPA_EXPECT(std::isfinite(table.mass[i]) && std::isfinite(table.charge[i]));
        PALPA_EXPECT(std::isfinite(table.sqrt_epsilon[i]) && std::isfinite(table.half_rmin[i]));
    }
    return 0;
}
