// Splits molecules into rigid bodies joined by rotatable bonds (torsions).
#pragma once
#include "assembly/joints.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpa {

inline constexpr std::uint32_t no_body = std::numeric_limits<std::uint32_t>::max();

// A body and the joint by which it is attached to its parent: both go by one number. The base of a
// molecule has no joint; six degrees of freedom carry it.
struct Body {
    std::uint32_t parent = no_body;
    // The axis j -> k, j an atom of the parent and k of this body. A turn is positive where k's
    // side turns right-handed about it.
    std::array<std::uint32_t, 2> axis{};
};

struct TorsionBodies {
    std::vector<Body> bodies;                           // a parent before its children
    std::vector<std::uint32_t> body_of;                 // body of each atom
    std::vector<std::array<std::uint32_t, 2>> springs;  // atom pairs of bonds that were cut

    bool is_base(std::size_t body) const noexcept { return bodies[body].parent == no_body; }
    std::size_t molecules() const noexcept;
    std::size_t joints() const noexcept { return bodies.size() - molecules(); }
    // Degrees of freedom if all bases are free.
    std::size_t degrees_of_freedom() const noexcept { return joints() + 6 * molecules(); }
};

// Molecules are what is bonded: first those of `base_atoms`, which their bases hold, then the
// others in the order of their first atoms, which theirs do. Of two base atoms of one molecule the
// first counts.
TorsionBodies build_bodies(const Connectivity& connectivity, const Joints& joints,
                           std::span<const std::uint32_t> base_atoms = {});

// The molecule of each body. Molecules are in the order of their bases.
std::vector<std::uint32_t> molecules_of(const TorsionBodies& bodies);

}  // namespace palpa
