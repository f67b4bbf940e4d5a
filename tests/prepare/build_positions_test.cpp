#include "prepare/build_positions.h"

#include "formats/pdb.h"
#include "tests/prepare/molecules.h"
#include "tests/support/shared_data.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

using namespace palpa;
using namespace palpa::test;
namespace fs = std::filesystem;

namespace {

// C between two others at right angles, along x and y.
struct Methylene : Molecule {
    std::uint32_t c = add(carbon, Vec3::Zero());
    std::uint32_t x = add(carbon, {1.5, 0, 0}), y = add(carbon, {0, 1.5, 0});
    std::uint32_t h1 = add(hydrogen), h2 = add(hydrogen);

    Methylene() {
        bond(c, x, 1.5);
        bond(c, y, 1.5);
        bond(c, h1, 1.11);
        bond(c, h2, 1.11);
        angle(h1, c, h2, 109);
    }
};

}  // namespace

TEST_CASE("the hydrogens of a CH2 stand across from its neighbours, named by the table",
          "[prepare][positions]") {
    Methylene molecule;
    const auto [c, x, y, h1, h2] =
        std::array{molecule.c, molecule.x, molecule.y, molecule.h1, molecule.h2};
    const double sign = GENERATE(1.0, -1.0);
    // As CHARMM has it of a side chain: IC Y X *C H1 ... 120, and H2 at -120.
    const auto built = molecule.build({dihedral_line({y, x, c, h1}, sign * 120, true),
                                       dihedral_line({y, x, c, h2}, -sign * 120, true)});

    CHECK(built.unplaced.empty());
    REQUIRE(built.placed.size() == 2);
    CHECK(built.placed[0].by == PlacedBy::Neighbours);
    // By hand: bisector -(1, 1, 0)/sqrt 2, and half of 109 degree to either side along z.
    const double across = 1.11 * std::cos(54.5 * degree) / std::sqrt(2.0);
    const double up = 1.11 * std::sin(54.5 * degree);
    CHECK(molecule.positions[h1].x() == Approx(-across));
    CHECK(molecule.positions[h1].y() == Approx(-across));
    CHECK(std::abs(molecule.positions[h1].z()) == Approx(up));
    CHECK(molecule.positions[h2].z() == Approx(-molecule.positions[h1].z()));
    CHECK(molecule.dihedral_deg(y, x, c, h1) * sign > 90);
    CHECK(molecule.length(c, h1) == Approx(1.11).epsilon(1e-12));
    CHECK(molecule.angle_deg(h1, c, h2) == Approx(109).epsilon(1e-12));
}

TEST_CASE("a planar N-H lies in the plane, its two angles apart as the parameters' are",
          "[prepare][positions]") {
    Molecule molecule;
    const std::uint32_t n = molecule.add(nitrogen, Vec3::Zero());
    const std::uint32_t c = molecule.add(carbon, {1.3, 0, 0});
    const std::uint32_t ca =
        molecule.add(carbon, {1.45 * std::cos(124 * degree), 1.45 * std::sin(124 * degree), 0});
    const std::uint32_t h = molecule.add(hydrogen);
    molecule.bond(n, c, 1.345);
    molecule.bond(n, ca, 1.43);
    molecule.bond(n, h, 0.997);
    molecule.angle(c, n, ca, 120);
    molecule.angle(c, n, h, 123);
    molecule.angle(ca, n, h, 117);

    molecule.build();

    // 236 degree are left: 121 and 115, 6 apart.
    CHECK(molecule.positions[h].z() == Approx(0).margin(1e-12));
    CHECK(molecule.angle_deg(c, n, h) == Approx(121));
    CHECK(molecule.angle_deg(ca, n, h) == Approx(115));
    CHECK(molecule.length(n, h) == Approx(0.997).epsilon(1e-12));
}

