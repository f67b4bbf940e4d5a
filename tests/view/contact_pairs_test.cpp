#include "view/contact_pairs.h"

#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "view/build_frame.h"
#include "view/legend.h"
#include "view/palette.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

ContactPairs find_pairs(const World& world, ShownBonds which) {
    return find_contact_pairs(world, which, find_residues(world),
                              find_hydrogen_bonds(world, which));
}

// Two waters of which the first atoms alone are near to each other, on the x axis; the third one is
// by itself.
struct Pair {
    World world = test::three_waters(0, {0, 40, 0});
    std::uint32_t moved = test::range_called(world, "moved").first;
    std::uint32_t fixed = test::range_called(world, "fixed").first;

    Pair() {
        AtomTable& atoms = world.write<AtomTable>();
        for (const std::uint32_t first : {moved, fixed}) {
            const double x = first == moved ? 0 : 60;
            atoms.positions[first + 1] = {x, 0, 30};
            atoms.positions[first + 2] = {x, 0, 50};
        }
    }
    void put(double distance, const std::string& of_moved, const std::string& of_fixed) {
        AtomTable& atoms = world.write<AtomTable>();
        atoms.positions[moved] = Vec3::Zero();
        atoms.positions[fixed] = {distance, 0, 0};
        atoms.element.write()[moved] = of_moved;
        atoms.element.write()[fixed] = of_fixed;
    }
    void name(std::uint32_t first, const char* residue, const char* atom) {
        AtomTable& atoms = world.write<AtomTable>();
        for (std::uint32_t i = first; i < first + 3; ++i) atoms.names.write()[i].residue = residue;
        atoms.names.write()[first].atom = atom;
    }
    std::array<std::size_t, 3> count(ShownBonds which = ShownBonds::InHand) {
        const ContactPairs found = find_pairs(world, which);
        return {found.contacts.size(), found.clashes.size(), found.salt_bridges.size()};
    }
};

using Counts = std::array<std::size_t, 3>;

std::size_t count(const FrameScene& frame, std::uint32_t pick) {
    return static_cast<std::size_t>(std::ranges::count(frame.cones, pick, &ConeShape::pick));
}

}  // namespace

TEST_CASE("contacts reach 0.4 Å beyond the radii, clashes begin 0.4 Å within", "[view][contacts]") {
    Pair pair;
    const auto at = [&](double distance) {
        pair.put(distance, "C", "C");  // 1.70 Å each
        return pair.count();
    };

    CHECK(at(3.81) == Counts{0, 0, 0});
    CHECK(at(3.79) == Counts{1, 0, 0});
    CHECK(at(3.01) == Counts{1, 0, 0});
    CHECK(at(2.99) == Counts{0, 1, 0});
    CHECK(pair.count(ShownBonds::None) == Counts{0, 0, 0});
    CHECK(pair.count(ShownBonds::All) == Counts{0, 1, 0});
}

TEST_CASE("in hand are pairs of what is held with the rest, and all has the others too",
          "[view][contacts]") {
    Pair pair;
    pair.put(30, "C", "C");
    AtomTable& atoms = pair.world.write<AtomTable>();
    const std::uint32_t third = test::range_called(pair.world, "third").first;
    atoms.element.write()[third] = "C";
    atoms.positions[third] = atoms.positions[pair.fixed] + Vec3(0, 3.5, 0);
    CHECK(pair.count() == Counts{0, 0, 0});
    CHECK(pair.count(ShownBonds::All) == Counts{1, 0, 0});
    atoms.positions[third] = atoms.positions[pair.moved] + Vec3(0, 3.5, 0);
    CHECK(pair.count() == Counts{1, 0, 0});
}

