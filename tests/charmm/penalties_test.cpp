#include "charmm/penalties.h"

#include <catch2/catch.hpp>

using namespace palpa;

TEST_CASE("penalties stand in the comment of a residue's line", "[charmm][penalties]") {
    // The form of the CGenFF program's stream files.
    const auto found = find_penalties(
        "* Toppar stream file\n"
        "read rtf card append\n"
        "RESI LIG            0.000 ! param penalty=  45.500 ; charge penalty=  12.345\n"
        "GROUP            ! CHARGE   CH_PENALTY\n"
        "ATOM C1     CG2R61 -0.115 !    0.000\r\n"
        "RESI OTHR 0.00\n"
        "! RESI GONE 0.0 ! param penalty= 1 ; charge penalty= 2\n"
        "resi BAD 0 ! param penalty= high ; charge penalty= 2\n"
        "CG2R61 CG321 12.0 1.5 ! LIG , from CG2R61 CG331, penalty= 4\n");
    REQUIRE(found.size() == 1);
    CHECK(found[0].residue == "LIG");
    CHECK(found[0].parameters == 45.5);
    CHECK(found[0].charges == 12.345);
}
