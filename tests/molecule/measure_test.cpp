#include "molecule/measure.h"
#include "tests/molecule/select_system.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double right = std::numbers::pi / 2;

// Whole table, one molecule.
std::vector<AtomRange> residues_of(const AtomTable& atoms) {
    return list_residues(atoms,
                         std::vector<AtomRange>{{0, static_cast<std::uint32_t>(atoms.size())}});
}

struct Placed {
    const char* residue;
    const char* number;
    const char* atom;
    double x;
};

AtomTable table_of(const std::vector<Placed>& placed) {
    AtomTable atoms;
    for (const Placed& one : placed)
        test::add_residue(atoms, {"A", one.residue, one.number, ""}, {one.atom}, one.x);
    return atoms;
}

}  // namespace

TEST_CASE("angles and dihedrals are those of the drawing board", "[molecule][measure]") {
    const Vec3 o(0, 0, 0), x(1, 0, 0), y(0, 2, 0);

    CHECK_THAT(find_angle(x, o, y), WithinAbs(right, 1e-15));
    CHECK_THAT(find_angle(x, o, -3 * x), WithinAbs(2 * right, 1e-15));
    CHECK(find_angle(x, o, x) == 0);
    CHECK(find_angle(o, o, x) == 0);
    // Seen from the origin along z, x is turned clockwise into y.
    const Vec3 above(0, 0, 1.5);
    CHECK_THAT(find_dihedral(x, o, above, above + y), WithinAbs(right, 1e-15));
    CHECK_THAT(find_dihedral(x, o, above, above - y), WithinAbs(-right, 1e-15));
    CHECK_THAT(find_dihedral(x, o, above, above + x), WithinAbs(0, 1e-15));
    CHECK_THAT(std::abs(find_dihedral(x, o, above, above - x)), WithinAbs(2 * right, 1e-15));
    CHECK(find_dihedral(x, o, -x, y) == 0);
}

TEST_CASE("a mirror turns the sign of a dihedral, a motion nothing", "[molecule][measure]") {
    std::mt19937 random(5);  // NOLINT(cert-msc51-cpp): the same on every run
    std::uniform_real_distribution<double> along(-3, 3);
    const auto draw = [&] { return Vec3(along(random), along(random), along(random)); };
    for (int i = 0; i < 50; ++i) {
        const std::array<Vec3, 4> p{draw(), draw(), draw(), draw()};
        const Quat turn = turn_of(draw());
        const Vec3 by = draw();
        const auto moved = [&](std::size_t k) -> Vec3 { return turn * p[k] + by; };
        const auto mirrored = [&](std::size_t k) -> Vec3 {
            return p[k].cwiseProduct(Vec3(1, 1, -1));
        };
        const double dihedral = find_dihedral(p[0], p[1], p[2], p[3]);

        CHECK_THAT(find_dihedral(moved(0), moved(1), moved(2), moved(3)),
                   WithinAbs(dihedral, 1e-9));
        CHECK_THAT(find_dihedral(mirrored(0), mirrored(1), mirrored(2), mirrored(3)),
                   WithinAbs(-dihedral, 1e-9));
        CHECK_THAT(find_dihedral(p[3], p[2], p[1], p[0]), WithinAbs(dihedral, 1e-9));
        CHECK_THAT(find_angle(moved(0), moved(1), moved(2)),
                   WithinAbs(find_angle(p[0], p[1], p[2]), 1e-9));
    }
}

TEST_CASE("heavy atoms of two residues clash below their radii less 0.4 Å", "[molecule][measure]") {
    // C and N: 1.70 + 1.55 - 0.4 = 2.85.
    const auto clashes = [](const AtomTable& atoms) {
        return find_overlaps(atoms, residues_of(atoms));
    };
    const auto near = clashes(table_of({{"LIG", "1", "C1", 0}, {"LIG", "2", "N1", 2.84}}));
    REQUIRE(near.size() == 1);
    CHECK(near[0].a == 0);
    CHECK(near[0].b == 1);
    CHECK_THAT(near[0].distance, WithinAbs(2.84, 1e-12));
    CHECK(clashes(table_of({{"LIG", "1", "C1", 0}, {"LIG", "2", "N1", 2.86}})).empty());
    CHECK(clashes(table_of({{"LIG", "1", "C1", 0}, {"LIG", "1", "N1", 1}})).empty());
    CHECK(clashes(table_of({{"LIG", "1", "C1", 0}, {"LIG", "2", "H1", 1}})).empty());

    const AtomTable apart = table_of({{"LIG", "1", "C1", 0}, {"LIG", "2", "N1", 3.6}});
    CHECK(find_overlaps(apart, residues_of(apart), contact_overlap).size() == 1);
    // Of one side alone, whichever comes first.
    AtomTable three =
        table_of({{"LIG", "1", "C1", 0}, {"LIG", "2", "C1", 2.5}, {"LIG", "3", "C1", 5}});
    const auto count_of = [&](const std::vector<bool>& of) {
        return find_overlaps(three, residues_of(three), clash_overlap, of).size();
    };
    CHECK(count_of({}) == 2);
    CHECK(count_of({true, false, false}) == 1);
    CHECK(count_of({false, false, true}) == 1);
    CHECK(count_of({false, true, false}) == 2);
    CHECK(count_of({true, true, false}) == 1);
    CHECK(count_of({true, true, true}) == 0);

    AtomTable metal = table_of({{"LIG", "1", "O1", 0}, {"ZN", "2", "ZN", 2}});
    metal.element.write()[1] = "ZN";
    CHECK(clashes(metal).empty());
}

