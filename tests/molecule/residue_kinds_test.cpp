#include "molecule/residue_kinds.h"
#include "tests/molecule/select_system.h"

#include <catch2/catch.hpp>
#include <initializer_list>
#include <string>
#include <vector>

using namespace palpa;

namespace {

ResidueKind kind_of(const std::string& residue, std::initializer_list<const char*> names,
                    const std::string& element = "") {
    AtomTable atoms;
    const std::vector<AtomRange> residues{
        test::add_residue(atoms, {"A", residue, "1", ""}, names, 0, {}, element)};
    return find_residue_kinds(atoms, residues)[0];
}

}  // namespace

TEST_CASE("residues are what their atoms are, and their names where these do not decide",
          "[molecule][residue]") {
    CHECK(kind_of("HOH", {"O"}) == ResidueKind::Water);
    CHECK(kind_of("OPC", {"O", "H1", "H2"}) == ResidueKind::Water);
    CHECK(kind_of("OPC", {"O", "C1", "C2"}) == ResidueKind::Ligand);
    CHECK(kind_of("PEO", {"O1", "O2", "H1", "H2"}) == ResidueKind::Ligand);
    CHECK(kind_of("CLA", {"CLA"}, "CL") == ResidueKind::Ion);
    CHECK(kind_of("CLA", {"MG", "NA", "C1"}) == ResidueKind::Ligand);  // chlorophyll
    CHECK(kind_of("XE", {"XE"}, "XE") == ResidueKind::Ligand);
    CHECK(kind_of("ALA", {"CA"}) == ResidueKind::Protein);
    CHECK(kind_of("XYZ", {"N", "CA", "C", "O"}) == ResidueKind::Protein);
    CHECK(kind_of("ACE", {"CH3", "C", "O"}) == ResidueKind::Protein);
    CHECK(kind_of("DG", {"P"}) == ResidueKind::Nucleic);
    CHECK(kind_of("ATP", {"C1'", "C3'", "C4'", "C5'", "O4'", "O3'", "PA"}) == ResidueKind::Ligand);
    CHECK(kind_of("NAG", {"C1", "O5"}) == ResidueKind::Glycan);
    CHECK(kind_of("BMAN", {"C1", "O5"}) == ResidueKind::Glycan);
    CHECK(kind_of("CLR", {"C1"}) == ResidueKind::Lipid);
    CHECK(kind_of("CHL1", {"C1"}) == ResidueKind::Lipid);
    CHECK(kind_of("POPE", {"P"}) == ResidueKind::Lipid);
    CHECK(kind_of("PAPE", {"P"}) == ResidueKind::Lipid);
    CHECK(kind_of("ZZPE", {"P"}) == ResidueKind::Ligand);
    CHECK(kind_of("MK1", {"N1", "C1"}) == ResidueKind::Ligand);
}

TEST_CASE("a residue ends with its molecule and where its number or name changes",
          "[molecule][residue]") {
    AtomTable atoms;
    for (const auto& [name, number] : std::initializer_list<std::pair<const char*, const char*>>{
             {"LIG", "1"}, {"LIG", "1"}, {"LIG", "1A"}, {"LID", "1A"}})
        test::add_residue(atoms, {"A", name, number, ""}, {"C1"}, 0);
    const std::vector<AtomRange> molecules{{0, 1}, {1, 3}};

    const std::vector<AtomRange> residues = list_residues(atoms, molecules);

    REQUIRE(residues.size() == 4);
    CHECK(residues[0].count == 1);
    CHECK(residues[1].first == 1);
    CHECK(list_residues(atoms, std::vector<AtomRange>{{0, 4}}).size() == 3);
}
