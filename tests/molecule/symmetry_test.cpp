#include "molecule/symmetry.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

using namespace palpa;

namespace {

class Builder {
public:
    std::uint32_t add(double mass, const Vec3& place) {
        table.names.push_back({"A", "MOL", "1", "X"});
        table.mass.push_back(mass);
        table.positions.push_back(place);
        return static_cast<std::uint32_t>(table.mass.size() - 1);
    }
    void bond(std::uint32_t a, std::uint32_t b) { table.bonds.push_back({a, b}); }

    // Six carbons in the plane of x and z about `centre`; the first is the one at +x.
    std::vector<std::uint32_t> add_ring(const Vec3& centre) {
        std::vector<std::uint32_t> ring;
        for (int i = 0; i < 6; ++i) {
            const double angle = i * std::numbers::pi / 3;
            ring.push_back(add(12.011, centre + 1.4 * Vec3(std::cos(angle), 0, std::sin(angle))));
        }
        for (std::size_t i = 0; i < 6; ++i) bond(ring[i], ring[(i + 1) % 6]);
        return ring;
    }

    SymmetricAtoms symmetries() const {
        std::vector<std::uint32_t> all(table.mass.size());
        std::iota(all.begin(), all.end(), 0U);
        return find_symmetries(table, all);
    }

    AtomTable table;
};

constexpr double carbon = 12.011, oxygen = 15.999, hydrogen = 1.008;

}  // namespace

TEST_CASE("a phenyl ring with a neighbour turns over, a free one has twelve ways",
          "[molecule][symmetry]") {
    Builder builder;
    const std::vector<std::uint32_t> ring = builder.add_ring(Vec3(0, 0, 0));
    CHECK(builder.symmetries().symmetries.size() == 12);
    builder.bond(ring[0], builder.add(carbon, Vec3(2.9, 0, 0)));
    const SymmetricAtoms phenyl = builder.symmetries();
    REQUIRE(phenyl.symmetries.size() == 2);
    CHECK(phenyl.symmetries[1] == std::vector<std::uint32_t>{0, 5, 4, 3, 2, 1, 6});

    // Turned over it is where it was; turned by a quarter it is not.
    std::vector<Vec3> turned;
    for (const Vec3& place : builder.table.positions)
        turned.emplace_back(place.x(), -place.y(), -place.z());
    CHECK(find_square_distance(phenyl, {}, turned, builder.table.positions) < 1e-20);
    std::vector<Vec3> quarter;
    for (const Vec3& place : builder.table.positions)
        quarter.emplace_back(place.x(), -place.z(), place.y());
    // Four atoms go 2^(1/2) 1.4 sin(60°) Å each.
    CHECK(find_square_distance(phenyl, {}, quarter, builder.table.positions) ==
          Approx(4 * 2 * 1.4 * 1.4 * 0.75));
}

TEST_CASE("methyls of a chiral centre stay, and hydrogens tell atoms apart",
          "[molecule][symmetry]") {
    Builder isopropyl;
    const std::uint32_t centre = isopropyl.add(carbon, Vec3(0, 0, 0));
    for (const Vec3& arm : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1)})
        isopropyl.bond(centre, isopropyl.add(carbon, arm));
    isopropyl.bond(1, isopropyl.add(oxygen, Vec3(2, 2, 2)));
    CHECK(isopropyl.symmetries().symmetries.size() == 1);

    // In a plane they change places, as the oxygens of a carboxylate do, unless one has a proton.
    Builder acid;
    acid.add(carbon, Vec3(0, 0, 0));
    acid.bond(0, acid.add(carbon, Vec3(-1.5, 0, 0)));
    acid.bond(0, acid.add(oxygen, Vec3(0.6, 1.1, 0)));
    acid.bond(0, acid.add(oxygen, Vec3(0.6, -1.1, 0)));
    CHECK(acid.symmetries().symmetries.size() == 2);
    acid.bond(3, acid.add(hydrogen, Vec3(1.5, -1.2, 0)));
    CHECK(acid.symmetries().symmetries.size() == 1);
    CHECK(acid.symmetries().atoms.size() == 4);
}

TEST_CASE("a molecule with a two-fold axis and two rings has eight ways", "[molecule][symmetry]") {
    Builder builder;
    const std::uint32_t left = builder.add(carbon, Vec3(-0.7, 0, 0)),
                        right = builder.add(carbon, Vec3(0.7, 0, 0));
    builder.bond(left, right);
    const std::vector<std::uint32_t> first = builder.add_ring(Vec3(-3.5, 0, 0)),
                                     second = builder.add_ring(Vec3(3.5, 0, 0));
    builder.bond(left, first[0]);
    builder.bond(right, second[3]);
    CHECK(builder.symmetries().symmetries.size() == 8);
    CHECK(find_symmetries(builder.table, std::vector<std::uint32_t>{0, 1}).symmetries.size() == 2);
    // With a bound, those beyond are left out.
    std::vector<std::uint32_t> all(builder.table.mass.size());
    std::iota(all.begin(), all.end(), 0U);
    CHECK(find_symmetries(builder.table, all, 3).symmetries.size() == 3);
}

TEST_CASE("a chain of forty chiral centres with two methyls each has no way but its own",
          "[molecule][symmetry]") {
    // Judged at the end alone that would be 2^40 tries.
    Builder builder;
    std::uint32_t last = builder.add(oxygen, Vec3(-1.5, 0, 0));
    for (int i = 0; i < 40; ++i) {
        const double x = 1.5 * i;
        const std::uint32_t centre = builder.add(carbon, Vec3(x, i % 2 == 0 ? 0.5 : -0.5, 0));
        const double side = i % 2 == 0 ? 1 : -1;
        builder.bond(last, centre);
        builder.bond(centre, builder.add(carbon, Vec3(x, 1.2 * side, 1.2)));
        builder.bond(centre, builder.add(carbon, Vec3(x, 1.2 * side, -1.2)));
        last = centre;
    }
    CHECK(builder.symmetries().symmetries.size() == 1);
}
