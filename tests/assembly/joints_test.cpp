#include "assembly/joints.h"

#include "assembly/bodies.h"
#include "formats/psf.h"
#include "tests/support/load_error_of.h"
#include "tests/support/paths.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

using namespace palpa;
using Catch::Matchers::Contains;

namespace {

using Bonds = std::vector<std::array<std::uint32_t, 2>>;

// "CCOH" and who is bonded to whom.
Connectivity molecule_of(std::string_view elements, Bonds bonds) {
    const std::map<char, double> mass{{'H', 1.008},  {'C', 12.011}, {'N', 14.007},
                                      {'O', 15.999}, {'S', 32.06},  {'F', 18.998}};
    Connectivity result;
    result.file = "molecule.psf";
    for (const char element : elements) {
        const auto number = result.mass.size();
        result.mass.push_back(mass.at(element));
        result.names.push_back({"A", "MOL", "1", fmt::format("{}{}", element, number)});
    }
    result.bonds = std::move(bonds);
    return result;
}

Connectivity with_hydrogens(std::string_view elements, Bonds bonds,
                            const std::vector<int>& hydrogens) {
    std::string all(elements);
    for (std::uint32_t atom = 0; atom < hydrogens.size(); ++atom) {
        for (int i = 0; i < hydrogens[atom]; ++i) {
            bonds.push_back({atom, static_cast<std::uint32_t>(all.size())});
            all += 'H';
        }
    }
    return molecule_of(all, std::move(bonds));
}

const JointRules everything{
    .methyl = true, .amide = true, .amide_nh2 = true, .guanidinium_nh2 = true, .overrides = {}};

Bonds bonds_of(const Joints& joints) {
    Bonds result;
    for (const Joint& joint : joints.joints) result.push_back(joint.bond);
    return result;
}

// Of all bonds that any rule could let turn.
std::vector<JointKind> kinds_of(const Connectivity& connectivity) {
    std::vector<JointKind> result;
    for (const Joint& joint : build_joints(connectivity, everything).joints) {
        result.push_back(joint.kind);
    }
    return result;
}

std::map<JointKind, int> count_kinds(const Joints& joints) {
    std::map<JointKind, int> result;
    for (const Joint& joint : joints.joints) ++result[joint.kind];
    return result;
}

Connectivity read_hiv(const char* file) {
    return read_psf(test::in_project(std::string("scenes/hiv/") + file));
}

// With the atoms of a segment a second time.
Connectivity with_copy_of(Connectivity connectivity, const std::string& segment) {
    std::map<std::uint32_t, std::uint32_t> copy_of;
    const std::size_t atoms = connectivity.mass.size();
    for (std::uint32_t i = 0; i < atoms; ++i) {
        if (connectivity.names[i].segment != segment) continue;
        copy_of[i] = static_cast<std::uint32_t>(connectivity.mass.size());
        connectivity.mass.push_back(connectivity.mass[i]);
        connectivity.names.push_back(connectivity.names[i]);
        connectivity.names.back().segment += "2";
    }
    const Bonds bonds = connectivity.bonds;
    for (const auto& [a, b] : bonds) {
        if (copy_of.contains(a)) connectivity.bonds.push_back({copy_of.at(a), copy_of.at(b)});
    }
    return connectivity;
}

std::size_t freedom_of(const Connectivity& connectivity) {
    return build_bodies(connectivity, build_joints(connectivity)).degrees_of_freedom();
}

}  // namespace

TEST_CASE("a protease with two TL-3 has the paper's 848 degrees of freedom", "[assembly][joints]") {
    const Connectivity hiv = read_hiv("charged/system.psf");

    CHECK(freedom_of(with_copy_of(hiv, "TL3C")) == 848);
    // Counted from the sequence in the literature: 385 a chain, 27 in TL-3, 6 a molecule.
    CHECK(freedom_of(hiv) == 2 * 385 + 27 + 3 * 6);
    // Asp 25 of one chain has a hydrogen that turns.
    CHECK(freedom_of(read_hiv("system.psf")) == 2 * 385 + 1 + 27 + 3 * 6);
}

