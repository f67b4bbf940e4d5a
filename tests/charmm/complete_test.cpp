#include "charmm/complete.h"

#include "formats/crd.h"
#include "tests/support/force_field_of.h"
#include "tests/support/load_error_of.h"
#include "tests/support/native_case.h"
#include "tests/support/shared_data.h"
#include "tests/support/structure_of.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
using test::force_field_of;
using test::load_error_of;
using test::structure_of;

namespace {

// Beads of a chain, with a cap at its first one.
constexpr std::string_view beads = R"(MASS -1 TA 12.0 C
MASS -1 TH 1.0 H
DEFAULT FIRST CAP LAST NONE
RESI BEA 0.0
ATOM A TA 0.1
ATOM H TH -0.1
ATOM B TA 0.0
BOND A B  A H  B +A
IC -B A B +A 1.5 110.0 180.0 120.0 1.6
IC B -B *A H 1.5 109.0 -120.0 108.0 1.1
PRES CAP 0.0
DELETE ATOM H
ATOM A TA -0.1
ATOM H2 TH 0.0
ATOM H1 TH 0.1
BOND A H1 A H2
IC H1 A B +A 0.0 100.0 60.0 120.0 1.6
IC H A B +A 0.0 100.0 60.0 120.0 1.6
PRES TWO 0.0
IC 1A 1B 2A 2B 1.0 90.0 45.0 90.0 2.0
END
)";

ForceField bead_force_field() { return force_field_of(beads); }

std::vector<std::string> names_of(const Structure& structure) {
    std::vector<std::string> names;
    for (const AtomName& name : structure.names) names.push_back(to_string(name));
    return names;
}

bool is_unplaced(const Vec3& position) {
    return std::isnan(position.x()) && std::isnan(position.y()) && std::isnan(position.z());
}

const std::vector<AtomName> all{{"P", "BEA", "1", "A"},  {"P", "BEA", "1", "B"},
                                {"P", "BEA", "1", "H2"}, {"P", "BEA", "1", "H1"},
                                {"P", "BEA", "2", "A"},  {"P", "BEA", "2", "B"},
                                {"P", "BEA", "2", "H"}};

}  // namespace

TEST_CASE("what a residue lacks stands behind it, its template's before its patches'",
          "[charmm][complete]") {
    Structure given = structure_of({{"P", "BEA", "1", "B"}, {"P", "BEA", "2", "A"}});
    given.chain_ends = {2};
    given.records.resize(2);
    given.records[0].serial = 7;
    given.records[0].chain = "P";
    given.records[0].element = "N";

    const CompletedStructure completed = add_missing_atoms(bead_force_field(), given);

    CHECK(names_of(completed.structure) ==
          std::vector<std::string>{"P BEA 1 B", "P BEA 1 A", "P BEA 1 H2", "P BEA 1 H1",
                                   "P BEA 2 A", "P BEA 2 H", "P BEA 2 B"});
    CHECK(completed.added == std::vector<std::uint32_t>{1, 2, 3, 5, 6});
    for (std::uint32_t i = 0; i < 7; ++i) {
        const bool is_added = std::count(completed.added.begin(), completed.added.end(), i) > 0;
        CHECK(is_unplaced(completed.structure.positions[i]) == is_added);
    }
    CHECK(completed.structure.positions[4].x() == 1);
    CHECK(completed.structure.lines == std::vector<std::size_t>{1, 1, 1, 1, 2, 2, 2});
    CHECK(completed.structure.chain_ends == std::vector<std::size_t>{7});
    CHECK(completed.structure.records[1].chain == "P");
    CHECK(completed.structure.records[0].element == "N");
    CHECK(completed.structure.records[1].element == "C");
    CHECK(completed.structure.records[3].element == "H");
    CHECK(completed.structure.file == "s.pdb");
}

TEST_CASE("a whole structure stays as it is", "[charmm][complete]") {
    const CompletedStructure completed = add_missing_atoms(bead_force_field(), structure_of(all));

    CHECK(completed.added.empty());
    CHECK(names_of(completed.structure) == names_of(structure_of(all)));
    CHECK(completed.structure.records.empty());
}

TEST_CASE("an atom whose own name begins with a sign is its residue's", "[charmm][complete]") {
    const ForceField force_field =
        force_field_of("MASS 1 T 1.0 H\nRESI A 0.0\nATOM X T 0.0\nATOM +Y T 0.0\nEND\n");

    const CompletedStructure completed =
        add_missing_atoms(force_field, structure_of({{"P", "A", "1", "X"}}));

    CHECK(names_of(completed.structure) == std::vector<std::string>{"P A 1 X", "P A 1 +Y"});
}

