// The field of points that stay where they are on a group that moves, in single precision and as
// wide as the processor at hand can: what a servo tick can afford. Its reference implementation, in
// double, is field/pair_field.h.
#pragma once
#include "field/pair_field.h"
#include "math/rigid_motion.h"
#include "math/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// Sixteen points of the environment; a coordinate is high + low as in field/pair_kernel.h.
struct alignas(64) FrozenPoints {
    using Column = std::array<float, 16>;

    std::array<Column, 3> high, low;  // Å, from the origin
    Column charge;                    // e
    Column sqrt_epsilon;              // (kcal/mol)^(1/2)
    Column half_rmin;                 // Å
};

// The numbers that one type of the group has with sixteen points of the environment, replaced pairs
// included.
struct alignas(64) FrozenNumbers {
    FrozenPoints::Column epsilon12;  // 12 times the depth, kcal/mol
    FrozenPoints::Column rmin;       // Å
};

// The numbers of solvation of sixteen points of the environment, as in field/solvation_kernel.h.
struct alignas(64) FrozenSolvation {
    FrozenPoints::Column volume, strength, scale, offset;
    bool counts = false;  // for any of them
};

// Where sixteen points are: the box around them, Å from the origin, by axis; of sixteen sixteens.
struct alignas(64) FrozenBoxes {
    std::array<FrozenPoints::Column, 3> centre, half;
};

// Of an environment and a group but for the group's place; constant after building.
struct FrozenField {
    double coulomb_constant = 0;  // kcal Å/mol/e^2; over eps with smooth ends
    std::optional<SmoothEnds> smooth;
    Vec3 origin = Vec3::Zero();
    std::vector<FrozenPoints> points;
    // With smooth ends alone, of each of `points`.
    std::vector<FrozenSolvation> solvation;
    std::vector<FrozenBoxes> boxes;
    double largest_half_rmin = 0;  // Å, of the environment

    // Types of the group that have a replaced pair here, each with a row of `points.size()`.
    std::vector<FrozenNumbers> numbers;

    struct GroupPoint {
        float charge;     // times the Coulomb constant
        float epsilon12;  // 12 sqrt(epsilon)
        float half_rmin;
        std::int32_t row;                       // of `numbers`, -1 for the combination rules
        float volume, strength, scale, offset;  // as in `FrozenSolvation`
    };
    std::vector<GroupPoint> group;

    // What the reference takes, where single precision does not do.
    struct Points {
        std::vector<Vec3> positions;
        std::vector<double> charge, sqrt_epsilon, half_rmin;
        std::vector<std::uint32_t> type;
        std::vector<double> volume, strength, inverse_lambda, radius;
    };
    Points environment, group_numbers;  // the latter without positions
    std::vector<ReplacedPair> replaced;
};

// The positions of the group do not matter. With smooth ends only sixteens of the environment
// within reach are looked at, so one in the order of `order_for_sixteens` takes the least time.
FrozenField build_frozen_field(const FieldPoints& group, const FieldPoints& environment,
                               const PairRule& rule);

// An order of points in which those of each sixteen are near each other, first those of which
// `has_solvation` (empty, or one entry per point) says so: the numbers of the points.
std::vector<std::uint32_t> order_for_sixteens(std::span<const Vec3> positions,
                                              std::span<const std::uint8_t> has_solvation = {});

// What the environment does to the group as a whole, as in FieldSum, and what limits how far the
// group may go.
struct FrozenSum {
    Vec3 force = Vec3::Zero();      // kcal/mol/Å
    Vec3 torque = Vec3::Zero();     // about the origin, kcal/mol
    Mat3 stiffness = Mat3::Zero();  // kcal/mol/Å^2
    // The least of r - Rmin of all pairs, Å, below 0 where they repel; infinite without pairs. With
    // smooth ends a bound below it where it is more than their reach less the largest Rmin.
    double clearance = std::numeric_limits<double>::infinity();
    double largest_force = 0;  // on any point of the group, kcal/mol/Å

    Vec3 torque_about(const Vec3& place) const noexcept { return torque - place.cross(force); }
};

// As `evaluate_pair_field`, of the group moved by `motion`. Pairs are in single precision, sums
// over more than some hundreds in double; with two points nearer than `nearest_single_precision`,
// or one further than `farthest_single_precision` from the middle of the environment
// (field/pair_kernel.h), all is the reference's. Repeats to the bit on the same kind of processor.
// Without allocation or lock.
//
// Against the reference: force, torque (about the origin of the frozen field, in a lever of 1 Å at
// least) and stiffness within 2e-6 of the sum of all pairs' magnitudes; the clearance within 1e-5
// Å, the largest force within 2e-6 of the sum of the point's pairs.
FrozenSum evaluate_frozen_field(const FrozenField& field, std::span<const Vec3> group,
                                const RigidMotion& motion = {}) noexcept;

// All that `evaluate_pair_field` finds, of the group where it is: the same with energies, of the
// same precision; each of the two energies within 1e-6 of the sum of its pairs' magnitudes.
FieldSum evaluate_field_and_energies(const FrozenField& field,
                                     std::span<const Vec3> group) noexcept;

// Where the points of both sides move with three coordinates: column c of a matrix is how far a
// point goes per Å of coordinate c. Constant after building.
struct FollowingPoints {
    std::vector<Mat3> group, environment;
    // Those of the environment again, element (axis, c) as [3 c + axis], in sixteens.
    std::vector<std::array<FrozenPoints::Column, 9>> sixteens;
};

FollowingPoints build_following_points(std::vector<Mat3> group, std::vector<Mat3> environment);

// What an evaluation writes to, so that it allocates nothing; of one field.
struct FollowingMemory {
    std::vector<Vec3> group, environment;
    std::vector<FrozenPoints> points;
    std::vector<FrozenBoxes> boxes;
};

FollowingMemory build_following_memory(const FrozenField& field);

struct FollowingSum {
    FrozenSum sum;              // as of a frozen field, where the points are now
    Vec3 along = Vec3::Zero();  // minus the energy's slope along the coordinates, kcal/mol/Å
    Mat3 slope = Mat3::Zero();  // and its curvature, kcal/mol/Å^2
};

// With the points where the coordinates `by` (Å) bring them. Precision as above; repeats to the
// bit, without allocation or lock.
FollowingSum evaluate_following_field(const FrozenField& field, std::span<const Vec3> group,
                                      const FollowingPoints& following, const Vec3& by,
                                      FollowingMemory& memory) noexcept;

}  // namespace palpa
