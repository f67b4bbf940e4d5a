// What holds of every structure that a reader of PDB or mmCIF returns.
#pragma once
#include "formats/lines.h"
#include "molecule/atoms.h"
#include "molecule/element.h"
#include "tests/fuzz/expect.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace palpa::test {

inline void expect_whole(const Structure& structure) {
    const std::size_t count = structure.names.size();
    PALPA_EXPECT(count > 0);
    PALPA_EXPECT(structure.positions.size() == count && structure.lines.size() == count);
    PALPA_EXPECT(structure.records.size() == count);
    for (std::size_t i = 0; i < count; ++i) {
        const AtomName& name = structure.names[i];
        const AtomRecord& record = structure.records[i];
        PALPA_EXPECT(!name.residue.empty() && !name.number.empty() && !name.atom.empty());
        PALPA_EXPECT(structure.positions[i].cwiseAbs().maxCoeff() <= farthest_coordinate);
        PALPA_EXPECT(std::isfinite(record.occupancy) && std::isfinite(record.b_factor));
        PALPA_EXPECT(is_element(record.element));
        PALPA_EXPECT(structure.lines[i] >= (i == 0 ? 1 : structure.lines[i - 1]));
    }
    for (const SymmetryOperator& one : structure.operators) {
        PALPA_EXPECT(one.rotation.allFinite());
        PALPA_EXPECT(one.translation.cwiseAbs().maxCoeff() <= farthest_coordinate);
    }
    for (const Assembly& assembly : structure.assemblies) {
        for (const AssemblyPart& part : assembly.parts) {
            std::size_t copies = 1;
            for (const auto& list : part.operators) {
                copies *= list.size();
                for (const std::uint32_t i : list) PALPA_EXPECT(i < structure.operators.size());
            }
            PALPA_EXPECT(!part.operators.empty() && copies >= 1 && copies <= 1000);
        }
    }
    PALPA_EXPECT(structure.links.size() <= 100'000);
    for (const StructureLink& link : structure.links) {
        for (const LinkedAtom* const atom : {&link.a, &link.b}) {
            PALPA_EXPECT(is_name(atom->atom) && is_name(atom->residue) && !atom->number.empty());
        }
    }
    std::size_t last = 0;
    for (const std::size_t end : structure.chain_ends) {
        PALPA_EXPECT(end > last && end <= count);
        last = end;
    }
}

}  // namespace palpa::test
