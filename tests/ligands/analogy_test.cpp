#include "ligands/analogy.h"

#include "charmm/find_parameters.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// Methane, methanol and ethene in types of CGenFF's kind, with all that their terms need.
ForceField small() {
    ForceField force_field;
    parse_force_field(
        "* by hand\n*\n36 1\n"
        "MASS -1 CG331 12.011 C\nMASS -1 CG2D2 12.011 C\nMASS -1 OG311 15.999 O\n"
        "MASS -1 HGA3 1.008 H\nMASS -1 HGA5 1.008 H\nMASS -1 HGP1 1.008 H\nMASS -1 CG302 12.011 C\n"
        "MASS -1 FGA3 18.998 F\n"
        "AUTO ANGLES DIHE\n"
        "RESI MEOH 0.0\nGROUP\nATOM C CG331 -0.04\nATOM O OG311 -0.65\nATOM HO HGP1 0.42\n"
        "ATOM H1 HGA3 0.09\nATOM H2 HGA3 0.09\nATOM H3 HGA3 0.09\n"
        "BOND C O O HO C H1 C H2 C H3\n"
        "RESI TFMO 0.0\nGROUP\nATOM C CG302 0.5\nATOM O OG311 -0.65\nATOM HO HGP1 0.42\n"
        "ATOM F1 FGA3 -0.09\nATOM F2 FGA3 -0.09\nATOM F3 FGA3 -0.09\n"
        "BOND C O O HO C F1 C F2 C F3\n"
        "RESI ETHE 0.0\nGROUP\nATOM C1 CG2D2 -0.42\nATOM C2 CG2D2 -0.42\nATOM H1 HGA5 0.21\n"
        "ATOM H2 HGA5 0.21\nATOM H3 HGA5 0.21\nATOM H4 HGA5 0.21\n"
        "BOND C1 C2 C1 H1 C1 H2 C2 H3 C2 H4\n"
        "END\n",
        "small.rtf", force_field);
    parse_force_field(
        "* by hand\n*\n"
        "BONDS\nCG331 OG311 428.0 1.42\nCG2D2 CG2D2 500.0 1.33\nCG331 HGA3 322.0 1.11\n"
        "END\n",
        "small.prm", force_field);
    return force_field;
}

}  // namespace

TEST_CASE("types of one element and as many neighbours are nearest", "[ligands][analogy]") {
    const TypeDistances distances(find_model_compounds(small()));

    CHECK(distances.between("CG331", "CG331") == 0);
    CHECK(distances.between("CG302", "CG331") < distances.between("CG302", "CG2D2"));
    CHECK(distances.between("CG302", "CG2D2") < distances.between("CG302", "OG311"));
    CHECK(distances.between("CG302", "HGA3") >= TypeDistances::unlike);
    CHECK(distances.between("CG302", "OG311") == distances.between("OG311", "CG302"));
    CHECK(distances.between("CG302", "CT1") >= TypeDistances::unlike);
}

TEST_CASE("a missing bond takes the numbers of the most alike one", "[ligands][analogy]") {
    ForceField force_field = small();
    const TypeDistances distances(find_model_compounds(force_field));
    ResidueTerms terms;
    terms.bonds = {{0, 1}, {2, 3}};

    const std::vector<Analogy> made =
        add_missing_parameters(terms, {"CG302", "OG311", "CG331", "OG311"}, distances, force_field);

    REQUIRE(made.size() == 1);  // the other is there
    CHECK(made[0].from == std::vector<std::string>{"CG331", "OG311"});
    CHECK(made[0].penalty == Approx(distances.between("CG302", "CG331")));
    const HarmonicParameter* const bond = find_bond(force_field, {"OG311", "CG302"});
    REQUIRE(bond);
    CHECK(bond->k == 428);
    CHECK(bond->value == 1.42);
}

TEST_CASE("a bond of hydrogen is no likeness of one of fluorine", "[ligands][analogy]") {
    ForceField force_field = small();
    const TypeDistances distances(find_model_compounds(force_field));
    force_field.bonds.erase(in_order("CG331", "OG311"));
    force_field.bonds.erase(in_order("CG2D2", "CG2D2"));
    ResidueTerms terms;
    terms.bonds = {{0, 1}};

    CHECK(add_missing_parameters(terms, {"CG302", "FGA3"}, distances, force_field).empty());
    CHECK_FALSE(find_bond(force_field, {"CG302", "FGA3"}));
}

TEST_CASE("a residue's bonds make its angles and dihedrals", "[ligands][analogy]") {
    const auto compound = find_model_compound(small(), "MEOH");
    REQUIRE(compound);

    const ResidueTerms terms = find_terms(compound->graph, {});

    // By hand: CH3-OH has 5 bonds, 6 angles at C, 1 at O, and 3 dihedrals.
    CHECK(terms.bonds.size() == 5);
    CHECK(terms.angles.size() == 7);
    CHECK(terms.dihedrals.size() == 3);
}