TEST_CASE("a hydrogen bond is no contact, and a clash where it is 0.4 Å shorter than others",
          "[view][contacts]") {
    Pair pair;
    const auto at = [&](double distance) {
        pair.put(distance, "O", "O");  // 1.52 Å each
        pair.world.write<AtomTable>().positions[pair.moved + 1] = {0.96, 0, 0};
        return pair.count();
    };

    CHECK(at(2.7) == Counts{0, 0, 0});  // 0.34 Å of overlap
    CHECK(at(2.5) == Counts{0, 0, 0});  // 0.54
    CHECK(at(2.2) == Counts{0, 1, 0});  // 0.84
    pair.world.write<AtomTable>().positions[pair.moved + 1] = {0, 0, 30};
    CHECK(pair.count() == Counts{0, 1, 0});
    pair.put(2.7, "O", "O");
    CHECK(pair.count() == Counts{1, 0, 0});
    pair.put(2.5, "O", "O");
    CHECK(pair.count() == Counts{0, 1, 0});
}

TEST_CASE("the worst clash is that of the largest overlap beyond what its pair is allowed",
          "[view][contacts]") {
    Pair pair;
    pair.put(2.2, "O", "O");  // 0.84 Å of overlap; 0.44 with the allowance of a hydrogen bond
    AtomTable& atoms = pair.world.write<AtomTable>();
    atoms.positions[pair.moved + 1] = {0.96, 0, 0};
    const std::uint32_t third = test::range_called(pair.world, "third").first;
    atoms.element.write()[third] = "C";
    atoms.positions[third] = {0, 2.6, 0};  // 1.52 + 1.70 - 2.6 = 0.62 Å

    const ContactPairs found = find_pairs(pair.world, ShownBonds::InHand);

    REQUIRE(found.clashes.size() == 2);
    CHECK((found.clashes[0].pair.a == third || found.clashes[0].pair.b == third));
    CHECK(found.clashes[0].excess == Approx(0.62));
    CHECK(found.clashes[1].excess == Approx(0.44));
    std::vector<ViewLabel> labels;
    FrameScene frame;
    add_contact_pairs(atoms, found, frame, labels);
    REQUIRE(labels.size() == 1);
    CHECK(labels[0].text == "0.6 Å overlap");
}

TEST_CASE("a salt bridge of what is in hand is found, and is no contact", "[view][contacts]") {
    Pair pair;
    pair.put(2.9, "N", "O");
    pair.name(pair.moved, "ARG", "NH1");
    pair.name(pair.fixed, "GLU", "OE1");

    CHECK(pair.count() == Counts{0, 0, 1});
    CHECK(pair.count(ShownBonds::All) == Counts{0, 0, 1});
    pair.put(4.1, "N", "O");
    CHECK(pair.count() == Counts{0, 0, 0});
    pair.put(2.9, "N", "O");
    pair.name(pair.fixed, "GLN", "OE1");
    CHECK(pair.count() == Counts{1, 0, 0});
}

TEST_CASE("contacts of the inhibitor in HIV-1 protease are those of a plain search",
          "[view][contacts]") {
    const World world = test::protease_world();
    const AtomTable& atoms = world.resource<AtomTable>();
    const AtomRange held = held_range(world, hand_at(world, 0));
    const auto radius = [&](std::uint32_t i) {
        switch (atoms.names[i].atom[0]) {
            case 'C':
                return 1.7;
            case 'N':
                return 1.55;
            case 'O':
                return 1.52;
            default:
                return 1.8;  // sulphur; hydrogens below
        }
    };
    const auto is_hydrogen = [&](std::uint32_t i) { return atoms.mass[i] < 2; };
    std::set<std::pair<std::uint32_t, std::uint32_t>> near;
    for (std::uint32_t i = held.first; i < held.first + held.count; ++i) {
        for (std::uint32_t k = 0; k < atoms.size(); ++k) {
            if (has_atom(held, k) || is_hydrogen(i) || is_hydrogen(k)) continue;
            if ((atoms.positions[i] - atoms.positions[k]).norm() < radius(i) + radius(k) + 0.4)
                near.insert(std::minmax({i, k}));
        }
    }
    const std::size_t bonded =
        [&] {  // donor and acceptor of each hydrogen bond, which are near as well
            std::set<std::pair<std::uint32_t, std::uint32_t>> joined;
            for (const HydrogenBond& bond : find_hydrogen_bonds(world))
                for (const auto& [a, b] : atoms.bonds)
                    if (a == bond.hydrogen || b == bond.hydrogen)
                        joined.insert(std::minmax({a == bond.hydrogen ? b : a, bond.acceptor}));
            return static_cast<std::size_t>(
                std::ranges::count_if(joined, [&](const auto& one) { return near.contains(one); }));
        }();

    const ContactPairs found = find_pairs(world, ShownBonds::InHand);

    CHECK(near.size() > 50);
    CHECK(bonded > 3);
    CHECK(found.contacts.size() + found.clashes.size() == near.size() - bonded);
    for (const AtomPair& pair : found.contacts) CHECK(near.contains({pair.a, pair.b}));
}

