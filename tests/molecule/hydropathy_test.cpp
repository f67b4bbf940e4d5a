#include "molecule/hydropathy.h"

#include <catch2/catch.hpp>
#include <string_view>

using namespace palpa;

TEST_CASE("hydropathy is the published index", "[molecule][hydropathy]") {
    // In one-letter order of the paper's table, from isoleucine to arginine.
    double least = 5, sum = 0;
    for (const std::string_view residue :
         {"ILE", "VAL", "LEU", "PHE", "CYS", "MET", "ALA", "GLY", "THR", "SER",
          "TRP", "TYR", "PRO", "HIS", "GLU", "GLN", "ASP", "ASN", "LYS", "ARG"}) {
        INFO(residue);
        REQUIRE(find_hydropathy(residue).has_value());
        CHECK(*find_hydropathy(residue) <= least);
        least = *find_hydropathy(residue);
        sum += least;
    }
    CHECK(find_hydropathy("ILE") == 4.5);
    CHECK(find_hydropathy("ARG") == -4.5);
    // GRAVY of one of each.
    CHECK(sum / 20 == Approx(-0.49));
}

TEST_CASE("states have their amino acid's hydropathy, others none", "[molecule][hydropathy]") {
    CHECK(find_hydropathy("HSP") == find_hydropathy("HIS"));
    CHECK(find_hydropathy("MSE") == find_hydropathy("MET"));
    CHECK(!find_hydropathy("TIP3"));
    CHECK(!find_hydropathy(""));
}
