// Second derivatives of Lennard-Jones, Coulomb and solvation energies between rigid bodies that are
// joined in trees: pairs in single precision, as wide as the processor allows. The reference
// implementation in double is statics/second_derivatives.h.
//
// Let E_ij be a function of u = r^2/2, T_i the matrix that turns a screw (math/spatial.h) into the
// velocity of atom i, and d the vector from j to i. The block of two bodies is
//     D_AB = sum over i in A, j in B of T_i^T (E' 1 + E'' d d^T) T_j.
// The result is S_a^T D S_b for all pairs of screws, D summed over all bodies that hang on a and
// on b. Bodies are ordered so that those that hang on a body come before it. Sixteen rows are
// processed side by side. Column sums go up the tree immediately, so few blocks exist at a time;
// then row sums do the same.
#pragma once
#include "field/pair_kernel.h"
#include "field/solvation_parameters.h"
#include "math/spatial.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpa {

inline constexpr std::size_t hessian_lanes = 16;    // pieces of bodies beside each other
inline constexpr std::size_t hessian_places = 4;    // atoms of a piece, at most
inline constexpr std::size_t hessian_numbers = 27;  // of a block: see HessianBlock
inline constexpr std::size_t hessian_block = 8;     // motions beside each other
inline constexpr std::uint32_t no_number = std::numeric_limits<std::uint32_t>::max();

// Bodies and their atoms. A body comes after the one that it is attached to.
struct BodyTreeView {
    std::span<const std::uint32_t> parents;     // of each body; no_number where there is none
    std::span<const std::uint32_t> first_atom;  // of body b: atoms[first_atom[b]] and on
    std::span<const std::uint32_t> atoms;
    std::span<const std::uint32_t> motions;  // how many each body has by itself
};

// One number of each of sixteen pieces.
struct alignas(64) LaneFloats {
    std::array<float, hessian_lanes> at{};
};
struct alignas(64) LaneDoubles {
    std::array<double, hessian_lanes> at{};
};

// A block of each lane: of the upper left 3x3 part the symmetric half (xx, xy, xz, yy, yz, zz) and
// the vector of the skew half; the upper right part, row by row; the vector q, by which the lower
// left is [q]x more than the transpose of that; and the lower right part.
struct HessianBlock {
    std::array<LaneDoubles, 6> turns;
    std::array<LaneDoubles, 3> skew;
    std::array<LaneDoubles, 9> mixed;
    std::array<LaneDoubles, 3> q;
    std::array<LaneDoubles, 6> shifts;
};

// Where the sum over what is attached to a body stands, and where it is added next: the same slot
// where it is handed on to the parent, no_number where there is none.
struct HessianStep {
    std::uint32_t slot = 0, to = no_number;
};

// Body p of the order.
struct HessianColumn {
    std::uint32_t body = 0;
    std::uint32_t first_atom = 0, end_atom = 0;      // in HessianPlan::atoms
    std::uint32_t first_motion = 0, end_motion = 0;  // in HessianPlan::motions
    HessianStep step;
    bool is_leaf = false;           // nothing is attached to it
    std::uint32_t first_block = 0;  // of motions that its rows have to do with
};

// Pairs of a panel and a column of which not all count: of place k and atom j of the column the
// bits of the lanes, at HessianPlan::masks[first + k (atoms of the column) + j].
struct HessianMask {
    std::uint32_t column;
    std::size_t first;
};

// A pair whose numbers are not combined: taken in double, by what the caller says of it.
struct HessianExtra {
    std::uint32_t column, lane;
    std::uint32_t i, j;  // atoms, of the row and the column
    std::uint32_t number;
};

// Sixteen pieces, of bodies that follow each other.
struct HessianPanel {
    std::array<std::uint32_t, hessian_lanes> column{};  // the body's; no_number: no piece
    std::uint16_t is_first = 0, is_last = 0;  // a bit for each lane: of the pieces of its body
    std::array<std::array<std::uint32_t, hessian_lanes>, hessian_places> atoms{};  // or no_number
    std::uint32_t first_column = 0;
    std::uint32_t first_mask = 0, end_mask = 0, first_extra = 0, end_extra = 0;
};

