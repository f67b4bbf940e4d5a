#include "field/frozen_field.h"

#include "core/assertion.h"
#include "field/frozen_job.h"
#include "field/grid.h"
#include "field/pair_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/frozen_field.cpp"
#include <hwy/foreach_target.h>  // before highway.h

#include "field/pair_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {

// In single precision, of one point with some hundred others.
struct Partial {
    HWY_INLINE Partial() {
        lj12 = coulomb = fx = fy = fz = hn::Zero(floats);
        kxx = kxy = kxz = kyy = kyz = kzz = gradients = hn::Zero(floats);
    }

    V lj12, coulomb, fx, fy, fz, kxx, kxy, kxz, kyy, kyz, kzz, gradients;
};

HWY_INLINE W both_halves(V v) { return hn::Add(lower_half(v), upper_half(v)); }

// In double.
class Total {
public:
    HWY_INLINE Total() {
        lj12_ = coulomb_ = fx_ = fy_ = fz_ = tx_ = ty_ = tz_ = hn::Zero(doubles);
        kxx_ = kxy_ = kxz_ = kyy_ = kyz_ = kzz_ = gradients_ = hn::Zero(doubles);
        own_x_ = own_y_ = own_z_ = hn::Zero(doubles);
    }

    HWY_INLINE void add(const Partial& part, const Vec3& place) {
        lj12_ = hn::Add(lj12_, both_halves(part.lj12));
        coulomb_ = hn::Add(coulomb_, both_halves(part.coulomb));
        const W fx = both_halves(part.fx), fy = both_halves(part.fy), fz = both_halves(part.fz);
        fx_ = hn::Add(fx_, fx);
        fy_ = hn::Add(fy_, fy);
        fz_ = hn::Add(fz_, fz);
        const W x = hn::Set(doubles, place.x()), y = hn::Set(doubles, place.y()),
                z = hn::Set(doubles, place.z());
        tx_ = hn::Add(tx_, hn::Sub(hn::Mul(y, fz), hn::Mul(z, fy)));
        ty_ = hn::Add(ty_, hn::Sub(hn::Mul(z, fx), hn::Mul(x, fz)));
        tz_ = hn::Add(tz_, hn::Sub(hn::Mul(x, fy), hn::Mul(y, fx)));
        kxx_ = hn::Add(kxx_, both_halves(part.kxx));
        kxy_ = hn::Add(kxy_, both_halves(part.kxy));
        kxz_ = hn::Add(kxz_, both_halves(part.kxz));
        kyy_ = hn::Add(kyy_, both_halves(part.kyy));
        kyz_ = hn::Add(kyz_, both_halves(part.kyz));
        kzz_ = hn::Add(kzz_, both_halves(part.kzz));
        gradients_ = hn::Add(gradients_, both_halves(part.gradients));
        own_x_ = hn::Add(own_x_, fx);
        own_y_ = hn::Add(own_y_, fy);
        own_z_ = hn::Add(own_z_, fz);
    }

    // After the last part of a point.
    HWY_INLINE void end_point() {
        const Vec3 force(sum_of(own_x_), sum_of(own_y_), sum_of(own_z_));
        largest2_ = std::max(largest2_, force.squaredNorm());
        own_x_ = own_y_ = own_z_ = hn::Zero(doubles);
    }

    FrozenSum sum() const {
        FrozenSum sum;
        sum.largest_force = std::sqrt(largest2_);
        sum.van_der_waals = sum_of(lj12_) / 12;
        sum.electrostatic = sum_of(coulomb_);
        sum.force = Vec3(sum_of(fx_), sum_of(fy_), sum_of(fz_));
        sum.torque = Vec3(sum_of(tx_), sum_of(ty_), sum_of(tz_));
        const double xy = sum_of(kxy_), xz = sum_of(kxz_), yz = sum_of(kyz_);
        sum.stiffness << sum_of(kxx_), xy, xz, xy, sum_of(kyy_), yz, xz, yz, sum_of(kzz_);
        sum.stiffness.diagonal().array() -= sum_of(gradients_);
        return sum;
    }

private:
    W lj12_, coulomb_, fx_, fy_, fz_, tx_, ty_, tz_;
    W kxx_, kxy_, kxz_, kyy_, kyz_, kzz_, gradients_;
    W own_x_, own_y_, own_z_;  // of the point at hand
    double largest2_ = 0;
};

