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
#include "tests/fuzz/expect_force_field.h"
#include "tests/fuzz/or_refused.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
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
    const test::ExpectedPlace place{"fuzz.str", 1, split_lines(text).size()};
    test::expect_force_field(*force_field, place);
    test::expect_packed(*force_field);
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