TEST_CASE("each kind has a shape, a colour and a pick of its own, between the atoms as drawn",
          "[view][contacts]") {
    Pair pair;
    ViewSettings settings{.force_arrow = false, .hydrogen_bonds = ShownBonds::None};
    std::vector<ViewLabel> labels;
    const auto build = [&] {
        settings.marks.contacts = ShownBonds::InHand;
        return build_frame(pair.world, settings, &labels);
    };
    const auto between_atoms = [&](const FrameScene& frame, std::uint32_t pick) {
        float low = 1e9F, high = -1e9F;
        for (const ConeShape& cone : frame.cones) {
            if (cone.pick != pick) continue;
            low = std::min({low, cone.a.x, cone.b.x});
            high = std::max({high, cone.a.x, cone.b.x});
        }
        const auto radius = [&](std::uint32_t atom) {
            return std::ranges::find(frame.spheres, atom, &SphereShape::pick)->radius;
        };
        CHECK(low == Approx(radius(pair.moved)));
        const auto x =
            static_cast<float>(pair.world.resource<AtomTable>().positions[pair.fixed].x());
        CHECK(high == Approx(x - radius(pair.fixed)));
    };

    SECTION("contact") {
        pair.put(3.6, "C", "C");
        const FrameScene frame = build();
        REQUIRE(count(frame, contact_pick) == 1);
        CHECK(std::ranges::find(frame.cones, contact_pick, &ConeShape::pick)->colour_a ==
              contact_colour);
        between_atoms(frame, contact_pick);
        CHECK(labels.empty());
    }
    SECTION("clash") {
        pair.put(2.4, "C", "C");
        const FrameScene frame = build();
        CHECK(count(frame, clash_pick) == 3);  // a stick and both sides of a disc
        between_atoms(frame, clash_pick);
        REQUIRE(labels.size() == 1);
        CHECK(labels[0].text == "1.0 Å overlap");
        CHECK(labels[0].place.x == Approx(1.2));
        pair.world.set(pair.world.find<Grip>(hand_at(pair.world, 0))->molecule,
                       Appearance{{}, {}, false});
        CHECK(count(build(), clash_pick) == 0);  // of what is hidden
    }
    SECTION("salt bridge") {
        pair.put(3.5, "N", "O");
        pair.name(pair.moved, "LYS", "NZ");
        pair.name(pair.fixed, "ASP", "OD2");
        const FrameScene frame = build();
        CHECK(count(frame, salt_bridge_pick) >= 3);
        between_atoms(frame, salt_bridge_pick);
        REQUIRE(labels.size() == 1);
        CHECK(labels[0].text == "3.50 Å");
    }
    std::vector<std::string> legend;
    for (const LegendEntry& entry : find_legend(pair.world, settings)) legend.push_back(entry.text);
    CHECK(legend == std::vector<std::string>{"contact", "clash", "salt bridge"});
    settings.marks.contacts = ShownBonds::None;
    CHECK(find_legend(pair.world, settings).empty());
    const FrameScene none = build_frame(pair.world, settings);
    for (const std::uint32_t pick : {contact_pick, clash_pick, salt_bridge_pick})
        CHECK(count(none, pick) == 0);
}