TEST_CASE("a water's hydrogens have its lengths and angle", "[prepare][positions]") {
    Molecule molecule;
    const std::uint32_t o = molecule.add(oxygen, {1, 2, 3});
    const std::uint32_t h1 = molecule.add(hydrogen), h2 = molecule.add(hydrogen);
    molecule.bond(o, h1, 0.9572);
    molecule.bond(o, h2, 0.9572);
    molecule.bond(h1, h2, 1.5139);  // as TIP3P has it
    molecule.angle(h1, o, h2, 104.52);

    const BuiltPositions built = molecule.build();

    CHECK(built.unplaced.empty());
    CHECK(molecule.length(o, h1) == Approx(0.9572));
    CHECK(molecule.length(o, h2) == Approx(0.9572));
    CHECK(molecule.angle_deg(h1, o, h2) == Approx(104.52));
}

TEST_CASE("methane from its carbon alone is a tetrahedron", "[prepare][positions]") {
    Molecule molecule;
    const std::uint32_t c = molecule.add(carbon, Vec3::Zero());
    for (int i = 0; i < 4; ++i) molecule.bond(c, molecule.add(hydrogen), 1.1);

    CHECK(molecule.build().unplaced.empty());
    for (std::uint32_t a = 1; a <= 4; ++a) {
        for (std::uint32_t b = a + 1; b <= 4; ++b) {
            CHECK(molecule.angle_deg(a, c, b) ==
                  Approx(std::acos(-1.0 / 3) / degree).epsilon(1e-6));
        }
    }
}

TEST_CASE(
    "a line of the table places its last atom from the first three, and its first from the "
    "last",
    "[prepare][positions]") {
    Molecule molecule;
    const std::uint32_t a = molecule.add(carbon, {0, 1, 0}), b = molecule.add(carbon, {0, 0, 0});
    const std::uint32_t c = molecule.add(carbon, {0, 0, 1.5});
    const std::uint32_t d = molecule.add(oxygen), h = molecule.add(hydrogen);
    molecule.bond(a, b, 1);
    molecule.bond(b, c, 1.5);
    molecule.bond(c, d, 1.4);
    molecule.bond(d, h, 0.96);
    molecule.angle(b, c, d, 110);
    molecule.angle(c, d, h, 106);
    const bool is_reversed = GENERATE(false, true);
    auto lines = std::vector{dihedral_line({a, b, c, d}, 70), dihedral_line({b, c, d, h}, -50)};
    if (is_reversed) {
        lines = {dihedral_line({d, c, b, a}, 70), dihedral_line({h, d, c, b}, -50)};
    }

    const BuiltPositions built = molecule.build(lines);

    REQUIRE(built.placed.size() == 2);
    CHECK(built.placed[0].by == PlacedBy::Table);
    CHECK(molecule.dihedral_deg(a, b, c, d) == Approx(70));
    CHECK(molecule.dihedral_deg(b, c, d, h) == Approx(-50));
    CHECK(molecule.angle_deg(b, c, d) == Approx(110));
    CHECK(molecule.length(c, d) == Approx(1.4));
}

TEST_CASE("a heavy atom that its line has upon another one is staggered the other way",
          "[prepare][positions]") {
    Molecule molecule;
    const std::uint32_t a = molecule.add(carbon, {1.5, 0, 0}), b = molecule.add(carbon, {0, 0, 0});
    const std::uint32_t c = molecule.add(carbon, {0, 0, 1.5}), d = molecule.add(carbon);
    molecule.bond(a, b, 1.5);
    molecule.bond(b, c, 1.5);
    molecule.bond(c, d, 1.5);
    molecule.angle(b, c, d, 110);
    const bool is_blocked = GENERATE(false, true);
    const double side = GENERATE(1.0, -1.0);
    // At 180 degree the fourth would be at (-1.41, 0, 2.01).
    if (is_blocked) molecule.add(carbon, {-1.5, 0.3 * side, 2.5});

    molecule.build({dihedral_line({a, b, c, d}, 180)});

    const double found = molecule.dihedral_deg(a, b, c, d);
    if (is_blocked) {
        CHECK(std::abs(found) == Approx(60));
        CHECK(molecule.positions[d].y() * side < 0);  // away from it
    } else {
        CHECK(std::abs(found) == Approx(180));
    }
}