TEST_CASE("the joints of protease and TL-3 are those counted by hand", "[assembly][joints]") {
    const auto kinds = count_kinds(build_joints(read_hiv("charged/system.psf"), everything));

    // Two chains: phi 93, psi 99, chi 171 with Arg chi4, Arg chi5 4; TL-3 23 + 2.
    CHECK(kinds.at(JointKind::Torsion) == 2 * (93 + 99 + 171 + 4) + 25);
    CHECK(kinds.at(JointKind::Hydroxyl) + kinds.at(JointKind::Thiol) == 2 * 11 + 2);
    CHECK(kinds.at(JointKind::Ammonium) == 2 * 7);
    CHECK(kinds.at(JointKind::Methyl) == 2 * 75 + 6);
    CHECK(kinds.at(JointKind::Amide) == 2 * 98 + 6);
    CHECK(kinds.at(JointKind::AmideNH2) == 2 * 9);
    CHECK(kinds.at(JointKind::GuanidiniumNH2) == 2 * 8);
    CHECK(!kinds.contains(JointKind::DoubleOrLinear));
}

TEST_CASE("rotors of hydrogens are told apart", "[assembly][joints]") {
    using enum JointKind;
    const Bonds two{{0, 1}}, three{{0, 1}, {1, 2}};

    CHECK(kinds_of(with_hydrogens("CO", two, {3, 1})) == std::vector{Hydroxyl});
    CHECK(kinds_of(with_hydrogens("CS", two, {3, 1})) == std::vector{Thiol});
    CHECK(kinds_of(with_hydrogens("CN", two, {3, 3})) == std::vector{Ammonium});
    CHECK(kinds_of(with_hydrogens("CN", two, {3, 2})) == std::vector{Ammonium});
    CHECK(kinds_of(with_hydrogens("CC", two, {3, 3})) == std::vector{Methyl});
    CHECK(kinds_of(with_hydrogens("CCO", {{0, 1}, {1, 2}}, {3, 2, 1})) ==
          std::vector{Methyl, Hydroxyl});
    // Acetic acid and acetamide; dimethyl ether
    CHECK(kinds_of(with_hydrogens("CCOO", {{0, 1}, {1, 2}, {1, 3}}, {3, 0, 0, 1})) ==
          std::vector{Methyl, Hydroxyl});
    CHECK(kinds_of(with_hydrogens("CCON", {{0, 1}, {1, 2}, {1, 3}}, {3, 0, 0, 2})) ==
          std::vector{Methyl, AmideNH2});
    CHECK(kinds_of(with_hydrogens("COC", three, {3, 0, 3})) == std::vector{Methyl, Methyl});
    // Water, and one of those whose hydrogens are bonded to each other, turn nothing.
    CHECK(kinds_of(with_hydrogens("O", {}, {2})).empty());
    CHECK(kinds_of(molecule_of("OHH", {{0, 1}, {0, 2}, {1, 2}})).empty());
}

TEST_CASE("what nitrogen and oxygen do to a planar carbon decides", "[assembly][joints]") {
    using enum JointKind;
    // CH3-CH2-C(=O)-X-CH2-CH3
    const auto between = [](const char* elements, int hydrogens) {
        return kinds_of(with_hydrogens(elements, {{0, 1}, {1, 2}, {2, 3}, {2, 4}, {4, 5}, {5, 6}},
                                       {3, 2, 0, 0, hydrogens, 2, 3}));
    };

    CHECK(between("CCCONCC", 1) == std::vector{Methyl, Torsion, Amide, Torsion, Methyl});
    CHECK(between("CCCSNCC", 1) == std::vector{Methyl, Torsion, Amide, Torsion, Methyl});
    CHECK(between("CCCOOCC", 0) == std::vector{Methyl, Torsion, Torsion, Torsion, Methyl});
    // N-ethylguanidinium: the bond towards the chain turns, like chi5 of arginine.
    CHECK(kinds_of(with_hydrogens("CCNCNN", {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {3, 5}},
                                  {3, 2, 1, 0, 2, 2})) ==
          std::vector{Methyl, Torsion, Torsion, GuanidiniumNH2, GuanidiniumNH2});
}

