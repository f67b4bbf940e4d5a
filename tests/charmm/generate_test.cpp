#include "charmm/generate.h"

#include "tests/support/force_field_of.h"
#include "tests/support/load_error_of.h"
#include "tests/support/structure_of.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;
using test::force_field_of;
using test::load_error_of;

namespace {

// A chain of beads A (with a cap H when it stands alone), rings, and what goes wrong.
constexpr std::string_view beads = R"(read rtf
MASS -1 TA 12.0 C
MASS -1 TB 14.0 N
MASS -1 TH 1.0 H
MASS -1 TS 32.0 S
DEFAULT FIRST CAP LAST NONE
AUTO ANGLES DIHE PATCH
RESI BEA 0.0
GROUP
ATOM A TA 0.1
ATOM B TB -0.2
GROUP
ATOM H TH 0.1
BOND A B  A H  B +A
IMPR A -B B H
CMAP -B A B +A  A B +A +B
RESI CYS 0.0
ATOM SG TS -0.1
ATOM HG1 TH 0.1
BOND SG HG1
PATCHING FIRST NONE
RESI TRI 0.0 NODIH
ATOM A TA 0.0
ATOM B TA 0.0
ATOM C TA 0.0
ATOM H TH 0.0
BOND A B B C C A A H
DIHE H A B C
PATCH FIRST NONE
RESI WAT 0.0 NOANG NODIH
ATOM O TB -0.2
ATOM H1 TH 0.1
ATOM H2 TH 0.1
BOND O H1 O H2 H1 H2
ANGLE H1 O H2
PATCH FIRST NONE
RESI LON 0.0
ATOM A TA 0.0
LONEPAIR COLINEAR LP A B
PATCH FIRST NONE
RESI BAD 0.0
ATOM A TX 0.0
BOND A Z
PATCH FIRST NONE
PRES CAP 1.0
ATOM B TA -0.1
ATOM C TH 0.9
DELETE ATOM H
BOND C A
PRES TOP 0.0
ATOM A TB 0.1
DELETE IMPR H B -B A
PRES DISU 0.0
ATOM 1SG TA 0.0
ATOM 2SG TA 0.0
DELETE ATOM 1HG1
DELETE ATOM 2HG1
BOND 1SG 2SG
END
)";

ForceField bead_force_field() { return force_field_of(beads); }

// All at the origin unless placed: bonds that are no matter of a test are short.
Structure structure_of(const std::vector<AtomName>& names) {
    Structure structure = test::structure_of(names);
    for (Vec3& position : structure.positions) position.setZero();
    return structure;
}

std::string error_of(const std::vector<AtomName>& names, const GenerateSettings& settings = {}) {
    return load_error_of(
        [&] { build_connectivity(bead_force_field(), structure_of(names), settings); });
}

const std::vector<AtomName> chain{{"P", "BEA", "1", "C"}, {"P", "BEA", "1", "B"},
                                  {"P", "BEA", "1", "A"}, {"P", "BEA", "2", "H"},
                                  {"P", "BEA", "2", "A"}, {"P", "BEA", "2", "B"}};

using Pair = std::array<std::uint32_t, 2>;

}  // namespace

TEST_CASE("a chain is bonded across its residues, in the order of the structure",
          "[charmm][generate]") {
    const Connectivity chained = build_connectivity(bead_force_field(), structure_of(chain));

    // The first residue's B and C have the numbers of its patch; its H is gone.
    CHECK(chained.type == std::vector<std::string>{"TH", "TA", "TA", "TH", "TA", "TB"});
    CHECK(chained.charge == std::vector<double>{0.9, -0.1, 0.1, 0.1, 0.1, -0.2});
    CHECK(chained.mass == std::vector<double>{1, 12, 12, 1, 12, 14});
    CHECK(chained.names[3].atom == "H");
    CHECK(chained.lines == std::vector<std::size_t>{1, 2, 3, 4, 5, 6});
    // A-B, B-A of the next; A-B, A-H; then the patch's C-A. The last B has no next.
    CHECK(chained.bonds == std::vector<Pair>{{2, 1}, {1, 4}, {4, 5}, {4, 3}, {0, 2}});
    // C-A-B, A-B-A', B-A'-H, B-A'-B', H-A'-B'
    CHECK(chained.angles.size() == 5);
    // C-A-B-A', A-B-A'-H, A-B-A'-B'
    CHECK(chained.dihedrals.size() == 3);
    // The first has neither -B nor H.
    CHECK(chained.impropers == std::vector<std::array<std::uint32_t, 4>>{{4, 1, 5, 3}});
    CHECK(chained.cmaps.empty());
}

