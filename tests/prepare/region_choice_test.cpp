#include "prepare/region_choice.h"

#include "tests/prepare/small_system.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace palpa;
using test::StructureWriter;

namespace {

// A cube of residues of one atom each, `edge` atoms long and `step` Å apart, the first in the hand,
// and a water in the middle of it, which does not count.
struct Crystal {
    Structure structure;
    std::vector<SystemSegment> segments;
    const std::vector<std::uint32_t> held{0};

    Crystal(int edge, double step) {
        StructureWriter writer;
        int number = 0;
        for (int x = 0; x < edge; ++x) {
            for (int y = 0; y < edge; ++y) {
                for (int z = 0; z < edge; ++z) {
                    writer.atom("ALA", "A", ++number, "CA", {step * x, step * y, step * z}, "C");
                }
            }
        }
        writer.atom("TIP3", "W", 1, "OH2", {1, 1, 1}, "O");
        structure = writer.structure();
        Connectivity connectivity;
        for (std::uint32_t i = 1; i + 1 < structure.names.size(); ++i) {
            connectivity.bonds.push_back({i - 1, i});
        }
        segments = find_segments(structure, connectivity);
    }

    std::size_t count_within(double angstrom) const {
        std::size_t count = 0;
        for (std::size_t i = 0; i + 1 < structure.names.size(); ++i) {
            if (structure.positions[i].norm() <= angstrom) ++count;
        }
        return count;
    }
};

}  // namespace

TEST_CASE("a region has the largest radius with no more than so many atoms", "[prepare][region]") {
    const Crystal crystal(20, 1.5);  // an eighth of a sphere around its corner
    REQUIRE(count_mobile_atoms(crystal.segments) == 8000);
    const RegionChoice region = choose_region(crystal.structure, crystal.segments, crystal.held);
    CHECK(region.angstrom == 28);
    CHECK(region.atoms == crystal.count_within(28));
    CHECK(region.atoms <= most_atoms_of_region);
    CHECK(crystal.count_within(32) > most_atoms_of_region);
}

TEST_CASE("where too many atoms are near, a region has its smallest radius", "[prepare][region]") {
    const Crystal crystal(20, 0.3);
    const RegionChoice region = choose_region(crystal.structure, crystal.segments, crystal.held);
    CHECK(region.angstrom == 8);
    CHECK(region.atoms == crystal.count_within(8));
}

TEST_CASE("a residue lies in a region as a whole", "[prepare][region]") {
    // Of 41 residues of 100 atoms, each at 1 to 100 Å, only the first is in the hand.
    StructureWriter writer;
    for (int i = 0; i < 41; ++i) {
        for (int j = 1; j <= 100; ++j) {
            writer.atom("LNG", "A", i + 1, "C" + std::to_string(j), {1.0 * j, 0.1 * i, 0}, "C");
        }
    }
    Connectivity connectivity;
    for (std::uint32_t i = 1; i < 4100; ++i) connectivity.bonds.push_back({i - 1, i});
    const std::vector<std::uint32_t> held{0};
    const RegionChoice region =
        choose_region(writer.structure(), find_segments(writer.structure(), connectivity), held);
    CHECK(region.angstrom == 8);
    CHECK(region.atoms == 4100);
}