TEST_CASE(
    "atoms without a placed neighbour are reported, the others have finite places however the "
    "given "
    "atoms lie",
    "[prepare][positions]") {
    // A CH2, an NH and a CH3 between neighbours in line, and at one place.
    const Vec3 second = GENERATE(Vec3(-1.5, 0, 0), Vec3(1.5, 0, 0), Vec3(0, 0, 0));
    const std::size_t hydrogens = GENERATE(1U, 2U, 3U);
    Molecule molecule;
    const std::uint32_t x = molecule.add(carbon, {1.5, 0, 0}), c = molecule.add(carbon, {0, 0, 0});
    const std::uint32_t y = molecule.add(carbon, second);
    molecule.bond(x, c, 1.5);
    molecule.bond(hydrogens == 3 ? x : c, y, 1.5);
    for (std::size_t i = 0; i < hydrogens; ++i) molecule.bond(c, molecule.add(hydrogen), 1.1);
    const std::uint32_t alone = molecule.add(carbon), other = molecule.add(carbon);
    molecule.bond(alone, other, 1.5);

    const BuiltPositions built = molecule.build();

    CHECK(built.unplaced == std::vector<std::uint32_t>{alone, other});
    for (std::uint32_t atom = 0; atom < alone; ++atom) {
        CHECK(molecule.positions[atom].allFinite());
        if (atom > y) CHECK(molecule.length(c, atom) == Approx(1.1));
    }
}

// Not those with Gly or Pro, whose pairs the files have the other way round than the table.
TEST_CASE("hydrogens of tetrapeptides that CHARMM built stand where it has them, by name",
          "[prepare][positions][native]") {
    const auto folder = find_shared_data("data/energies/eef1sb/tetra");
    if (!folder) return;
    const fs::path charmm = folder->parent_path().parent_path().parent_path() / "charmm";
    int compared = 0;
    double sum = 0;
    for (const char* const name : {"aaaa", "aama", "aasa", "aava", "acca", "adka", "aera", "afya",
                                   "aiia", "aiya", "akka", "amwa", "anqa", "aqka", "atia"}) {
        const Structure structure = read_pdb(*folder / fmt::format("{}.pdb", name));
        const Typed typed = type(charmm, structure);
        const auto neighbours = neighbours_of(typed.connectivity);
        std::vector<Vec3> positions = structure.positions;
        for (std::uint32_t i = 0; i < positions.size(); ++i) {
            if (is_hydrogen(typed.connectivity, i)) positions[i] = nowhere;
        }

        build_positions(typed.connectivity, typed.topology, typed.coordinates, positions);

        for (std::uint32_t i = 0; i < positions.size(); ++i) {
            if (!is_hydrogen(typed.connectivity, i)) continue;
            const auto& around = neighbours[neighbours[i][0]];
            const auto heavies = std::count_if(around.begin(), around.end(), [&](std::uint32_t j) {
                return !is_hydrogen(typed.connectivity, j);
            });
            if (heavies < 2) continue;
            INFO(name << " " << to_string(structure.names[i]));
            const double error = (positions[i] - structure.positions[i]).norm();
            CHECK(error < 0.5);  // a name of the other hydrogen would be 1.8 Å away
            sum += error * error;
            ++compared;
        }
    }
    REQUIRE(compared > 50);
    std::cout << fmt::format("{} hydrogens of tetrapeptides, rms {:.3f} A\n", compared,
                             std::sqrt(sum / compared));
}

