#include "formats/psf.h"

#include "core/text.h"
#include "tests/support/load_error_of.h"
#include "tests/support/replaced.h"
#include "tests/support/shared_data.h"

#include <fmt/format.h>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;
using test::load_error_of;
using test::replaced;

namespace {

// Typed by hand after CHARMM's (I8,1X,A4,1X,A4,1X,A4,1X,A4,1X,I4,1X,2G14.6,I8): a hydroxyl and a
// water, types by number, the two more columns of CHEQ.
const std::string charmm = R"(PSF CMAP CHEQ

       1 !NTITLE
* A TITLE WITH AN EXCLAMATION MARK!

       5 !NATOM
       1 SOLV 1    MEOH O      73  -0.650000       15.9994           0   0.00000     -0.301140E-02
       2 SOLV 1    MEOH H      43   0.420000       1.00800           0   0.00000     -0.301140E-02
       3 SOLV 2A   TIP3 OH2    75  -0.834000       15.9994           0   0.00000     -0.301140E-02
       4 SOLV 2A   TIP3 H1      4   0.417000       1.00800           0   0.00000     -0.301140E-02
       5 SOLV 2A   TIP3 H2      4   0.417000       1.00800           0   0.00000     -0.301140E-02

       3 !NBOND: bonds
       1       2       3       4       3       5

       1 !NTHETA: angles
       4       3       5

       1 !NPHI: dihedrals
       1       2       3       4

       1 !NIMPHI: impropers
       5       4       3       2

       1 !NDON: donors
       1       2

       2 !NACC: acceptors
       1       0       3       0

       0 !NNB

       0       0       0       0       0

       2       0 !NGRP NST2
       0       1       0       2       2       0

       1 !MOLNT
       1       1       1       1       1

       0       0 !NUMLP NUMLPH

       1 !NCRTERM: cross-terms
       1       2       3       4       2       3       4       5
)";

// (I10,1X,A8,1X,A8,1X,A8,1X,A8,1X,A6,1X,2G14.6,I8), types by name.
const std::string extended = R"(PSF EXT XPLOR

         0 !NTITLE

         2 !NATOM
         1 PROTEINA 1        LIGAND   O58      OG2D1   -0.450000       15.9994           0
         2 PROTEINA 1        LIGAND   C81      CG2O6    0.450000       12.0110           0

         1 !NBOND: bonds
         1         2

         0 !NTHETA: angles


         0 !NPHI: dihedrals


         0 !NIMPHI: impropers


         0 !NDON: donors


         0 !NACC: acceptors


         0 !NNB

         0         0

         1         0 !NGRP NST2
         0         0         0
)";

// psfgen: fields wherever the blanks put them.
const std::string namd = R"(PSF NAMD

       1 !NTITLE
 REMARKS made for NAMD

       2 !NATOM
 1 A 1 SOD SOD SOD 1.0 22.9898 0
 2 A 2 CLA CLA CLA -1.0 35.45 0

       0 !NBOND: bonds
       0 !NTHETA: angles
       0 !NPHI: dihedrals
       0 !NIMPHI: impropers
       0 !NDON: donors
       0 !NACC: acceptors
       1 !NNB
       2
       1       1
       0       0 !NGRP
)";

std::string psf_error_of(const std::string& text) {
    return load_error_of([&] { parse_psf(text, "w.psf"); });
}

}  // namespace

TEST_CASE("CHARMM's own form is read with all its sections", "[formats][psf]") {
    const Connectivity connectivity = parse_psf(charmm, "w.psf");

    REQUIRE(connectivity.names.size() == 5);
    CHECK(to_string(connectivity.names[2]) == "SOLV TIP3 2A OH2");
    CHECK(connectivity.type == std::vector<std::string>{"73", "43", "75", "4", "4"});
    CHECK(connectivity.charge == std::vector<double>{-0.65, 0.42, -0.834, 0.417, 0.417});
    CHECK(connectivity.mass[1] == 1.008);
    CHECK(connectivity.lines == std::vector<std::size_t>{7, 8, 9, 10, 11});
    CHECK(connectivity.bonds == std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {2, 3}, {2, 4}});
    CHECK(connectivity.angles == std::vector<std::array<std::uint32_t, 3>>{{3, 2, 4}});
    CHECK(connectivity.dihedrals == std::vector<std::array<std::uint32_t, 4>>{{0, 1, 2, 3}});
    CHECK(connectivity.impropers == std::vector<std::array<std::uint32_t, 4>>{{4, 3, 2, 1}});
    CHECK(connectivity.cmaps ==
          std::vector<std::array<std::uint32_t, 8>>{{0, 1, 2, 3, 1, 2, 3, 4}});
}

TEST_CASE("the extended form and NAMD's are read", "[formats][psf]") {
    const Connectivity wide = parse_psf(extended, "w.psf");
    CHECK(to_string(wide.names[1]) == "PROTEINA LIGAND 1 C81");
    CHECK(wide.type[1] == "CG2O6");
    CHECK(wide.bonds.size() == 1);

    const Connectivity free = parse_psf(namd, "w.psf");
    CHECK(free.type == std::vector<std::string>{"SOD", "CLA"});
    CHECK(free.charge[1] == -1);
    CHECK(free.bonds.empty());
}

