// Any text is a molecule or a LoadError, as SDF and as MOL2; what was read has hydrogens, orders
// and surroundings.
#include "ligands/add_hydrogens.h"
#include "ligands/environments.h"
#include "ligands/perception.h"
#include "ligands/sdf.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/or_refused.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;

namespace {

void expect_molecule(const LigandFile& file) {
    const MoleculeGraph& graph = file.graph;
    PALPA_EXPECT(graph.size() > 0 && graph.size() <= most_ligand_atoms);
    PALPA_EXPECT(file.open_bonds.size() == graph.bonds.size());
    for (const GraphBond& bond : graph.bonds) {
        PALPA_EXPECT(bond.a < graph.size() && bond.b < graph.size() && bond.a != bond.b);
        PALPA_EXPECT(bond.order >= 1 && bond.order <= 3);
    }
    std::vector<std::string> notes;
    MoleculeGraph full = with_hydrogens(graph);
    charge_at_ph_7(full, notes);
    PALPA_EXPECT(find_environments(full, perceive(full)).size() == full.size());
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const auto file = test::or_refused([&] { return parse_sdf(text, "fuzz.sdf"); })) {
        expect_molecule(*file);
    }
    if (const auto file = test::or_refused([&] { return parse_mol2(text, "fuzz.mol2"); })) {
        expect_molecule(*file);
    }
    return 0;
}
