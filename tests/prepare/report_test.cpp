// Reports as a window shows them.
#include "prepare/report.h"

#include <catch2/catch.hpp>

using namespace palpa;

TEST_CASE("a window says nothing of options of the command line", "[prepare]") {
    CHECK(without_options("left out 127 waters (--keep-waters keeps them)") ==
          "left out 127 waters");
    CHECK(without_options("model 1 of 20 (--model N takes another)") == "model 1 of 20");
    CHECK(without_options("left out because only the crystal needed it: GOL A:301, GOL A:302 "
                          "(glycerol; --keep GOL keeps it)") ==
          "left out because only the crystal needed it: GOL A:301, GOL A:302 (glycerol)");
    CHECK(
        without_options("in the hand: the whole molecule C (it is the smallest molecule; to choose "
                        "another: --grab SEGMENT:RESIDUE or --grab SEGMENT)") ==
        "in the hand: the whole molecule C (it is the smallest molecule)");
    CHECK(without_options("A CYS 3 and A CYS 40: not bonded, SG 2.61 Å apart (to bond them: "
                          "--disulphide)") == "A CYS 3 and A CYS 40: not bonded, SG 2.61 Å apart");
    CHECK(without_options(
              "in the scene the emulated hand felt up to 0.10 N; expected 0.3 N at least: "
              "--grab takes something else into the hand") ==
          "in the scene the emulated hand felt up to 0.10 N; expected 0.3 N at least");
    CHECK(without_options("HIS 12 (A): neutral") == "HIS 12 (A): neutral");
    CHECK(without_options("all as it is") == "all as it is");
    CHECK(without_options("HIS 12 may be charged; to charge it: --protonation A:12=HSP") ==
          "HIS 12 may be charged");
    CHECK(without_options("lig.sdf: --ligand: matches none of the residues; expected the same "
                          "heavy atoms") ==
          "lig.sdf: matches none of the residues; expected the same heavy atoms");
    CHECK(without_options("a.pdb: --grab X: no such segment or residue") ==
          "a.pdb: no such segment or residue");
    CHECK(without_options("my--file.pdb: is empty") == "my--file.pdb: is empty");

    Report report;
    report.warn("one atom (--without A:1)");
    report.add("System", "two atoms (--no-ions); three");
    CHECK(report.to_plain_text() ==
          "Warnings: check these first\n  one atom\n\nSystem\n  two atoms; three\n\n");
}