// Nearest of all pairs.
struct Nearest {
    HWY_INLINE Nearest() { r2 = clearance = all(std::numeric_limits<float>::infinity()); }

    V r2, clearance;
};

// The point that the others act on.
struct Point {
    V high_x, high_y, high_z, low_x, low_y, low_z, charge, epsilon12, half_rmin;
};

// d from the environment's points to the group's: as in field/pair_field.cpp.
HWY_INLINE void add_pairs(const Point& point, const FrozenPoints& others, std::size_t at,
                          V epsilon12, V rmin, Nearest& nearest, Partial& sum) {
    const auto column = [&](const FrozenPoints::Column& c)
                            HWY_ATTR { return hn::Load(floats, c.data() + at); };
    const V dx = hn::Add(hn::Sub(point.high_x, column(others.high[0])),
                         hn::Sub(point.low_x, column(others.low[0])));
    const V dy = hn::Add(hn::Sub(point.high_y, column(others.high[1])),
                         hn::Sub(point.low_y, column(others.low[1])));
    const V dz = hn::Add(hn::Sub(point.high_z, column(others.high[2])),
                         hn::Sub(point.low_z, column(others.low[2])));
    const V r2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
    nearest.r2 = hn::Min(nearest.r2, r2);
    const V inverse_r = inverse_root(r2), inverse_r2 = hn::Mul(inverse_r, inverse_r);
    nearest.clearance = hn::Min(nearest.clearance, hn::MulSub(r2, inverse_r, rmin));
    const V s = hn::Mul(rmin, inverse_r), s2 = hn::Mul(s, s);
    const V s6 = hn::Mul(hn::Mul(s2, s2), s2), well = hn::Mul(epsilon12, s6);
    const V coulomb = hn::Mul(hn::Mul(point.charge, column(others.charge)), inverse_r);
    sum.lj12 = hn::MulAdd(well, hn::Sub(s6, all(2)), sum.lj12);
    sum.coulomb = hn::Add(sum.coulomb, coulomb);
    const V gradient = hn::Mul(hn::MulAdd(well, hn::Sub(s6, all(1)), coulomb), inverse_r2);
    const V curvature =
        hn::Mul(hn::Mul(hn::MulAdd(well, hn::MulSub(s6, all(14), all(8)), hn::Mul(coulomb, all(3))),
                        inverse_r2),
                inverse_r2);
    sum.fx = hn::MulAdd(gradient, dx, sum.fx);
    sum.fy = hn::MulAdd(gradient, dy, sum.fy);
    sum.fz = hn::MulAdd(gradient, dz, sum.fz);
    sum.gradients = hn::Add(sum.gradients, gradient);
    const V cx = hn::Mul(curvature, dx), cy = hn::Mul(curvature, dy), cz = hn::Mul(curvature, dz);
    sum.kxx = hn::MulAdd(cx, dx, sum.kxx);
    sum.kxy = hn::MulAdd(cx, dy, sum.kxy);
    sum.kxz = hn::MulAdd(cx, dz, sum.kxz);
    sum.kyy = hn::MulAdd(cy, dy, sum.kyy);
    sum.kyz = hn::MulAdd(cy, dz, sum.kyz);
    sum.kzz = hn::MulAdd(cz, dz, sum.kzz);
}

// Sixteens of points between two sums in double.
constexpr std::size_t most_sixteens = 64 * lane_count / 16 > 0 ? 64 * lane_count / 16 : 1;