// The names of an XH2 are those of the table: CHARMM-GUI's file has most of them the other way
// round, as HBUILD does, which knows no table.
TEST_CASE("1TW7 without its hydrogens gets them back within 0.1 A",
          "[prepare][positions][native]") {
    const auto file = find_shared_data("data/hiv/1tw7_charmm_allH.pdb");
    if (!file) return;
    const Structure structure = read_pdb(*file);
    const Typed typed = type_1tw7(*file, structure);
    const auto neighbours = neighbours_of(typed.connectivity);
    std::vector<Vec3> positions = structure.positions;
    std::size_t hydrogens = 0;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (!is_hydrogen(typed.connectivity, i)) continue;
        positions[i] = nowhere;
        ++hydrogens;
    }

    const BuiltPositions built =
        build_positions(typed.connectivity, typed.topology, typed.coordinates, positions);

    CHECK(built.unplaced.empty());
    CHECK(built.placed.size() == hydrogens);
    for (const Bond& bond : typed.topology.bonds) {
        if (is_hydrogen(typed.connectivity, bond.a) == is_hydrogen(typed.connectivity, bond.b))
            continue;
        CHECK((positions[bond.a] - positions[bond.b]).norm() ==
              Approx(bond.r0).margin(1e-6).epsilon(0));
    }
    int named = 0;
    for (const AtomCoordinate& line : typed.coordinates) {
        const auto& [a, b, c, d] = line.atoms;
        if (!line.is_improper || !is_hydrogen(typed.connectivity, d) || neighbours[c].size() != 4)
            continue;
        const double off =
            evaluate_torsion(positions[a], positions[b], positions[c], positions[d]).angle -
            line.dihedral;
        INFO(to_string(structure.names[d]));
        CHECK(std::abs(std::remainder(off, 2 * std::numbers::pi)) < 40 * degree);
        ++named;
    }
    CHECK(named > 700);
    double sum = 0;
    int rigid = 0;
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        if (!is_hydrogen(typed.connectivity, i)) continue;
        const auto& around = neighbours[neighbours[i][0]];
        std::vector<std::uint32_t> twins;
        for (const std::uint32_t other : around) {
            if (is_hydrogen(typed.connectivity, other)) twins.push_back(other);
        }
        const bool is_rotor = around.size() - twins.size() == 1 && around.size() != 3;
        if (is_rotor) continue;
        double nearest = std::numeric_limits<double>::infinity();
        for (const std::uint32_t twin : twins) {
            nearest = std::min(nearest, (positions[i] - structure.positions[twin]).squaredNorm());
        }
        sum += nearest;
        ++rigid;
    }
    std::cout << fmt::format("1TW7: rms of {} rigid hydrogens {:.4f} A\n", rigid,
                             std::sqrt(sum / rigid));
    CHECK(std::sqrt(sum / rigid) <= 0.1);
}

TEST_CASE("side chains of 1TW7 cut off at CB are built anew, of the right hand",
          "[prepare][positions][native]") {
    const auto file = find_shared_data("data/hiv/1tw7_charmm_allH.pdb");
    if (!file) return;
    const Structure structure = read_pdb(*file);
    const Typed typed = type_1tw7(*file, structure);
    const auto neighbours = neighbours_of(typed.connectivity);
    const bool has_cb = GENERATE(true, false);
    std::vector<Vec3> positions = structure.positions;
    const std::set<std::string> backbone{"N", "CA", "C", "O", "OT1", "OT2", "CD"};
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const AtomName& name = structure.names[i];
        const bool stays =
            (backbone.contains(name.atom) && (name.atom != "CD" || name.residue == "PRO")) ||
            (has_cb && name.atom == "CB");
        if (!stays) positions[i] = nowhere;
    }
    const std::vector<Vec3> given = positions;

    const BuiltPositions built =
        build_positions(typed.connectivity, typed.topology, typed.coordinates, positions);

    CHECK(built.unplaced.empty());
    int lengths = 0, centres = 0;
    double worst = 0;
    for (const Bond& bond : typed.topology.bonds) {
        if (given[bond.a].allFinite() && given[bond.b].allFinite()) continue;
        worst = std::max(worst, std::abs((positions[bond.a] - positions[bond.b]).norm() - bond.r0));
        ++lengths;
    }
    std::cout << fmt::format("{} built bonds, worst {:.3f} A from r0\n", lengths, worst);
    CHECK(worst < 0.35);  // a ring of five is not closed by its table
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        std::vector<std::uint32_t> heavy;
        for (const std::uint32_t other : neighbours[i]) {
            if (!is_hydrogen(typed.connectivity, other)) heavy.push_back(other);
        }
        if (heavy.size() != 3 || neighbours[i].size() != 4) continue;
        const auto volume = [&](const std::vector<Vec3>& at) {
            return (at[heavy[0]] - at[i]).cross(at[heavy[1]] - at[i]).dot(at[heavy[2]] - at[i]);
        };
        INFO(to_string(structure.names[i]));
        CHECK(volume(positions) * volume(structure.positions) > 0);
        ++centres;
    }
    CHECK(centres > 200);
}