TEST_CASE("double and linear bonds of a chain stay rigid", "[assembly][joints]") {
    const auto turning = [](const Connectivity& c) { return bonds_of(build_joints(c)); };

    // Butadiene; hexatriene; acrolein; an imine between two ethyls
    CHECK(turning(with_hydrogens("CCCC", {{0, 1}, {1, 2}, {2, 3}}, {2, 1, 1, 2})) == Bonds{{1, 2}});
    CHECK(turning(with_hydrogens("CCCCCC", {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}},
                                 {2, 1, 1, 1, 1, 2})) == Bonds{{1, 2}, {3, 4}});
    CHECK(turning(with_hydrogens("CCCO", {{0, 1}, {1, 2}, {2, 3}}, {2, 1, 1, 0})) == Bonds{{1, 2}});
    CHECK(turning(with_hydrogens("CCCNCC", {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}},
                                 {3, 2, 1, 0, 2, 3})) == Bonds{{1, 2}, {3, 4}});
    // Two benzenes, joined directly and by C=C
    Bonds rings{{0, 6}};
    for (const std::uint32_t first : {0U, 6U}) {
        for (std::uint32_t i = 0; i < 6; ++i) rings.push_back({first + i, first + (i + 1) % 6});
    }
    const std::vector hydrogens{0, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1};
    CHECK(turning(with_hydrogens("CCCCCCCCCCCC", rings, hydrogens)) == Bonds{{0, 6}});
    rings[0] = {12, 13};
    rings.insert(rings.end(), {{0, 12}, {6, 13}});
    std::vector more = hydrogens;
    more.insert(more.end(), {1, 1});
    CHECK(turning(with_hydrogens("CCCCCCCCCCCCCC", rings, more)) == Bonds{{0, 12}, {6, 13}});
    // Hexyne-3, butyronitrile
    CHECK(turning(with_hydrogens("CCCCCC", {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}},
                                 {3, 2, 0, 0, 2, 3}))
              .empty());
    CHECK(turning(with_hydrogens("CCCCN", {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, {3, 2, 2, 0, 0})) ==
          Bonds{{1, 2}});
}

TEST_CASE("a disulphide that closes a large ring becomes a spring", "[assembly][joints]") {
    // CH2-S-S-CH2 closed by CH2s.
    const auto ring_of = [](std::uint32_t atoms) {
        Bonds bonds;
        std::vector<int> hydrogens{0, 0};
        for (std::uint32_t i = 0; i < atoms; ++i) bonds.push_back({i, (i + 1) % atoms});
        hydrogens.resize(atoms, 2);
        return with_hydrogens(std::string_view("SSCCCCCCC").substr(0, atoms), bonds, hydrogens);
    };

    CHECK(build_joints(ring_of(8)).springs.empty());
    CHECK(build_joints(ring_of(8)).joints.empty());
    const Joints large = build_joints(ring_of(9));
    CHECK(large.springs == Bonds{{0, 1}});
    // Bonds to sulphur, whose other bond is cut, would turn nothing.
    CHECK(large.joints.size() == 6);
    const TorsionBodies bodies = build_bodies(ring_of(9), large);
    CHECK(bodies.molecules() == 1);
    CHECK(bodies.bodies.size() == 7);
    CHECK(bodies.springs == large.springs);
}

TEST_CASE("of two disulphides between chains the second is a spring", "[assembly][joints]") {
    // Two chains of ten carbons with a sulphur at each end.
    Bonds bonds{{20, 21}, {22, 23}, {0, 20}, {10, 21}, {9, 22}, {19, 23}};
    for (std::uint32_t i = 0; i < 9; ++i) {
        bonds.push_back({i, i + 1});
        bonds.push_back({i + 10, i + 11});
    }
    const Connectivity chains =
        with_hydrogens("CCCCCCCCCCCCCCCCCCCCSSSS", bonds, std::vector(20, 2));

    const Joints joints = build_joints(chains);

    CHECK(joints.springs == Bonds{{20, 21}});
    CHECK(build_bodies(chains, joints).molecules() == 1);
    CHECK(joints.joints.size() == bonds.size() - 3);
}

TEST_CASE("a scene's word on a bond goes before the rules", "[assembly][joints]") {
    const Connectivity butane = with_hydrogens("CCCC", {{0, 1}, {1, 2}, {2, 3}}, {3, 2, 2, 3});
    JointRules rules;

    rules.overrides = {{{2, 1}, BondMotion::Rigid}, {{3, 2}, BondMotion::Turn}};
    CHECK(bonds_of(build_joints(butane, rules)) == Bonds{{2, 3}});
    const Connectivity ring = with_hydrogens("CCC", {{0, 1}, {1, 2}, {2, 0}}, {2, 2, 2});
    rules.overrides = {{{2, 0}, BondMotion::Spring}};
    CHECK(build_joints(ring, rules).springs == Bonds{{0, 2}});
}

