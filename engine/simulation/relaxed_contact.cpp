#include "simulation/relaxed_contact.h"

#include "core/units.h"
#include "math/eigenvectors.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"

#include <algorithm>
#include <cstddef>

namespace palpa {
namespace {

// N/m. At the largest force gain and the smallest displacement gain near contact (5.1e9, 0.25e9) a
// handle feels -100 N/m of that, half of what a hand of 200 N/m holds still. The tail of an
// attraction between two waters has -2.5.
constexpr double softest = 5;

// N/m in a second. Along the way of TL-3 out of its pocket the stiffness changes by some 10 N/m in
// 0.3 Å; a hand takes more than a twentieth of a second for that.
constexpr double fastest_change = 200;

// Å per Å. An atom that goes farther is about to snap: what it meets on such a way is no force on
// the hand yet, and here it goes as far as this. On the way of TL-3 out of its pocket 2.5 to 4.5
// are usual, 18 at a snap.
constexpr double most_response = 6;

// A turn counts as the way of an atom so far from the axis, so that everything is in N/m.
constexpr double arm_angstrom = 5;

// The coordinates of a hand among those of all hands.
struct HandColumns {
    Eigen::Index first = 0;
    bool turns = false;

    Eigen::Index count() const noexcept { return turns ? 6 : 3; }
    Eigen::Index shift() const noexcept { return first + (turns ? 3 : 0); }
};

std::optional<HandColumns> find_columns(const SecondOrder& second, Entity hand) noexcept {
    const std::vector<HandHold>& holds = second.statics.renewals.lineariser.held.hands;
    HandColumns columns;
    for (std::size_t i = 0; i < second.hands.size(); ++i) {
        columns.turns = holds[i].turns;
        if (second.hands[i] == hand) return columns;
        columns.first += columns.count();
    }
    return {};
}

Vec6 scales(double turn, double shift) noexcept {
    Vec6 scale;
    scale << Vec3::Constant(turn), Vec3::Constant(shift);
    return scale;
}

Mat6 scaled(const Mat6& matrix, const Vec6& scale) noexcept {
    return scale.asDiagonal() * matrix * scale.asDiagonal();
}

// The stiffness that one hand feels in the directions in which it may move, N/m.
Mat6 stiffness_of(const Eigen::MatrixXd& all, const HandColumns& columns, const Mat3& free) {
    const Eigen::Index count = columns.count();
    Mat6 own = Mat6::Zero();
    own.bottomRightCorner(count, count) = all.block(columns.first, columns.first, count, count);
    Mat6 allowed = Mat6::Identity();
    allowed.bottomRightCorner<3, 3>() = free;
    own = allowed * scaled(own, scales(1 / arm_angstrom, 1)) * allowed;
    return 0.5 * units::newton_per_metre_per_kcal_per_mol_angstrom2 * (own + own.transpose());
}

// The hand's place, from that of the point of linearisation, Å.
Vec3 find_shift(const SecondOrder& second, const HandColumns& columns) {
    return second.statics.at.segment<3>(second.statics.linear->mobile() + columns.shift());
}

// How far the hand is from the point of linearisation, Å.
double find_age(const SecondOrder& second, const HandColumns& columns) {
    const Eigen::Index mobile = second.statics.linear->mobile();
    const Eigen::VectorXd& at = second.statics.at;
    const double shift = find_shift(second, columns).norm();
    if (!columns.turns) return shift;
    return std::max(shift, arm_angstrom * at.segment<3>(mobile + columns.first).norm());
}

template <typename F>
Mat6 with_eigenvalues(const Mat6& matrix, F&& changed) {
    const Eigenvectors<6> own = find_eigenvectors(matrix);
    const Vec6 values = own.values.unaryExpr(changed);
    return own.vectors * values.asDiagonal() * own.vectors.transpose();
}

}  // namespace

std::optional<RelaxedStiffness> find_relaxed_stiffness(const World& world,
                                                       const SecondOrder& second, Entity hand) {
    const std::optional<HandColumns> columns = find_columns(second, hand);
    if (!columns) return {};
    const LinearisedModel& linear = *second.statics.linear;
    const Mat3& free = grip_of(world, hand).projector;
    const Mat6 relaxed = stiffness_of(linear.relaxed_stiffness, *columns, free);
    const Mat6 frozen = stiffness_of(linear.frozen_stiffness, *columns, free);
    RelaxedStiffness result;
    result.matrix = scaled(bound_stiffness(relaxed, frozen, softest),
                           scales(arm_angstrom * units::metre_per_angstrom, 1));
    const SecondOrderSettings& settings = second.settings;
    if (settings.renews_at_once) {  // within the step, also beyond the region
        result.reach_angstrom =
            std::max(settings.farthest_hand - find_age(second, *columns), settings.stride);
    } else {
        result.reach_angstrom = find_farthest_hand(settings, second.statics);
        result.gone_angstrom = find_shift(second, *columns);
    }
    return result;
}

Mat3 find_relaxed_coupling(const World& world, const SecondOrder& second, Entity hand,
                           Entity other) {
    const std::optional<HandColumns> own = find_columns(second, hand);
    const std::optional<HandColumns> others = find_columns(second, other);
    if (!own || !others) return Mat3::Zero();
    const Mat3 coupling =
        second.statics.linear->relaxed_stiffness.block<3, 3>(own->shift(), others->shift());
    return units::newton_per_metre_per_kcal_per_mol_angstrom2 * grip_of(world, hand).projector *
           coupling;
}

std::optional<FollowingAtoms> find_following(const World& world, const SecondOrder& second,
                                             Entity hand, const LocalField& field,
                                             std::span<const std::uint32_t> environment) {
    const std::optional<HandColumns> columns = find_columns(second, hand);
    if (!columns || columns->turns) return {};
    // Skips atoms that the model does not have: they are fixed.
    const auto responses = [&](std::span<const std::uint32_t> atoms) {
        std::vector<std::uint32_t> known;
        std::vector<std::size_t> places;
        for (std::size_t i = 0; i < atoms.size(); ++i) {
            const auto atom = model_atoms_of(world).in_model(atoms[i]);
            if (!atom) continue;
            known.push_back(*atom);
            places.push_back(i);
        }
        const std::vector<Mat3> found =
            find_atom_responses(model_of(world), *second.statics.linear,
                                world.resource<TorsionState>(), columns->shift(), known);
        std::vector<Mat3> moves(atoms.size(), Mat3::Zero());
        for (std::size_t i = 0; i < found.size(); ++i)
            moves[places[i]] = found[i] * std::min(1.0, most_response / found[i].norm());
        return moves;
    };
    FollowingAtoms following;
    following.points =
        build_following_points(responses(held_atoms(world, hand)), responses(environment));
    double farthest = 1;
    for (const auto* const moves : {&following.points.group, &following.points.environment}) {
        for (const Mat3& move : *moves) farthest = std::max(farthest, move.norm());
    }
    // Not farther for fast hands: atoms that follow linearly so far come on each other.
    following.reach_angstrom = second.settings.farthest / farthest;
    following.memory = build_following_memory(field.frozen);
    following.at_step = evaluate_following_field(field.frozen, field.group, following.points,
                                                 Vec3::Zero(), following.memory);
    return following;
}

// With A = frozen + softest 1 and B = relaxed + softest 1, the bounds say 0 <= B <= A.
Mat6 bound_stiffness(const Mat6& relaxed, const Mat6& frozen, double softest) {
    constexpr double least = 1e-6;  // of `softest`, where the frozen one is below the bound itself
    const Mat6 lift = softest * Mat6::Identity();
    const Eigenvectors<6> upper = find_eigenvectors(Mat6(frozen + lift));
    const Vec6 roots = upper.values.cwiseMax(least * softest).cwiseSqrt();
    const Mat6 back = upper.vectors * roots.asDiagonal();
    const Mat6 there = upper.vectors * roots.cwiseInverse().asDiagonal();
    const Mat6 share = with_eigenvalues(there.transpose() * (relaxed + lift) * there,
                                        [](double x) { return std::clamp(x, 0.0, 1.0); });
    return back * share * back.transpose() - lift;
}

Mat6 limit_change(const Mat6& last, const Mat6& now, double most) {
    return last +
           with_eigenvalues(now - last, [&](double x) { return std::clamp(x, -most, most); });
}

void limit_change(const RelaxedStiffness& last, double period_s, RelaxedStiffness& now) {
    const double arm = arm_angstrom * units::metre_per_angstrom;
    const Vec6 scale = scales(1 / arm, 1);
    const Mat6 matrix = limit_change(scaled(last.matrix, scale), scaled(now.matrix, scale),
                                     fastest_change * period_s);
    now.matrix = scaled(matrix, scales(arm, 1));
}

}  // namespace palpa