TEST_CASE("cross-terms need both neighbours", "[charmm][generate]") {
    std::vector<AtomName> names = chain;
    for (const char* const atom : {"A", "B", "H"}) names.push_back({"P", "BEA", "3", atom});

    const Connectivity chained = build_connectivity(bead_force_field(), structure_of(names));

    CHECK(chained.cmaps == std::vector<std::array<std::uint32_t, 8>>{{1, 4, 5, 6, 4, 5, 6, 7}});
}

TEST_CASE("the ends of a chain can be named", "[charmm][generate]") {
    std::vector<AtomName> names = chain;
    names[0].atom = "H";

    const Connectivity chained =
        build_connectivity(bead_force_field(), structure_of(names),
                           {.segments = {{"P", "none", "top", true}}, .patches = {}});

    CHECK(chained.charge[0] == 0.1);
    CHECK(chained.type[4] == "TB");  // TOP
    CHECK(chained.impropers.empty());
    CHECK_THAT(error_of(names, {.segments = {{"P", "NONE", "CAPP", true}}, .patches = {}}),
               StartsWith("s.pdb:4: no patch 'CAPP' in a.rtf; did you mean 'CAP'?"));
    CHECK_THAT(error_of(names, {.segments = {{"Q", "NONE", "", true}, {"P", "NONE", "", true}},
                                .patches = {}}),
               StartsWith("s.pdb: no segment 'Q' (only P)"));
}

TEST_CASE("two CYS without HG1 are bonded where their sulphurs are near, or as named",
          "[charmm][generate]") {
    const std::vector<AtomName> names{{"P", "CYS", "1", "SG"}, {"Q", "CYS", "1", "SG"}};
    Structure structure = structure_of(names);
    structure.positions[1].x() = 2.05;

    SECTION("near") {
        const Connectivity bonded = build_connectivity(bead_force_field(), structure);
        CHECK(bonded.bonds == std::vector<Pair>{{0, 1}});
        CHECK(bonded.type == std::vector<std::string>{"TA", "TA"});
    }
    SECTION("too far apart, each lacks its hydrogen") {
        structure.positions[1].x() = 2.6;
        CHECK(load_error_of([&] { build_connectivity(bead_force_field(), structure); }) ==
              "s.pdb:1: residue P CYS 1 lacks atom 'HG1'; s.pdb:2: residue Q CYS 1 lacks atom "
              "'HG1'; `palpa prepare` adds atoms");
    }
    SECTION("named, as far apart as they may be") {
        structure.positions[1].x() = 2.9;
        const GenerateSettings settings{.segments = {},
                                        .patches = {{"DISU", {{"P", "1"}, {"Q", "1"}}}}};
        CHECK(build_connectivity(bead_force_field(), structure, settings).bonds.size() == 1);
    }
    SECTION("a third one within reach") {
        std::vector<AtomName> three = names;
        three.push_back({"R", "CYS", "1", "SG"});
        CHECK_THAT(error_of(three), Contains("has two disulphide bonds within 2.5 Å"));
    }
    SECTION("residues that are not there") {
        CHECK_THAT(
            error_of(names, {.segments = {}, .patches = {{"DISU", {{"P", "1"}, {"P", "7"}}}}}),
            StartsWith("s.pdb: no residue P 7 for patch DISU"));
        CHECK_THAT(error_of(names, {.segments = {}, .patches = {{"DISU", {{"P", "1"}}}}}),
                   Contains("patch 'DISU' names an atom '2SG', but is applied to 1 residues"));
    }
}

TEST_CASE("rings of three have angles but no dihedrals, and what is given stands",
          "[charmm][generate]") {
    const Connectivity ring =
        build_connectivity(bead_force_field(), structure_of({{"P", "TRI", "1", "A"},
                                                             {"P", "TRI", "1", "B"},
                                                             {"P", "TRI", "1", "C"},
                                                             {"P", "TRI", "1", "H"}}));

    CHECK(ring.angles.size() == 5);  // three at A, one each at B and C
    CHECK(ring.dihedrals == std::vector<std::array<std::uint32_t, 4>>{{3, 0, 1, 2}});
}

TEST_CASE("water has the angle that is given, and none from its third bond", "[charmm][generate]") {
    const Connectivity water =
        build_connectivity(bead_force_field(), structure_of({{"W", "WAT", "1", "H1"},
                                                             {"W", "WAT", "1", "O"},
                                                             {"W", "WAT", "1", "H2"},
                                                             {"W", "WAT", "2", "O"},
                                                             {"W", "WAT", "2", "H1"},
                                                             {"W", "WAT", "2", "H2"}}));

    CHECK(water.bonds.size() == 6);
    CHECK(water.angles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {4, 3, 5}});
    CHECK(water.dihedrals.empty());
}

