#include "assembly/tree.h"

#include "tests/support/load_error_of.h"
#include "tests/support/torsion_molecules.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <vector>

using namespace palpa;
using Catch::Matchers::Contains;
using test::TorsionCase;
using test::TorsionShape;

namespace {

AssemblyTree case_tree(const TorsionCase& c) {
    return build_assembly_tree(c.bodies, c.masses, c.positions);
}

// A handle of a joined part is the same link at the child where it comes from, and the link that
// joins is the last of both.
void check_handles(const AssemblyTree& tree, const AssemblyNode& node) {
    const AssemblyNode& a = tree.nodes[node.a];
    const AssemblyNode& b = tree.nodes[node.b];
    CHECK(a.links[a.handles - 1] == node.link);
    CHECK(b.links[b.handles - 1] == node.link);
    CHECK(a.handles + b.handles == node.handles + 2);
    for (std::size_t i = 0; i < node.handles; ++i) {
        const AssemblyNode& child = node.side[i] == 0 ? a : b;
        CHECK(node.number[i] + 1U < child.handles);
        CHECK(child.links[node.number[i]] == node.links[i]);
    }
}

}  // namespace

TEST_CASE("an assembly tree joins every body by every joint, once", "[assembly][tree]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (const std::size_t bodies : {1, 2, 3, 4, 5, 9, 40, 300}) {
        INFO(bodies << " bodies of shape " << static_cast<int>(shape));
        const TorsionCase c = test::torsion_case(7, bodies, shape);

        const AssemblyTree tree = case_tree(c);

        std::vector<int> joined(tree.links, 0);
        std::vector<double> leaves(bodies, 0);
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            const AssemblyNode& node = tree.nodes[i];
            CHECK((node.handles >= 1 && node.handles <= 3));
            if (node.is_leaf()) {
                ++leaves[node.body];
                continue;
            }
            CHECK((node.a < i && node.b < i));
            ++joined[node.link];
            check_handles(tree, node);
        }
        CHECK(leaves == tree.copies);
        REQUIRE(tree.roots.size() == 1);
        CHECK(tree.nodes[tree.roots[0]].parent == no_node);
        CHECK(tree.nodes[tree.roots[0]].links[0] == 0);
        CHECK(joined[0] == 0);  // the ground
        CHECK(std::ranges::count(joined, 1) == static_cast<std::ptrdiff_t>(tree.links) - 1);
    }
}

TEST_CASE("an assembly tree is about as deep as it must be", "[assembly][tree]") {
    const auto shape =
        GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Comb, TorsionShape::Star);
    for (const std::size_t bodies : {10, 100, 1000, 10000}) {
        const AssemblyTree tree = case_tree(test::torsion_case(3, bodies, shape));
        const double leaves = (static_cast<double>(tree.nodes.size()) + 1) / 2;
        INFO(bodies << " bodies of shape " << static_cast<int>(shape));
        CHECK(static_cast<double>(tree.depth) <= 2 * std::log2(leaves) + 1);
    }
}

TEST_CASE("bodies share the mass of the bonds between them", "[assembly][tree]") {
    const TorsionCase c = test::torsion_case(5, 50, TorsionShape::Tree);

    const AssemblyTree tree = case_tree(c);

    std::vector<double> mass(c.masses.size(), 0);
    for (const AtomShare& share : tree.shares) mass[share.atom] += share.mass;
    for (std::size_t i = 0; i < mass.size(); ++i) CHECK(mass[i] == Approx(c.masses[i]));
    CHECK(tree.atoms.size() == c.masses.size());
    for (std::size_t b = 0; b < 50; ++b) {
        for (std::uint32_t i = tree.first_atom[b]; i < tree.first_atom[b + 1]; ++i) {
            CHECK(c.bodies.body_of[tree.atoms[i]] == b);
        }
    }
}

TEST_CASE("a joint beside which all atoms are in line is refused", "[assembly][tree]") {
    TorsionCase c;
    // Water's oxygen with two hydrogens, and two atoms in line with it.
    c.bodies.bodies = {{}, {0, {0, 3}}};
    c.bodies.body_of = {0, 0, 0, 1, 1};
    c.masses = {16, 1, 1, 12, 14};
    c.positions = {{0, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {1.4, 0, 0}, {2.6, 0, 0}};

    CHECK_THAT(test::load_error_of([&] { case_tree(c); }), Contains("next to atom 4"));
    c.positions[4] = {2, 1, 0};
    CHECK_NOTHROW(case_tree(c));
}
