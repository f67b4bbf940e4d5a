// Any text has a residue's bonds, has none, or is a LoadError.
#include "ligands/chem_comp.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

using namespace palpa;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto found = test::or_refused([&] { return find_chem_comp(text, "fuzz.cif", "ACT"); });
    if (!found || !*found) return 0;
    const LigandFile& file = **found;
    PALPA_EXPECT(file.graph.size() <= most_ligand_atoms);
    PALPA_EXPECT(file.open_bonds.size() == file.graph.bonds.size());
    for (const GraphBond& bond : file.graph.bonds) {
        PALPA_EXPECT(bond.a < file.graph.size() && bond.b < file.graph.size() && bond.a != bond.b);
    }
    return 0;
}