FrozenJobSum sum_field(const FrozenField& field, std::span<const Vec3> group, const Vec3& origin) {
    Total total;
    Nearest nearest;
    for (std::size_t i = 0; i < group.size(); ++i) {
        const FrozenField::GroupPoint& own = field.group[i];
        const Vec3 place = group[i] - origin;
        const Vec3 high(rounded_to_grid(place.x()), rounded_to_grid(place.y()),
                        rounded_to_grid(place.z()));
        const Vec3 low = place - high;
        const Point point{all(high.x()),   all(high.y()),      all(high.z()),
                          all(low.x()),    all(low.y()),       all(low.z()),
                          all(own.charge), all(own.epsilon12), all(own.half_rmin)};
        const FrozenNumbers* const numbers =
            own.row < 0
                ? nullptr
                : field.numbers.data() + static_cast<std::size_t>(own.row) * field.points.size();
        for (std::size_t p = 0; p < field.points.size();) {
            const std::size_t end = std::min(p + most_sixteens, field.points.size());
            Partial part;
            if (numbers) {
                for (; p < end; ++p) {
                    for (std::size_t at = 0; at < 16; at += lane_count) {
                        add_pairs(point, field.points[p], at,
                                  hn::Load(floats, numbers[p].epsilon12.data() + at),
                                  hn::Load(floats, numbers[p].rmin.data() + at), nearest, part);
                    }
                }
            } else {
                for (; p < end; ++p) {
                    const FrozenPoints& others = field.points[p];
                    for (std::size_t at = 0; at < 16; at += lane_count) {
                        add_pairs(point, others, at,
                                  hn::Mul(point.epsilon12,
                                          hn::Load(floats, others.sqrt_epsilon.data() + at)),
                                  hn::Add(point.half_rmin,
                                          hn::Load(floats, others.half_rmin.data() + at)),
                                  nearest, part);
                    }
                }
            }
            total.add(part, place);
        }
        total.end_point();
    }
    FrozenJobSum result{total.sum(), hn::GetLane(hn::MinOfLanes(floats, nearest.r2))};
    result.sum.clearance = hn::GetLane(hn::MinOfLanes(floats, nearest.clearance));
    return result;
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {
namespace {

HWY_EXPORT(sum_field);

FrozenField::Points copy_points(const FieldPoints& points) {
    const auto copy = [](const auto& span) { return std::vector(span.begin(), span.end()); };
    return {copy(points.positions), copy(points.charge), copy(points.sqrt_epsilon),
            copy(points.half_rmin), copy(points.type)};
}

Vec3 middle_of(std::span<const Vec3> positions) noexcept {
    if (positions.empty()) return Vec3::Zero();
    Vec3 low = positions[0], high = low;
    for (const Vec3& place : positions) {
        low = low.cwiseMin(place);
        high = high.cwiseMax(place);
    }
    return 0.5 * (low + high);
}

void fill_points(FrozenField& field) {
    const FrozenField::Points& all = field.environment;
    field.points.assign((all.positions.size() + 15) / 16, {});
    for (std::size_t j = 0; j < 16 * field.points.size(); ++j) {
        FrozenPoints& points = field.points[j / 16];
        const std::size_t k = j % 16;
        if (j >= all.positions.size()) {
            // Far from all; without charge and well.
            for (auto& high : points.high) high[k] = 4e4F;
            continue;
        }
        const Vec3 place = all.positions[j] - field.origin;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double x = place(static_cast<Eigen::Index>(axis)), high = rounded_to_grid(x);
            points.high[axis][k] = static_cast<float>(high);
            points.low[axis][k] = static_cast<float>(x - high);
        }
        points.charge[k] = static_cast<float>(all.charge[j]);
        points.sqrt_epsilon[k] = static_cast<float>(all.sqrt_epsilon[j]);
        points.half_rmin[k] = static_cast<float>(all.half_rmin[j]);
    }
}

const ReplacedPair* find_replaced(const FrozenField& field, std::uint32_t a, std::uint32_t b) {
    // The last one counts, as for the twin.
    const auto found =
        std::find_if(field.replaced.rbegin(), field.replaced.rend(), [&](const ReplacedPair& pair) {
            return (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
        });
    return found == field.replaced.rend() ? nullptr : &*found;
}

// The row of a group's point with the environment, -1 where no pair of it is replaced.
std::int32_t add_row(FrozenField& field, std::size_t i) {
    const FrozenField::Points& own = field.group_numbers;
    const FrozenField::Points& others = field.environment;
    const bool is_replaced =
        !field.replaced.empty() &&
        std::any_of(others.type.begin(), others.type.end(), [&](std::uint32_t type) {
            return find_replaced(field, own.type[i], type) != nullptr;
        });
    if (!is_replaced) return -1;
    const std::size_t row = field.numbers.size() / field.points.size();
    field.numbers.resize(field.numbers.size() + field.points.size());
    FrozenNumbers* const numbers = field.numbers.data() + row * field.points.size();
    for (std::size_t j = 0; j < others.positions.size(); ++j) {
        const ReplacedPair* const pair = find_replaced(field, own.type[i], others.type[j]);
        const double epsilon = pair ? pair->epsilon : own.sqrt_epsilon[i] * others.sqrt_epsilon[j];
        const double rmin = pair ? pair->rmin : own.half_rmin[i] + others.half_rmin[j];
        numbers[j / 16].epsilon12[j % 16] = static_cast<float>(12 * epsilon);
        numbers[j / 16].rmin[j % 16] = static_cast<float>(rmin);
    }
    return static_cast<std::int32_t>(row);
}

void fill_group(FrozenField& field) {
    const FrozenField::Points& own = field.group_numbers;
    for (std::size_t i = 0; i < own.charge.size(); ++i) {
        // Points of one type and the same numbers share a row.
        std::size_t same = 0;
        while (same < i && (own.type.empty() || own.type[same] != own.type[i] ||
                            own.sqrt_epsilon[same] != own.sqrt_epsilon[i] ||
                            own.half_rmin[same] != own.half_rmin[i])) {
            ++same;
        }
        const std::int32_t row = same < i ? field.group[same].row : add_row(field, i);
        field.group.push_back({static_cast<float>(field.coulomb_constant * own.charge[i]),
                               static_cast<float>(12 * own.sqrt_epsilon[i]),
                               static_cast<float>(own.half_rmin[i]), row});
    }
}

bool is_near(std::span<const Vec3> points, const Vec3& origin) noexcept {
    return std::all_of(points.begin(), points.end(), [&](const Vec3& place) {
        return (place - origin).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <
               farthest_single_precision;
    });
}

FieldPoints view(const FrozenField::Points& points, std::span<const Vec3> positions,
                 std::size_t first, std::size_t count) noexcept {
    const auto part = [&](const auto& column) {
        return std::span(column).subspan(column.empty() ? 0 : first, column.empty() ? 0 : count);
    };
    return {positions, part(points.charge), part(points.sqrt_epsilon), part(points.half_rmin),
            part(points.type)};
}

double find_clearance(const FrozenField& field, std::size_t i, const Vec3& place) noexcept {
    const FrozenField::Points &own = field.group_numbers, &others = field.environment;
    double clearance = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < others.positions.size(); ++j) {
        const ReplacedPair* const pair =
            field.replaced.empty() ? nullptr : find_replaced(field, own.type[i], others.type[j]);
        const double rmin = pair ? pair->rmin : own.half_rmin[i] + others.half_rmin[j];
        clearance = std::min(clearance, (place - others.positions[j]).norm() - rmin);
    }
    return clearance;
}

// Point by point by the twin.
FrozenSum evaluate_in_double(const FrozenField& field, std::span<const Vec3> group,
                             const Vec3& shift) noexcept {
    FrozenSum sum;
    for (std::size_t i = 0; i < group.size(); ++i) {
        const Vec3 place = group[i] + shift;
        const FieldSum one =
            evaluate_pair_field(view(field.group_numbers, std::span(&place, 1), i, 1),
                                view(field.environment, field.environment.positions, 0,
                                     field.environment.positions.size()),
                                {field.coulomb_constant, field.replaced});
        sum.van_der_waals += one.van_der_waals;
        sum.electrostatic += one.electrostatic;
        sum.force += one.force;
        sum.torque += one.torque;
        sum.stiffness += one.stiffness;
        sum.largest_force = std::max(sum.largest_force, one.force.norm());
        sum.clearance = std::min(sum.clearance, find_clearance(field, i, place));
    }
    return sum;
}

}  // namespace

FrozenField build_frozen_field(const FieldPoints& group, const FieldPoints& environment,
                               const PairRule& rule) {
    FrozenField field;
    field.coulomb_constant = rule.coulomb_constant;
    field.environment = copy_points(environment);
    field.group_numbers = copy_points(group);
    field.group_numbers.positions.clear();
    field.replaced.assign(rule.replaced.begin(), rule.replaced.end());
    field.origin = middle_of(environment.positions);
    fill_points(field);
    fill_group(field);
    return field;
}

FrozenSum evaluate_frozen_field(const FrozenField& field, std::span<const Vec3> group,
                                const Vec3& shift) noexcept {
    PALPA_ASSERT(group.size() == field.group.size());
    const Vec3 origin = field.origin - shift;  // as the group where it was sees it
    if (is_near(group, origin) && is_near(field.environment.positions, field.origin)) {
        FrozenJobSum result = HWY_DYNAMIC_DISPATCH(sum_field)(field, group, origin);
        constexpr double nearest = nearest_single_precision;
        if (result.nearest2 > nearest * nearest) {
            result.sum.torque += field.origin.cross(result.sum.force);
            return result.sum;
        }
    }
    return evaluate_in_double(field, group, shift);
}

}  // namespace palpa
#endif  // HWY_ONCE