TEST_CASE("what is up to three bonds apart does not clash", "[molecule][measure]") {
    AtomTable atoms = table_of({{"LIG", "1", "C1", 0},
                                {"LIG", "2", "C2", 0.1},
                                {"LIG", "3", "C3", 0.2},
                                {"LIG", "4", "C4", 0.3},
                                {"LIG", "5", "C5", 0.4}});
    atoms.bonds = {{0, 1}, {1, 2}, {3, 2}, {3, 4}};

    const std::vector<AtomPair> clashes = find_overlaps(atoms, residues_of(atoms));

    REQUIRE(clashes.size() == 1);
    CHECK(clashes[0].a == 0);
    CHECK(clashes[0].b == 4);
}

TEST_CASE("clashes are those that looking at all pairs finds", "[molecule][measure]") {
    std::mt19937 random(9);  // NOLINT(cert-msc51-cpp): the same on every run
    std::uniform_real_distribution<double> along(-8, 8);
    std::uniform_int_distribution<int> which(0, 3);
    // Radii by hand; of a hydrogen none.
    const std::array<const char*, 4> names{"C", "O", "S", "H"};
    const std::array<double, 4> radii{1.70, 1.52, 1.80, 0};
    AtomTable atoms;
    std::vector<double> radius;
    for (int i = 0; i < 400; ++i) {
        const auto kind = static_cast<std::size_t>(which(random));
        test::add_residue(atoms, {"A", "LIG", std::to_string(i / 4), ""}, {names[kind]}, 0);
        atoms.positions.back() = {along(random), along(random), along(random)};
        radius.push_back(radii[kind]);
    }

    const std::vector<AtomPair> found = find_overlaps(atoms, residues_of(atoms));

    std::vector<std::array<std::uint32_t, 2>> expected, pairs;
    for (std::uint32_t a = 0; a < atoms.size(); ++a) {
        for (std::uint32_t b = a + 1; b < atoms.size(); ++b) {
            if (radius[a] == 0 || radius[b] == 0 || a / 4 == b / 4) continue;
            const double distance = (atoms.positions[a] - atoms.positions[b]).norm();
            if (distance < radius[a] + radius[b] - 0.4) expected.push_back({a, b});
        }
    }
    for (const AtomPair& pair : found) pairs.push_back({pair.a, pair.b});
    CHECK(expected.size() > 100);
    CHECK(pairs == expected);
}

TEST_CASE("a salt bridge is the nearest nitrogen and oxygen of charged residues",
          "[molecule][measure]") {
    const auto bridges = [](const std::vector<Placed>& placed) {
        const AtomTable atoms = table_of(placed);
        return find_salt_bridges(atoms, residues_of(atoms));
    };
    const auto found = bridges({{"ARG", "1", "NH1", 0},
                                {"ARG", "1", "NH2", 1},
                                {"ASP", "2", "OD1", 4.5},
                                {"ASP", "2", "OD2", 3.5},
                                {"GLU", "3", "OE1", -4},
                                {"GLU", "4", "OE1", 5.5}});
    REQUIRE(found.size() == 2);
    CHECK(found[0].a == 0);
    CHECK(found[0].b == 4);
    CHECK(found[1].a == 1);
    CHECK(found[1].b == 3);
    CHECK(found[1].distance == 2.5);

    CHECK(bridges({{"LYS", "1", "NZ", 0}, {"GLU", "2", "OE2", 3}}).size() == 1);
    CHECK(bridges({{"LYS", "1", "NZ", 0}, {"GLU", "2", "O", 3}}).empty());
    CHECK(bridges({{"LYS", "1", "N", 0}, {"GLU", "2", "OE1", 3}}).empty());
    CHECK(bridges({{"LYS", "1", "NZ", 0}, {"GLU", "2", "OE1", 4.01}}).empty());
    CHECK(bridges({{"HSP", "1", "NE2", 0}, {"GLU", "2", "OE2", 3}}).size() == 1);
    CHECK(bridges({{"HSD", "1", "NE2", 0}, {"GLU", "2", "OE2", 3}}).empty());
    // By their hydrogens.
    CHECK(bridges({{"HIS", "1", "NE2", 0}, {"GLU", "2", "OE2", 3}}).empty());
    CHECK(bridges({{"HIS", "1", "NE2", 0},
                   {"HIS", "1", "HE2", 1},
                   {"HIS", "1", "HD1", 1},
                   {"GLU", "2", "OE2", 3}})
              .size() == 1);
    CHECK(bridges({{"LYS", "1", "NZ", 0}, {"GLU", "2", "OE2", 3}, {"GLU", "2", "HE2", 4}}).empty());
    CHECK(bridges({{"LYS", "1", "NZ", 0},
                   {"LYS", "1", "HZ1", 1},
                   {"LYS", "1", "HZ2", 1},
                   {"ASP", "2", "OD1", 3}})
              .empty());
}