TEST_CASE("a scene is told which of its words on bonds cannot be met", "[assembly][joints]") {
    const Connectivity ring =
        with_hydrogens("CCCC", {{0, 1}, {1, 2}, {2, 0}, {0, 3}}, {1, 2, 2, 3});
    const auto error = [&](std::array<std::uint32_t, 2> bond, BondMotion motion) {
        return test::load_error_of([&] { build_joints(ring, {.overrides = {{bond, motion}}}); });
    };

    CHECK_THAT(
        error({0, 1}, BondMotion::Turn),
        Contains("molecule.psf: A MOL 1 C0 - A MOL 1 C1 cannot turn: this bond is in a ring"));
    CHECK_THAT(error({0, 4}, BondMotion::Turn), Contains("cannot turn"));
    CHECK_THAT(error({0, 3}, BondMotion::Spring), Contains("cannot be a spring"));
    CHECK_THAT(error({1, 3}, BondMotion::Rigid), Contains("are not bonded"));
}

TEST_CASE("bodies hang on their parents by the bonds that turn", "[assembly][bodies]") {
    // Two molecules: butanol, whose atoms come last first, and water.
    const Connectivity molecules = molecule_of("HOCCCCOHHHHHHHHHHH", {{0, 1},
                                                                      {1, 2},
                                                                      {2, 3},
                                                                      {3, 4},
                                                                      {4, 5},
                                                                      {6, 7},
                                                                      {6, 8},
                                                                      {2, 9},
                                                                      {2, 10},
                                                                      {3, 11},
                                                                      {3, 12},
                                                                      {4, 13},
                                                                      {4, 14},
                                                                      {5, 15},
                                                                      {5, 16},
                                                                      {5, 17}});

    const TorsionBodies bodies = build_bodies(molecules, build_joints(molecules));

    REQUIRE(bodies.bodies.size() == 5);
    CHECK(bodies.molecules() == 2);
    CHECK(bodies.degrees_of_freedom() == 3 + 12);
    CHECK(bodies.is_base(0));
    CHECK(bodies.body_of ==
          std::vector<std::uint32_t>{0, 0, 1, 2, 3, 3, 4, 4, 4, 1, 1, 2, 2, 3, 3, 3, 3, 3});
    for (std::size_t b = 1; b < 4; ++b) {
        CHECK(bodies.bodies[b].parent == b - 1);
        CHECK(bodies.bodies[b].axis ==
              std::array<std::uint32_t, 2>{static_cast<std::uint32_t>(b),
                                           static_cast<std::uint32_t>(b) + 1});
    }
    CHECK(bodies.is_base(4));
}

TEST_CASE("a base atom makes its body the base, and its molecule one of the first",
          "[assembly][bodies]") {
    // Butanol, water, an ion.
    const Connectivity molecules =
        with_hydrogens("CCCCOOF", {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, {3, 2, 2, 2, 1, 2, 0});
    const Joints joints = build_joints(molecules);
    const auto bodies_with = [&](const std::vector<std::uint32_t>& base_atoms) {
        return build_bodies(molecules, joints, base_atoms);
    };
    REQUIRE(joints.joints.size() == 3);

    const TorsionBodies plain = bodies_with({});
    CHECK(plain.body_of[0] == 0);
    CHECK(plain.is_base(plain.body_of[0]));

    // Water first, then the alcohol by its oxygen, whose carbon 0 comes too late; then the rest.
    const TorsionBodies bodies = bodies_with({5, 4, 0});
    CHECK(bodies.molecules() == 3);
    CHECK(bodies.joints() == 3);
    CHECK(bodies.body_of[5] == 0);
    CHECK(bodies.body_of[4] == 1);
    CHECK(bodies.is_base(1));
    CHECK_FALSE(bodies.is_base(bodies.body_of[0]));
    CHECK(bodies.is_base(bodies.body_of[6]));
    CHECK(bodies.body_of[6] + 1 == bodies.bodies.size());
    // Axes lead away from the base.
    for (const Body& body : bodies.bodies) {
        if (body.parent == no_body) continue;
        CHECK(bodies.body_of[body.axis[0]] == body.parent);
    }
    CHECK(bodies.bodies[bodies.body_of[3]].axis == std::array<std::uint32_t, 2>{4, 3});
    CHECK(bodies.bodies[bodies.body_of[1]].axis == std::array<std::uint32_t, 2>{2, 1});

    // An atom in the middle: branches lead both ways.
    const TorsionBodies middle = bodies_with({2});
    CHECK(middle.body_of[2] == 0);
    CHECK(middle.bodies[middle.body_of[1]].axis == std::array<std::uint32_t, 2>{2, 1});
    CHECK(middle.bodies[middle.body_of[3]].axis == std::array<std::uint32_t, 2>{2, 3});
}
