// The assembly tree: the order in which rigid bodies are joined to molecules, two parts at a time.
#pragma once
#include "assembly/bodies.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpa {

inline constexpr std::uint32_t no_node = std::numeric_limits<std::uint32_t>::max();

// A part of a molecule: one rigid body, or two parts joined. (R. Featherstone, Int. J. Robotics
// Research 18, 867 (1999); S. Redon et al., ACM Trans. Graph. 24, 936 (2005).)
//
// A part meets the rest of its molecule, and the ground, at one to three *handles*, each the place
// of a link that leads out of it. Handles stand in an order such that the link by which the part is
// joined to its partner comes last.
//
// Links go by number: the joint of body b is link b; where b is a base, link b leads to the ground,
// which holds it or lets it go. A body with more than three links is taken as several copies of
// itself with equal shares of mass and force, in a row and rigidly linked; their links come after.
struct AssemblyNode {
    // Of a joined part; the child side of the link is B. no_node for a body.
    std::uint32_t a = no_node, b = no_node;
    std::uint32_t link = no_node;  // link that joins A and B
    std::uint32_t body = no_body;  // body of a leaf
    std::uint32_t parent = no_node;

    std::uint32_t handles = 0;
    std::array<std::uint32_t, 3> links{};  // link of each handle
    // Of a joined part: each handle's side, 0 for A and 1 for B, and its number there.
    std::array<std::uint8_t, 3> side{}, number{};

    // Of a joined part: where the state keeps what belongs to it, to its handles and to pairs of
    // them.
    std::uint32_t part = 0, first_handle = 0, first_pair = 0;

    bool is_leaf() const noexcept { return body != no_body; }
};

struct AtomShare {
    std::uint32_t atom;
    double mass;  // amu
};

struct AssemblyTree {
    TorsionBodies bodies;
    std::vector<std::uint32_t> molecule_of;  // molecule of each body
    std::vector<std::uint32_t> bases;        // base body of each molecule

    std::vector<AssemblyNode> nodes;  // children before their parents
    std::vector<std::uint32_t>
        roots;                // root node of each molecule; its single handle leads to the ground
    std::uint32_t links = 0;  // total number of links
    // Of joined parts: how many there are, and how many handles and pairs of them they have.
    std::uint32_t parts = 0, handles = 0, pairs = 0;

    // What a body weighs, [first_share[b], first_share[b + 1]). Both atoms of a joint's bond lie on
    // its axis and so are at rest in both bodies: their mass is divided between the bodies that
    // share them. That changes no motion, and gives a body of one or two atoms an inertia that can
    // be inverted.
    std::vector<std::uint32_t> first_share;
    std::vector<AtomShare> shares;
    std::vector<std::uint32_t> first_atom;  // the same for the body's own atoms
    std::vector<std::uint32_t> atoms;

    std::vector<double> copies;           // for each body
    std::vector<std::uint8_t> is_linear;  // for each body: whether all its atoms are collinear
    std::size_t depth = 0;                // largest number of joins between a root and a body
};

// Positions tell which bodies have all atoms in line (Å; only angles of bonds matter, which stay).
// Such a body must be a molecule of its own: throws LoadError where a joint next to it would turn
// nothing. Masses in amu, above 0.
AssemblyTree build_assembly_tree(const TorsionBodies& bodies, std::span<const double> masses,
                                 std::span<const Vec3> positions);

}  // namespace palpa