TEST_CASE("what is written reads the same", "[formats][psf]") {
    // The last one's numbers outgrow their columns.
    const std::array texts{charmm, extended, namd,
                           replaced(namd, "-1.0 35.45", "-123456789.5 3566666666666.5")};
    const std::size_t which = GENERATE(0U, 1U, 2U, 3U);
    const Connectivity connectivity = parse_psf(texts.at(which), "w.psf");

    const Connectivity back = parse_psf(format_psf(connectivity, "one\ntwo"), "back.psf");

    REQUIRE(back.names.size() == connectivity.names.size());
    for (std::size_t i = 0; i < back.names.size(); ++i) {
        CHECK(to_string(back.names[i]) == to_string(connectivity.names[i]));
    }
    CHECK(back.type == connectivity.type);
    CHECK(back.charge == connectivity.charge);
    CHECK(back.mass == connectivity.mass);
    CHECK(back.bonds == connectivity.bonds);
    CHECK(back.angles == connectivity.angles);
    CHECK(back.dihedrals == connectivity.dihedrals);
    CHECK(back.impropers == connectivity.impropers);
    CHECK(back.cmaps == connectivity.cmaps);
}

TEST_CASE("what is wrong in a PSF file is told with its line", "[formats][psf]") {
    struct Row {
        const char *old, *by, *error;
    };
    const auto row = GENERATE(values<Row>({
        {"PSF CMAP", "psf CMAP", "w.psf:1: is not a PSF file"},
        {"CHEQ", "DRUDE", "w.psf:1: the PSF format 'DRUDE' is not supported"},
        {"5 !NATOM", "0 !NATOM", "w.psf:6: the file has no atoms"},
        {"5 !NATOM", "6 !NATOM", "w.psf:12: ends after 5 of 6 atoms"},
        {"5 !NATOM", "4 !NATOM", "w.psf:11: '5 SOLV 2A"},
        {"5 !NATOM", "-5 !NATOM", "w.psf:6: '-5' is not a count"},
        {"5 !NATOM", "5 NATOM", "w.psf:6: '5 NATOM' is not the header"},
        {"       3 SOLV", "       4 SOLV", "w.psf:9: atom number 4; expected 3"},
        {"2A   TIP3 H2 ", "2A   TIP3 H1 ",
         "w.psf:11: atom SOLV TIP3 2A H1 is repeated, first on line 10"},
        {"-0.834000", "-0.83x000",
         "w.psf:9:36: '-0.83x000' is not a charge; expected a number, in e"},
        {"       15.9994 ", "      -15.9994 ", "w.psf:7:51: a mass of -15.9994"},
        {"MEOH O ", "     O ", "w.psf:7: 10 fields; expected the 9"},
        {"3 !NBOND", "4 !NBOND", "w.psf:15: ends after 6 of 8 numbers"},
        {"3 !NBOND", "2 !NBOND", "w.psf:14: more than the 4 numbers"},
        {"3 !NBOND", "999999999999999999 !NBOND", "more than the file holds"},
        {"       3       5\n\n       1 !NTHETA", "       3       6\n\n       1 !NTHETA",
         "w.psf:14: atom number 6; expected 1 to 5"},
        {"       3       5\n\n       1 !NTHETA", "       3       0\n\n       1 !NTHETA",
         "w.psf:14: atom number 0; expected 1 to 5"},
        {"       3       5\n\n       1 !NTHETA", "       5       5\n\n       1 !NTHETA",
         "w.psf:14: atom number 5 twice"},
        {"       3       5\n\n       1 !NTHETA", "       4       3\n\n       1 !NTHETA",
         "the bond between SOLV TIP3 2A H1 and SOLV TIP3 2A OH2 is listed twice"},
        {"!NTHETA", "!NBOND", "w.psf:16: section !NBOND is repeated, first on line 13"},
        {"1 !NPHI", "1 !NFOO", "w.psf:19: section !NFOO is not supported; expected it to be empty"},
        {"1       0       3       0", "1       0       3       x", "'x' is not a whole number"},
        {"0       0 !NUMLP", "1       0 !NUMLP",
         "section !NUMLP is not supported; expected it to be empty"},
        {"1 !NCRTERM", "0 !NUMOTHER", "is not the header of a section"},
    }));
    INFO(row.old << " -> " << row.by);

    CHECK_THAT(psf_error_of(replaced(charmm, row.old, row.by)), Contains(row.error));
}

TEST_CASE("a PSF file that is cut off anywhere is refused", "[formats][psf]") {
    // Without its last line end nothing is lost.
    for (std::size_t length = 0; length + 1 < charmm.size(); ++length) {
        const std::string error = psf_error_of(charmm.substr(0, length));
        // Of the last number any first digits are a number.
        if (length + 2 >= charmm.size()) continue;
        INFO(length);
        CHECK_THAT(error, StartsWith("w.psf:"));
    }
    CHECK_THAT(psf_error_of(""), StartsWith("w.psf:1: is not a PSF file"));
}

TEST_CASE("CHARMM's trialanine is read", "[formats][psf]") {
    const auto file = test::find_shared_data("data/energies/ala_ala_ala/ala_ala_ala.psf");
    if (!file) return;
    const Connectivity connectivity = read_psf(*file);

    CHECK(connectivity.names.size() == 33);
    CHECK(connectivity.bonds.size() == 32);
    CHECK(connectivity.angles.size() == 57);
    CHECK(connectivity.dihedrals.size() == 74);
    CHECK(connectivity.impropers.size() == 5);
    CHECK(connectivity.cmaps.size() == 1);
}