TEST_CASE("a segment without generated terms has those that its residues give",
          "[charmm][generate]") {
    std::vector<AtomName> names = chain;
    names.push_back({"Q", "TRI", "1", "A"});
    for (const char* const atom : {"B", "C", "H"}) names.push_back({"Q", "TRI", "1", atom});

    const Connectivity connectivity = build_connectivity(
        bead_force_field(), structure_of(names),
        {.segments = {{"P", "", "", false}, {"Q", "", "", false}}, .patches = {}});

    CHECK(connectivity.angles.empty());
    CHECK(connectivity.dihedrals.size() == 1);
    CHECK(connectivity.type[0] == "TH");  // the patch by its template
}

TEST_CASE("all that is wrong with a structure is told at once", "[charmm][generate]") {
    CHECK(error_of({{"P", "BEE", "1", "A"}, {"P", "LON", "2", "A"}, {"P", "BEE", "1", "A"}}) ==
          "s.pdb:1: no residue 'BEE' in a.rtf; did you mean 'BEA'?; a.rtf:39: residue 'LON' has a "
          "lone pair, which is not supported; s.pdb:3: atom P BEE 1 A is repeated");
    std::vector<AtomName> names = chain;
    names[0].atom = "D";
    names[3].atom = "K";
    CHECK(error_of(names) ==
          "s.pdb:1: residue P BEA 1 with CAP has no atom 'D'; s.pdb:1: residue P BEA 1 with CAP "
          "lacks atom 'C'; s.pdb:4: residue P BEA 2 has no atom 'K'; s.pdb:4: residue P BEA 2 "
          "lacks atom 'H'; `palpa prepare` adds atoms");
    CHECK(error_of({{"P", "BAD", "1", "A"}}) ==
          "a.rtf:42: unknown atom type 'TX': no MASS line; did you mean 'TA'?; a.rtf:43: atom 'Z' "
          "in a term of residue 'BAD', which has no such ATOM line");
}

TEST_CASE("unknown residues, patches and wrong atoms are told in one error", "[charmm][generate]") {
    std::vector<AtomName> names = chain;
    names[3].atom = "K";
    names.push_back({"P", "BEE", "3", "A"});
    names.push_back({"Q", "TRI", "1", "A"});

    // Of TRI, whose patch there is not, nothing follows; nor of BEE.
    CHECK(error_of(names, {.segments = {{"Q", "TOPP", "", true}}, .patches = {}}) ==
          "s.pdb:7: no residue 'BEE' in a.rtf; did you mean 'BEA'?; s.pdb:8: no patch 'TOPP' in "
          "a.rtf; did you mean 'TOP'?; s.pdb:4: residue P BEA 2 has no atom 'K'; s.pdb:4: residue "
          "P BEA 2 lacks atom 'H'; `palpa prepare` adds atoms");
    // The patch may have been meant for the end of P.
    CHECK(error_of({{"P", "BEA", "1", "A"}}, {.segments = {{"R", "NONE", "", true}},
                                              .patches = {}}) == "s.pdb: no segment 'R' (only P)");
}

TEST_CASE("residues that CHARMM calls otherwise are told by its names", "[charmm][generate]") {
    CHECK_THAT(error_of({{"P", "HIS", "1", "N"}}),
               StartsWith("s.pdb:1: no residue 'HIS' in a.rtf; expected HSD, HSE or HSP (by its "
                          "hydrogens)"));
    CHECK_THAT(error_of({{"P", "ACE", "1", "C"}}),
               Contains("expected patch ACE on the residue after it"));
    CHECK_THAT(error_of({{"P", "NME", "1", "C"}}),
               Contains("expected patch CT3 on the residue before it"));
    CHECK_THAT(error_of({{"P", "HOH", "1", "O"}}), Contains("expected TIP3"));
}

TEST_CASE("atoms that may be called otherwise are told with what is lacking",
          "[charmm][generate]") {
    CHECK(error_of({{"W", "WAT", "1", "OW"}, {"W", "WAT", "1", "HW1"}, {"W", "WAT", "1", "H2"}}) ==
          "s.pdb:2: residue W WAT 1 has no atom 'HW1'; s.pdb:1: residue W WAT 1 has no atom 'OW'; "
          "s.pdb:1: residue W WAT 1 lacks atoms 'H1', 'O'; `palpa prepare` gives atoms CHARMM's "
          "names; `palpa prepare` adds atoms");
    // Here nothing is lacking that it could be.
    CHECK_THAT(
        error_of({{"P", "BEA", "1", "A"}, {"P", "BEA", "1", "B"}, {"P", "BEA", "1", "D"}},
                 {.segments = {{"P", "NONE", "", true}}, .patches = {}}),
        StartsWith("s.pdb:3: residue P BEA 1 has no atom 'D'") && !Contains("CHARMM's names"));
}

