// Where chains are cut that leave a region, and what remains of bodies of few atoms.
#include "assembly/region_bodies.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

using namespace palpa;

namespace {

using BondAtoms = std::array<std::uint32_t, 2>;
using Bonds = std::vector<BondAtoms>;

// Carbons in a row, each bonded to the next.
Connectivity build_row(std::uint32_t atoms) {
    Connectivity row;
    row.mass.assign(atoms, 12);
    row.names.resize(atoms);
    for (std::uint32_t i = 0; i + 1 < atoms; ++i) row.bonds.push_back({i, i + 1});
    return row;
}

Bonds cuts_of(const Connectivity& connectivity, const std::vector<std::uint8_t>& is_inside,
              const Bonds& springs = {}) {
    return find_region_cuts(connectivity, is_inside, springs);
}

}  // namespace

TEST_CASE("a piece of chain in a region is attached to the atom before it, and is cut behind",
          "[assembly][region]") {
    Connectivity row = build_row(10);
    CHECK(cuts_of(row, {0, 0, 0, 1, 1, 1, 0, 0, 0, 0}) == Bonds{{5, 6}});
    CHECK(cuts_of(row, {0, 1, 0, 0, 0, 1, 1, 1, 0, 0}) == Bonds{{1, 2}, {7, 8}});
    // What has one way out only, or none, is not cut.
    CHECK(cuts_of(row, {1, 1, 1, 0, 0, 0, 0, 0, 0, 0}).empty());
    CHECK(cuts_of(row, {0, 0, 0, 0, 0, 0, 0, 0, 1, 1}).empty());
    CHECK(cuts_of(row, std::vector<std::uint8_t>(10, 1)).empty());
    CHECK(cuts_of(row, std::vector<std::uint8_t>(10, 0)).empty());
    // A spring inside leaves two pieces, each with its way out, and one that leads out is no way.
    CHECK(cuts_of(row, {0, 0, 0, 1, 1, 1, 0, 0, 0, 0}, {{4, 5}}).empty());
    CHECK(cuts_of(row, {0, 0, 0, 1, 1, 1, 0, 0, 0, 0}, {{2, 3}}).empty());
    row.bonds.push_back({9, 0});
    CHECK(cuts_of(row, {1, 1, 0, 0, 0, 0, 0, 0, 1, 1}) == Bonds{{7, 8}});
    row.bonds = {{1, 0}, {2, 1}};  // either way round
    CHECK(cuts_of(row, {0, 1, 0, 0, 0, 0, 0, 0, 0, 0}) == Bonds{{1, 2}});
}

TEST_CASE("bodies of few atoms are those of all, by other numbers", "[assembly][region]") {
    // Two rows; the second one has a base alone.
    Connectivity rows = build_row(14);
    std::erase(rows.bonds, BondAtoms{9, 10});
    const std::vector<std::uint8_t> is_inside{0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0};
    Joints joints;
    joints.joints = {{{3, 4}, JointKind::Torsion}, {{4, 5}, JointKind::Torsion}};
    joints.springs = cuts_of(rows, is_inside);
    const std::vector<std::uint32_t> outside{0, 1, 2, 7, 8, 9, 10, 11, 12, 13};
    const TorsionBodies whole = build_bodies(rows, joints, outside);
    REQUIRE(whole.bodies.size() == 5);
    const std::vector<std::uint32_t> atoms{1, 2, 3, 4, 5, 6, 7, 8};
    const CutBodies cut = cut_bodies(whole, atoms);
    CHECK(cut.bodies.bodies.size() == 4);
    CHECK(cut.bodies.springs == Bonds{{5, 6}});
    REQUIRE(cut.bodies.body_of.size() == atoms.size());
    const std::vector<std::uint32_t> molecule_of = molecules_of(whole);
    const std::vector<std::uint32_t> own_molecule = molecules_of(cut.bodies);
    for (std::uint32_t i = 0; i < atoms.size(); ++i) {
        const std::uint32_t own = cut.bodies.body_of[i], its = whole.body_of[atoms[i]];
        CHECK(cut.molecules[own_molecule[own]] == molecule_of[its]);
        for (std::uint32_t k = 0; k < atoms.size(); ++k)
            CHECK((cut.bodies.body_of[k] == own) == (whole.body_of[atoms[k]] == its));
        REQUIRE(cut.bodies.is_base(own) == whole.is_base(its));
        if (whole.is_base(its)) continue;
        for (const int end : {0, 1})
            CHECK(atoms[cut.bodies.bodies[own].axis[end]] == whole.bodies[its].axis[end]);
    }
    // All of them: nothing changes.
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < 14; ++i) all.push_back(i);
    const CutBodies same = cut_bodies(whole, all);
    CHECK(same.bodies.body_of == whole.body_of);
    CHECK(same.bodies.springs == whole.springs);
    CHECK(same.molecules.size() == whole.molecules());
}