TEST_CASE("completing refuses atoms and residues that there are not", "[charmm][complete]") {
    CHECK(load_error_of([] {
              add_missing_atoms(bead_force_field(), structure_of({{"P", "BEA", "1", "A"},
                                                                  {"P", "BEA", "1", "H"},
                                                                  {"P", "BEE", "2", "A"}}));
          }) ==
          "s.pdb:3: no residue 'BEE' in a.rtf; did you mean 'BEA'?; s.pdb:2: residue P BEA 1 with "
          "CAP has no atom 'H'");
}

TEST_CASE("internal coordinates find their atoms, patches' first", "[charmm][complete]") {
    const auto coordinates =
        find_internal_coordinates(bead_force_field(), structure_of(all),
                                  {.segments = {}, .patches = {{"TWO", {{"P", "2"}, {"P", "1"}}}}});

    // CAP's second line names an atom that is gone, and so does each line of BEA over an end.
    REQUIRE(coordinates.size() == 3);
    CHECK(coordinates[0].atoms == std::array<std::uint32_t, 4>{3, 0, 1, 4});
    CHECK_FALSE(coordinates[0].is_improper);
    CHECK(coordinates[0].first_bond == 0);
    CHECK(coordinates[0].dihedral == Approx(std::numbers::pi / 3));
    CHECK(coordinates[1].atoms == std::array<std::uint32_t, 4>{4, 5, 0, 1});
    CHECK(coordinates[2].atoms == std::array<std::uint32_t, 4>{5, 1, 4, 6});
    CHECK(coordinates[2].is_improper);
    CHECK(coordinates[2].first_bond == 1.5);
    CHECK(coordinates[2].first_angle == Approx(109 * std::numbers::pi / 180));
    CHECK(coordinates[2].dihedral == Approx(-2 * std::numbers::pi / 3));
    CHECK(coordinates[2].last_angle == Approx(0.6 * std::numbers::pi));
    CHECK(coordinates[2].last_bond == 1.1);
}

TEST_CASE("the chain goes on with what '+' names", "[charmm][complete]") {
    std::vector<AtomName> names = all;
    for (const char* const atom : {"A", "B", "H"}) names.push_back({"P", "BEA", "3", atom});

    const auto coordinates = find_internal_coordinates(bead_force_field(), structure_of(names));

    // CAP's, then both of residue 2, then that of residue 3 without '+'.
    REQUIRE(coordinates.size() == 4);
    CHECK(coordinates[1].atoms == std::array<std::uint32_t, 4>{1, 4, 5, 7});
    CHECK(coordinates[3].atoms == std::array<std::uint32_t, 4>{8, 5, 7, 9});
}

TEST_CASE("crambin gets back all of its hydrogens", "[charmm][complete]") {
    const auto charmm = test::find_shared_data("data/charmm");
    const auto energies = test::find_shared_data("data/energies");
    if (!charmm || !energies) return;
    const ForceField force_field =
        test::read_charmm(*charmm, {"top_all36_prot.rtf", "par_all36m_prot.prm"});
    const Structure full = read_crd(*energies / "crambin_c36m.crd");
    Structure heavy{.file = full.file, .names = {}, .positions = {}, .lines = {}};
    for (std::size_t i = 0; i < full.names.size(); ++i) {
        if (full.names[i].atom.starts_with('H')) continue;
        heavy.names.push_back(full.names[i]);
        heavy.positions.push_back(full.positions[i]);
        heavy.lines.push_back(full.lines[i]);
    }
    REQUIRE(heavy.names.size() == 327);

    const CompletedStructure completed = add_missing_atoms(force_field, heavy);

    CHECK(completed.structure.names.size() == 642);
    CHECK(completed.added.size() == 642 - 327);
    const std::vector<std::string> ours = names_of(completed.structure), theirs = names_of(full);
    CHECK(std::set(ours.begin(), ours.end()) == std::set(theirs.begin(), theirs.end()));
    // Three disulphides among them: nothing has the hydrogens of free cysteines.
    const Connectivity connectivity = build_connectivity(force_field, completed.structure);
    CHECK(connectivity.bonds.size() == 652);
    CHECK(connectivity.angles.size() == 1183);
    CHECK(connectivity.dihedrals.size() == 1747);
    CHECK(connectivity.impropers.size() == 111);
    CHECK(connectivity.cmaps.size() == 44);

    // A line for every added atom, at its end or at its beginning.
    std::set<std::uint32_t> ends;
    for (const AtomCoordinate& line : find_internal_coordinates(force_field, completed.structure)) {
        ends.insert({line.atoms.front(), line.atoms.back()});
    }
    for (const std::uint32_t atom : completed.added) {
        INFO(ours[atom]);
        CHECK(ends.contains(atom));
    }
}