struct HessianPlan {
    std::vector<HessianColumn> columns;
    std::vector<std::uint32_t> atoms;    // of the columns, one column after the other
    std::vector<std::uint32_t> motions;  // numbers as the caller has them
    std::vector<HessianPanel> panels;
    std::vector<HessianMask> masks_of;  // panel by panel, columns rising
    std::vector<std::uint16_t> masks;
    std::vector<HessianExtra> extras;  // panel by panel, columns rising
    std::uint32_t slots = 0;

    // Of each place and lane of a panel, and of each atom of the columns: what never changes.
    struct Numbers {
        LaneFloats charge, epsilon12, half_rmin;
        LaneFloats volume, strength, scale, offset;  // as of SolvationCluster
    };
    std::vector<std::array<Numbers, hessian_places>> row_numbers;
    std::vector<float> charge, sqrt_epsilon, half_rmin;
    std::vector<float> volume, strength, scale, offset;

    // Of motions, the last may be not full.
    std::size_t blocks() const noexcept {
        return (motions.size() + hessian_block - 1) / hessian_block;
    }
};

// `left_out`: pairs that no combined numbers are for, each once, either way round; from
// `first_replaced` on they are to be taken in double. Pairs within one body are left out anyway.
HessianPlan build_hessian_plan(const BodyTreeView& tree, const PairParameters& parameters,
                               const SolvationParameters& solvation,
                               std::span<const std::array<std::uint32_t, 2>> left_out,
                               std::size_t first_replaced);

// E' and E'' of a pair.
struct RadialSlopes {
    double first = 0, second = 0;
};

struct alignas(64) MotionBlock {
    std::array<double, hessian_block> at{};
};
struct alignas(64) WrenchBlock {
    std::array<std::array<double, hessian_block>, 6> at{};
};

// What one call finds, and its memory. Screws and wrenches are about the origin of the call.
struct HessianSums {
    // Of motions a and b of the plan: row a, blocks of b. -S_a^T D S_b, where D has of each pair of
    // bodies one order only: the sum of this and its transpose is what is wanted. There is room for
    // some numbers more than there are motions.
    std::vector<MotionBlock> products;
    std::size_t blocks = 0;  // of a row
    // Of motion a: the sum over all rows of D S_a.
    std::vector<WrenchBlock> wrenches;
    // Of body b: the sum over all columns of D_b.
    std::vector<Mat6> rows;

    struct Workspace {
        std::vector<float> x, y, z;  // of the columns, from the panel's origin
        std::vector<HessianBlock> column_slots;
        std::vector<std::uint8_t> has_started;          // of each of these
        std::array<Vec3, hessian_lanes> lane_points;    // about which each lane's block is, Å
        std::vector<std::array<LaneDoubles, 6>> panel;  // D S of each motion
        std::vector<WrenchBlock> row_slots;             // [block][slot]
        std::vector<std::array<double, 6>> screws;      // of the plan's motions
        std::vector<double> radius;                     // of each column's atoms, Å
        std::vector<Vec3> centre;                       // of these, from the origin
    } workspace;
};

// Whether the kernel has such a scheme: none of both, or both forces switched, with a constant
// dielectric; and both smooth ends with one that grows with the distance, which may have solvation.
bool has_hessian_kernel(const PairScheme& scheme) noexcept;

// False where a sum is not finite, as of atoms at one place. `screws` of each motion as the caller
// numbers them, about `origin`; of the replaced pairs each one's slopes. `rows` of products are
// wanted, as many as there are motions or more; what there is more is zero.
bool update_hessian_sums(const HessianPlan& plan, const PairScheme& scheme,
                         std::span<const Vec3> positions, const Vec3& origin,
                         std::span<const Vec6> screws, std::span<const RadialSlopes> replaced,
                         std::size_t rows, HessianSums& sums);

}  // namespace palpa