TEST_CASE("of many problems the first are named and all are kept", "[charmm][generate]") {
    std::vector<AtomName> names;
    for (int i = 1; i <= 11; ++i) {
        names.push_back({"W", "WAT", std::to_string(i), "H1"});
        names.push_back({"W", "WAT", std::to_string(i), "H2"});
    }
    try {
        build_connectivity(bead_force_field(), structure_of(names));
        FAIL("waters without oxygen are no waters");
    } catch (const LoadError& error) {
        CHECK_THAT(error.what(), StartsWith("s.pdb:1: residue W WAT 1 lacks atom 'O'; s.pdb:3: ") &&
                                     Contains("WAT 8 lacks") && !Contains("WAT 9 lacks") &&
                                     Contains("; and 3 more; `palpa prepare` adds atoms"));
        CHECK(error.further() ==
              std::vector<std::string>{"s.pdb:17: residue W WAT 9 lacks atom 'O'",
                                       "s.pdb:19: residue W WAT 10 lacks atom 'O'",
                                       "s.pdb:21: residue W WAT 11 lacks atom 'O'"});
    }
}

TEST_CASE("a TER line ends a chain", "[charmm][generate]") {
    std::vector<AtomName> names = chain;
    names[3].atom = "C";  // the second one is the first of a chain now
    Structure structure = structure_of(names);
    structure.chain_ends = {3, 6};

    const Connectivity parted = build_connectivity(bead_force_field(), structure);

    CHECK(parted.bonds == std::vector<Pair>{{2, 1}, {4, 5}, {0, 2}, {3, 4}});
    CHECK(parted.impropers.empty());
    CHECK(parted.type[3] == "TH");
    // One of another segment ends none of this.
    names[3].atom = "H";
    names.insert(names.begin() + 3, {"Q", "CYS", "1", "SG"});
    names.insert(names.begin() + 4, {"Q", "CYS", "1", "HG1"});
    structure = structure_of(names);
    structure.chain_ends = {5};
    CHECK(build_connectivity(bead_force_field(), structure).bonds.size() == 6);
}

TEST_CASE("a bond over a gap is told with both atoms", "[charmm][generate]") {
    Structure structure = structure_of(chain);
    for (std::size_t i = 3; i < 6; ++i) structure.positions[i].x() = 5.2;
    const auto error = [&](const GenerateSettings& settings = {}) {
        return load_error_of([&] { build_connectivity(bead_force_field(), structure, settings); });
    };

    SECTION("of a chain") {
        CHECK(error() ==
              "s.pdb:2: a bond of 5.2 Å from P BEA 1 B to P BEA 2 A of line 5; expected at most 3 "
              "Å: split the chain into two segments at a gap, or put a TER line there");
    }
    SECTION("of a residue") {
        structure.positions[5].x() = 0;
        CHECK_THAT(error(), Contains("from P BEA 2 A to P BEA 2 B of line 6; expected at most 3 Å: "
                                     "check the coordinates of this residue"));
    }
    SECTION("of a patch") {
        structure = structure_of({{"P", "CYS", "1", "SG"}, {"Q", "CYS", "1", "SG"}});
        structure.positions[1].x() = 3.1;
        CHECK_THAT(error({.segments = {}, .patches = {{"DISU", {{"P", "1"}, {"Q", "1"}}}}}),
                   StartsWith("s.pdb:1: a bond of 3.1 Å from P CYS 1 SG to Q CYS 1 SG of line 2") &&
                       Contains("apply a patch only to residues in contact"));
    }
    SECTION("not where a position is unknown") {
        structure.positions[4].setConstant(std::numeric_limits<double>::quiet_NaN());
        CHECK(error() == "no error");
    }
}

TEST_CASE("parameters alone hold no residues", "[charmm][generate]") {
    const ForceField force_field = force_field_of("BONDS\nA B 1.0 1.0\nEND\n", "a.prm");

    CHECK(load_error_of([&] { build_connectivity(force_field, structure_of(chain)); }) ==
          "s.pdb:1: no residues in a.prm; expected a topology file (.rtf) beside the parameters");
}

TEST_CASE("a template that names an atom it has not is told once, where it does",
          "[charmm][generate]") {
    ForceField force_field = bead_force_field();
    force_field.residues.at("BAD").atoms[0].type = "TA";

    CHECK(load_error_of([&] {
              build_connectivity(force_field,
                                 structure_of({{"P", "BAD", "1", "A"}, {"P", "BAD", "2", "A"}}));
          }) == "a.rtf:43: atom 'Z' in a term of residue 'BAD', which has no such ATOM line");
}
