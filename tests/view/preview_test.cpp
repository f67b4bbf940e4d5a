// The picture of a structure before it is prepared.
#include "view/preview.h"

#include "formats/pdb.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

using namespace palpa;

namespace {

// Four residues of a chain, a calcium, a ligand of two atoms in two locations, a water.
constexpr const char* file =
    "ATOM      1  N   GLY A   1       0.000   0.000   0.000  1.00  0.00           N\n"
    "ATOM      2  CA  GLY A   1       1.500   0.000   0.000  1.00  0.00           C\n"
    "ATOM      3  N   ALA A   2       3.000   1.000   0.000  1.00  0.00           N\n"
    "ATOM      4  CA  ALA A   2       5.200   0.500   0.000  1.00  0.00           C\n"
    "ATOM      5  HA  ALA A   2       5.900   0.000   0.000  1.00  0.00           H\n"
    "ATOM      6  CA  ALA A   3       5.200   4.000   0.000  1.00  0.00           C\n"
    "ATOM      7  CA  ALA A   4       5.200   8.000   0.000  1.00  0.00           C\n"
    "TER       8      ALA A   4\n"
    "HETATM    7 CA    CA B   1      20.000   0.000   0.000  1.00  0.00          CA\n"
    "HETATM    8  C1 AXYZ B   2      10.000   0.000   0.000  0.50  0.00           C\n"
    "HETATM    9  C1 BXYZ B   2      10.200   0.000   0.000  0.50  0.00           C\n"
    "HETATM   10  O1  XYZ B   2      11.300   0.000   0.000  1.00  0.00           O\n"
    "HETATM   11  O   HOH B   3      15.000   0.000   0.000  1.00  0.00           O\n"
    "END\n";

bool has_ball(const FrameScene& frame, float x) {
    return std::ranges::any_of(frame.spheres, [&](const SphereShape& ball) {
        return std::abs(ball.centre.x - x) < 1e-4F;
    });
}

}  // namespace

TEST_CASE("a chain is its trace, all else balls and sticks, without waters and hydrogens",
          "[view][preview]") {
    const Structure structure = parse_pdb(file, "test.pdb");
    const FrameScene frame = build_preview(structure);

    CHECK(frame.spheres.size() == 7);
    for (const float x : {1.5F, 5.2F, 20.0F, 10.0F, 11.3F}) CHECK(has_ball(frame, x));
    // Three steps along the chain, one bond of the ligand.
    std::size_t steps = 0, bonds = 0;
    for (const ConeShape& stick : frame.cones) {
        const float from = std::min(stick.a.x, stick.b.x);
        steps += from < 6;
        bonds += from > 9;
    }
    CHECK(steps == 3);
    CHECK(bonds == 1);

    const FrameScene marked = build_preview(structure, std::vector<std::uint32_t>{0});
    CHECK(marked.spheres.size() == 8);
    CHECK(has_ball(marked, 0));
}

TEST_CASE("a chain of few residues is balls and sticks", "[view][preview]") {
    const Structure structure = parse_pdb(
        "ATOM      1  N   GLY A   1       0.000   0.000   0.000  1.00  0.00           N\n"
        "ATOM      2  CA  GLY A   1       1.500   0.000   0.000  1.00  0.00           C\n"
        "ATOM      3  C   GLY A   1       2.200   1.300   0.000  1.00  0.00           C\n"
        "ATOM      4  N   GLY A   2       3.500   1.300   0.000  1.00  0.00           N\n"
        "END\n",
        "test.pdb");
    const FrameScene frame = build_preview(structure);
    CHECK(frame.spheres.size() == 4);
    CHECK(frame.cones.size() == 3);  // the peptide bond too
}
