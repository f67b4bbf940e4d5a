#include "field/frozen_field.h"

#include "core/assertion.h"
#include "field/frozen_job.h"
#include "field/grid.h"
#include "field/pair_kernel.h"
#include "field/solvation_law.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/frozen_field.cpp"
#include <hwy/foreach_target.h>  // before highway.h

#include "field/smooth_law-inl.h"

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {

// In single precision, of one point with some hundred others; of the curvature a third.
struct Partial {
    HWY_INLINE Partial() {
        fx = fy = fz = hn::Zero(floats);
        kxx = kxy = kxz = kyy = kyz = kzz = gradients = hn::Zero(floats);
    }

    V fx, fy, fz, kxx, kxy, kxz, kyy, kyz, kzz, gradients;
};

HWY_INLINE W both_halves(V v) { return hn::Add(lower_half(v), upper_half(v)); }

// In double.
class Total {
public:
    HWY_INLINE Total() {
        fx_ = fy_ = fz_ = tx_ = ty_ = tz_ = hn::Zero(doubles);
        kxx_ = kxy_ = kxz_ = kyy_ = kyz_ = kzz_ = gradients_ = hn::Zero(doubles);
        own_x_ = own_y_ = own_z_ = hn::Zero(doubles);
    }

    HWY_INLINE void add(const Partial& part, const Vec3& place) {
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
        sum.force = Vec3(sum_of(fx_), sum_of(fy_), sum_of(fz_));
        sum.torque = Vec3(sum_of(tx_), sum_of(ty_), sum_of(tz_));
        const double xy = sum_of(kxy_), xz = sum_of(kxz_), yz = sum_of(kyz_);
        sum.stiffness << sum_of(kxx_), xy, xz, xy, sum_of(kyy_), yz, xz, yz, sum_of(kzz_);
        sum.stiffness *= 3;
        sum.stiffness.diagonal().array() -= sum_of(gradients_);
        return sum;
    }

private:
    W fx_, fy_, fz_, tx_, ty_, tz_;
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

// Vectors side by side: one alone waits for itself.
constexpr std::size_t abreast = lane_count < 16 ? 2 : 1;
using Row = std::array<V, abreast>;

template <typename F>
HWY_INLINE Row row_of(F&& element) {
    Row row;
    for (std::size_t k = 0; k < abreast; ++k) row[k] = element(k);
    return row;
}

HWY_INLINE Row load_row(const FrozenPoints::Column& column, std::size_t at) {
    return row_of([&](std::size_t k)
                      HWY_ATTR { return hn::Load(floats, column.data() + at + k * lane_count); });
}

// Some pairs: of the curvature a third; `well` is 12 epsilon s6.
struct Pairs {
    std::array<V, 3> d;
    V gradient, curvature, s6, well, coulomb;
};

// The same with smooth ends, and their energies; of Lennard-Jones 12 times.
struct SmoothPairs {
    std::array<V, 3> d;
    V gradient, curvature, van_der_waals, electrostatic, solvation;
};

// Nothing besides the sums of a frozen field.
struct NothingBesides {
    HWY_INLINE void begin_point(std::size_t /*i*/) {}
    template <class AnyPairs>
    HWY_INLINE void add(std::size_t /*sixteen*/, std::size_t /*at*/, const AnyPairs& /*pairs*/) {}
    HWY_INLINE void end_part() {}
};

class Energies {
public:
    HWY_INLINE Energies() {
        van_der_waals_ = electrostatic_ = solvation_ = hn::Zero(doubles);
        part_van_der_waals_ = part_electrostatic_ = part_solvation_ = hn::Zero(floats);
    }

    HWY_INLINE void begin_point(std::size_t /*i*/) {}

    HWY_INLINE void add(std::size_t /*sixteen*/, std::size_t /*at*/, const Pairs& pairs) {
        part_van_der_waals_ =
            hn::MulAdd(pairs.well, hn::Sub(pairs.s6, all(2)), part_van_der_waals_);
        part_electrostatic_ = hn::Add(part_electrostatic_, pairs.coulomb);
    }

    HWY_INLINE void add(std::size_t /*sixteen*/, std::size_t /*at*/, const SmoothPairs& pairs) {
        part_van_der_waals_ = hn::Add(part_van_der_waals_, pairs.van_der_waals);
        part_electrostatic_ = hn::Add(part_electrostatic_, pairs.electrostatic);
        part_solvation_ = hn::Add(part_solvation_, pairs.solvation);
    }

    HWY_INLINE void end_part() {
        van_der_waals_ = hn::Add(van_der_waals_, both_halves(part_van_der_waals_));
        electrostatic_ = hn::Add(electrostatic_, both_halves(part_electrostatic_));
        solvation_ = hn::Add(solvation_, both_halves(part_solvation_));
        part_van_der_waals_ = part_electrostatic_ = part_solvation_ = hn::Zero(floats);
    }

    void write(EnergyJobSum& sum) const {
        sum.van_der_waals = sum_of(van_der_waals_) / 12;
        sum.electrostatic = sum_of(electrostatic_);
        sum.solvation = sum_of(solvation_);
    }

private:
    V part_van_der_waals_, part_electrostatic_, part_solvation_;
    W van_der_waals_, electrostatic_, solvation_;  // twelve times the first
};

// What points that follow add, of one point of the group with the others. With D how far the one
// goes away from the other per Å of each coordinate, a pair's force f and stiffness k are D^T f and
// D^T k D along the coordinates.
class Following {
public:
    explicit HWY_INLINE Following(const FollowingPoints& points) : points_(points) {
        for (W& x : total_) x = hn::Zero(doubles);
    }

    HWY_INLINE void begin_point(std::size_t i) {
        for (std::size_t k = 0; k < 9; ++k)
            own_[k] = all(static_cast<float>(points_.group[i].data()[k]));
        for (V& x : part_) x = hn::Zero(floats);
    }

    template <class AnyPairs>
    HWY_INLINE void add(std::size_t sixteen, std::size_t at, const AnyPairs& pairs) {
        const std::array<FrozenPoints::Column, 9>& others = points_.sixteens[sixteen];
        std::array<V, 9> D;
        for (std::size_t k = 0; k < 9; ++k)
            D[k] = hn::Sub(own_[k], hn::Load(floats, others[k].data() + at));
        const auto product = [&](const V* a, const V* b) HWY_ATTR {
            return hn::MulAdd(a[2], b[2], hn::MulAdd(a[1], b[1], hn::Mul(a[0], b[0])));
        };
        std::array<V, 3> along;
        for (std::size_t c = 0; c < 3; ++c) {
            along[c] = product(pairs.d.data(), D.data() + 3 * c);
            part_[c] = hn::MulAdd(pairs.gradient, along[c], part_[c]);
        }
        const V third = hn::Mul(all(3), pairs.curvature);
        std::size_t k = 3;
        for (std::size_t c = 0; c < 3; ++c) {
            const V bent = hn::Mul(third, along[c]);
            for (std::size_t e = c; e < 3; ++e, ++k) {
                part_[k] = hn::MulAdd(bent, along[e], part_[k]);
                part_[k] = hn::NegMulAdd(pairs.gradient,
                                         product(D.data() + 3 * c, D.data() + 3 * e), part_[k]);
            }
        }
    }

    HWY_INLINE void end_part() {
        for (std::size_t k = 0; k < 9; ++k) {
            total_[k] = hn::Add(total_[k], both_halves(part_[k]));
            part_[k] = hn::Zero(floats);
        }
    }

    void write(FollowingJobSum& sum) const {
        std::size_t k = 3;
        for (Eigen::Index c = 0; c < 3; ++c) {
            sum.along[c] = sum_of(total_[static_cast<std::size_t>(c)]);
            for (Eigen::Index e = c; e < 3; ++e, ++k)
                sum.slope(c, e) = sum.slope(e, c) = sum_of(total_[k]);
        }
    }

private:
    const FollowingPoints& points_;
    std::array<V, 9> own_, part_;
    std::array<W, 9> total_;
};

// d from the environment's points to the group's: as in field/pair_field.cpp.
template <class Besides>
HWY_INLINE void add_pairs(const Point& point, const FrozenPoints& others, std::size_t at,
                          const Row& epsilon12, const Row& rmin, Nearest& nearest, Partial& sum,
                          std::size_t sixteen, Besides& besides) {
    const auto difference = [&](V own_high, V own_low, std::size_t axis) HWY_ATTR {
        const Row high = load_row(others.high[axis], at), low = load_row(others.low[axis], at);
        return row_of([&](std::size_t k) HWY_ATTR {
            return hn::Add(hn::Sub(own_high, high[k]), hn::Sub(own_low, low[k]));
        });
    };
    const Row dx = difference(point.high_x, point.low_x, 0);
    const Row dy = difference(point.high_y, point.low_y, 1);
    const Row dz = difference(point.high_z, point.low_z, 2);
    const Row r2 = row_of([&](std::size_t k) HWY_ATTR {
        return hn::MulAdd(dz[k], dz[k], hn::MulAdd(dy[k], dy[k], hn::Mul(dx[k], dx[k])));
    });
    const Row inverse_r = row_of([&](std::size_t k) HWY_ATTR { return inverse_root(r2[k]); });
    for (std::size_t k = 0; k < abreast; ++k) {
        nearest.r2 = hn::Min(nearest.r2, r2[k]);
        nearest.clearance = hn::Min(nearest.clearance, hn::MulSub(r2[k], inverse_r[k], rmin[k]));
    }
    const Row inverse_r2 =
        row_of([&](std::size_t k) HWY_ATTR { return hn::Mul(inverse_r[k], inverse_r[k]); });
    const Row s6 = row_of([&](std::size_t k) HWY_ATTR {
        const V s = hn::Mul(rmin[k], inverse_r[k]), s2 = hn::Mul(s, s);
        return hn::Mul(hn::Mul(s2, s2), s2);
    });
    const Row well = row_of([&](std::size_t k) HWY_ATTR { return hn::Mul(epsilon12[k], s6[k]); });
    const Row charge = load_row(others.charge, at);
    const Row coulomb = row_of([&](std::size_t k) HWY_ATTR {
        return hn::Mul(hn::Mul(point.charge, charge[k]), inverse_r[k]);
    });
    const Row gradient = row_of([&](std::size_t k) HWY_ATTR {
        return hn::Mul(hn::MulAdd(well[k], hn::Sub(s6[k], all(1)), coulomb[k]), inverse_r2[k]);
    });
    const Row curvature = row_of([&](std::size_t k) HWY_ATTR {
        const V third =
            hn::MulAdd(well[k], hn::MulSub(s6[k], all(14.0 / 3), all(8.0 / 3)), coulomb[k]);
        return hn::Mul(hn::Mul(third, inverse_r2[k]), inverse_r2[k]);
    });
    for (std::size_t k = 0; k < abreast; ++k) {
        sum.fx = hn::MulAdd(gradient[k], dx[k], sum.fx);
        sum.fy = hn::MulAdd(gradient[k], dy[k], sum.fy);
        sum.fz = hn::MulAdd(gradient[k], dz[k], sum.fz);
        sum.gradients = hn::Add(sum.gradients, gradient[k]);
        const V cx = hn::Mul(curvature[k], dx[k]), cy = hn::Mul(curvature[k], dy[k]),
                cz = hn::Mul(curvature[k], dz[k]);
        sum.kxx = hn::MulAdd(cx, dx[k], sum.kxx);
        sum.kxy = hn::MulAdd(cx, dy[k], sum.kxy);
        sum.kxz = hn::MulAdd(cx, dz[k], sum.kxz);
        sum.kyy = hn::MulAdd(cy, dy[k], sum.kyy);
        sum.kyz = hn::MulAdd(cy, dz[k], sum.kyz);
        sum.kzz = hn::MulAdd(cz, dz[k], sum.kzz);
        besides.add(
            sixteen, at + k * lane_count,
            Pairs{{dx[k], dy[k], dz[k]}, gradient[k], curvature[k], s6[k], well[k], coulomb[k]});
    }
}

// Sixteens of points between two sums in double.
constexpr std::size_t most_sixteens = 64 * lane_count / 16 > 0 ? 64 * lane_count / 16 : 1;

// `motion`: from where the group was to where it is as seen from the field's origin. `points`: the
// field's, or these elsewhere.
template <class Besides>
HWY_INLINE FrozenJobSum sum_pairs(const FrozenField& field, std::span<const FrozenPoints> points,
                                  std::span<const Vec3> group, const RigidMotion& motion,
                                  Besides& besides) {
    Total total;
    Nearest nearest;
    for (std::size_t i = 0; i < group.size(); ++i) {
        const FrozenField::GroupPoint& own = field.group[i];
        const Vec3 place = motion * group[i];
        const Vec3 high(rounded_to_grid(place.x()), rounded_to_grid(place.y()),
                        rounded_to_grid(place.z()));
        const Vec3 low = place - high;
        const Point point{all(high.x()),   all(high.y()),      all(high.z()),
                          all(low.x()),    all(low.y()),       all(low.z()),
                          all(own.charge), all(own.epsilon12), all(own.half_rmin)};
        const FrozenNumbers* const numbers =
            own.row < 0 ? nullptr
                        : field.numbers.data() + static_cast<std::size_t>(own.row) * points.size();
        besides.begin_point(i);
        for (std::size_t p = 0; p < points.size();) {
            const std::size_t end = std::min(p + most_sixteens, points.size());
            Partial part;
            if (numbers) {
                for (; p < end; ++p) {
                    for (std::size_t at = 0; at < 16; at += abreast * lane_count) {
                        add_pairs(point, points[p], at, load_row(numbers[p].epsilon12, at),
                                  load_row(numbers[p].rmin, at), nearest, part, p, besides);
                    }
                }
            } else {
                for (; p < end; ++p) {
                    const FrozenPoints& others = points[p];
                    for (std::size_t at = 0; at < 16; at += abreast * lane_count) {
                        const Row epsilon = load_row(others.sqrt_epsilon, at);
                        const Row radius = load_row(others.half_rmin, at);
                        add_pairs(point, others, at, row_of([&](std::size_t k) HWY_ATTR {
                                      return hn::Mul(point.epsilon12, epsilon[k]);
                                  }),
                                  row_of([&](std::size_t k) HWY_ATTR {
                                      return hn::Add(point.half_rmin, radius[k]);
                                  }),
                                  nearest, part, p, besides);
                    }
                }
            }
            total.add(part, place);
            besides.end_part();
        }
        total.end_point();
    }
    FrozenJobSum result{total.sum(), hn::GetLane(hn::MinOfLanes(floats, nearest.r2))};
    result.sum.clearance = hn::GetLane(hn::MinOfLanes(floats, nearest.clearance));
    return result;
}

// A point of the group among those with smooth ends.
struct SmoothPoint {
    Point place;
    V volume, strength, scale, offset;
};

template <class Besides>
HWY_INLINE void add_smooth_pairs(const SmoothLaw& law, const SmoothPoint& own,
                                 const FrozenPoints& others, const FrozenSolvation* solvation,
                                 std::size_t at, V epsilon12, V rmin, Nearest& nearest,
                                 Partial& sum, std::size_t sixteen, Besides& besides) {
    const Point& point = own.place;
    const auto load = [&](const FrozenPoints::Column& column)
                          HWY_ATTR { return hn::Load(floats, column.data() + at); };
    const auto difference = [&](V own_high, V own_low, std::size_t axis) HWY_ATTR {
        return hn::Add(hn::Sub(own_high, load(others.high[axis])),
                       hn::Sub(own_low, load(others.low[axis])));
    };
    const V dx = difference(point.high_x, point.low_x, 0);
    const V dy = difference(point.high_y, point.low_y, 1);
    const V dz = difference(point.high_z, point.low_z, 2);
    const V r2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
    const V inverse_r = inverse_root(r2), inverse_r2 = hn::Mul(inverse_r, inverse_r);
    nearest.r2 = hn::Min(nearest.r2, r2);
    nearest.clearance = hn::Min(nearest.clearance, hn::MulSub(r2, inverse_r, rmin));
    SmoothTerms terms =
        law.find({r2, hn::Mul(point.charge, load(others.charge)), epsilon12, rmin}, inverse_r2);
    if (solvation != nullptr) {
        const SmoothTerms water =
            law.find_solvation(r2, inverse_r,
                               {hn::Mul(own.strength, load(solvation->volume)),
                                hn::Mul(own.volume, load(solvation->strength)), own.scale,
                                own.offset, load(solvation->scale), load(solvation->offset)});
        terms.first = hn::Add(terms.first, water.first);
        terms.second = hn::Add(terms.second, water.second);
        terms.solvation = water.solvation;
    }
    const V gradient = hn::Neg(terms.first), curvature = hn::Mul(terms.second, all(1.0 / 3));
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
    besides.add(sixteen, at,
                SmoothPairs{{dx, dy, dz},
                            gradient,
                            curvature,
                            terms.van_der_waals,
                            terms.electrostatic,
                            terms.solvation});
}

// Which of sixteen boxes are nearer to a place than the root of `reach2`: a bit for each.
HWY_INLINE std::uint32_t find_near_boxes(const FrozenBoxes& boxes, const Vec3& place, V reach2) {
    std::uint32_t near = 0;
    for (std::size_t at = 0; at < 16; at += lane_count) {
        V distance2 = hn::Zero(floats);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const V from = hn::AbsDiff(all(place[static_cast<Eigen::Index>(axis)]),
                                       hn::Load(floats, boxes.centre[axis].data() + at));
            const V beyond = hn::Max(hn::Sub(from, hn::Load(floats, boxes.half[axis].data() + at)),
                                     hn::Zero(floats));
            distance2 = hn::MulAdd(beyond, beyond, distance2);
        }
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(floats, hn::Lt(distance2, reach2), bits);
        near |= (bits[0] | static_cast<std::uint32_t>(bits[1]) << 8) << at;
    }
    return near;
}

PairScheme scheme_of(const SmoothEnds& ends) {
    PairScheme scheme;
    scheme.switch_from = ends.switch_from;
    scheme.cutoff = ends.cutoff;
    if (ends.solvation != SolvationEnd::None) {
        scheme.solvation_begin = smooth_solvation_begin;
        scheme.solvation_end = smooth_solvation_end;
    }
    return scheme;
}

// As sum_pairs, of the sixteens that have a point within reach.
template <class Besides>
HWY_INLINE FrozenJobSum sum_smooth_pairs(const FrozenField& field,
                                         std::span<const FrozenPoints> points,
                                         std::span<const FrozenBoxes> boxes,
                                         std::span<const Vec3> group, const RigidMotion& motion,
                                         Besides& besides) {
    const SmoothLaw law(scheme_of(*field.smooth));
    const double reach = field.smooth->reach();
    const bool is_solvated = field.smooth->solvation != SolvationEnd::None;
    // Boxes are rounded.
    const V reach2 = all((reach + 1e-2) * (reach + 1e-2));
    Total total;
    Nearest nearest;
    double bound = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < group.size(); ++i) {
        const FrozenField::GroupPoint& own = field.group[i];
        const Vec3 place = motion * group[i];
        const Vec3 high(rounded_to_grid(place.x()), rounded_to_grid(place.y()),
                        rounded_to_grid(place.z()));
        const Vec3 low = place - high;
        const SmoothPoint point{
            {all(high.x()), all(high.y()), all(high.z()), all(low.x()), all(low.y()), all(low.z()),
             all(own.charge), all(own.epsilon12), all(own.half_rmin)},
            all(own.volume),
            all(own.strength),
            all(own.scale),
            all(own.offset)};
        const bool has_own = is_solvated && (own.volume != 0 || own.strength != 0);
        const FrozenNumbers* const numbers =
            own.row < 0 ? nullptr
                        : field.numbers.data() + static_cast<std::size_t>(own.row) * points.size();
        besides.begin_point(i);
        Partial part;
        std::size_t in_part = 0, found = 0;
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            std::uint32_t near = find_near_boxes(boxes[b], place, reach2);
            for (; near != 0; near &= near - 1) {
                const std::size_t p = 16 * b + static_cast<std::size_t>(std::countr_zero(near));
                ++found;
                const FrozenPoints& others = points[p];
                const FrozenSolvation* const solvation =
                    has_own && field.solvation[p].counts ? &field.solvation[p] : nullptr;
                for (std::size_t at = 0; at < 16; at += lane_count) {
                    V epsilon12, rmin;
                    if (numbers) {
                        epsilon12 = hn::Load(floats, numbers[p].epsilon12.data() + at);
                        rmin = hn::Load(floats, numbers[p].rmin.data() + at);
                    } else {
                        epsilon12 = hn::Mul(point.place.epsilon12,
                                            hn::Load(floats, others.sqrt_epsilon.data() + at));
                        rmin = hn::Add(point.place.half_rmin,
                                       hn::Load(floats, others.half_rmin.data() + at));
                    }
                    add_smooth_pairs(law, point, others, solvation, at, epsilon12, rmin, nearest,
                                     part, p, besides);
                }
                if (++in_part < most_sixteens) continue;
                total.add(part, place);
                besides.end_part();
                part = {};
                in_part = 0;
            }
        }
        total.add(part, place);
        besides.end_part();
        total.end_point();
        if (found < points.size())
            bound = std::min(bound, reach - own.half_rmin - field.largest_half_rmin);
    }
    FrozenJobSum result{total.sum(), hn::GetLane(hn::MinOfLanes(floats, nearest.r2))};
    result.sum.clearance = std::min(
        bound, static_cast<double>(hn::GetLane(hn::MinOfLanes(floats, nearest.clearance))));
    return result;
}

FrozenJobSum sum_field(const FrozenField& field, std::span<const Vec3> group,
                       const RigidMotion& motion) {
    NothingBesides nothing;
    if (field.smooth)
        return sum_smooth_pairs(field, field.points, field.boxes, group, motion, nothing);
    return sum_pairs(field, field.points, group, motion, nothing);
}

EnergyJobSum sum_with_energies(const FrozenField& field, std::span<const Vec3> group,
                               const RigidMotion& motion) {
    Energies energies;
    EnergyJobSum sum;
    sum.of_pairs = field.smooth
                       ? sum_smooth_pairs(field, field.points, field.boxes, group, motion, energies)
                       : sum_pairs(field, field.points, group, motion, energies);
    energies.write(sum);
    return sum;
}

// Of points that are where they are in `memory`, the group's as seen from the field's origin.
FollowingJobSum sum_following(const FrozenField& field, const FollowingPoints& points,
                              const FollowingMemory& memory) {
    Following following(points);
    FollowingJobSum sum;
    sum.of_pairs = field.smooth ? sum_smooth_pairs(field, memory.points, memory.boxes, memory.group,
                                                   {}, following)
                                : sum_pairs(field, memory.points, memory.group, {}, following);
    following.write(sum);
    return sum;
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {
namespace {

HWY_EXPORT(sum_field);
HWY_EXPORT(sum_with_energies);
HWY_EXPORT(sum_following);

FrozenField::Points copy_points(const FieldPoints& points) {
    const auto copy = [](const auto& span) { return std::vector(span.begin(), span.end()); };
    return {copy(points.positions),
            copy(points.charge),
            copy(points.sqrt_epsilon),
            copy(points.half_rmin),
            copy(points.type),
            copy(points.solvation.volume),
            copy(points.solvation.strength),
            copy(points.solvation.inverse_lambda),
            copy(points.solvation.radius)};
}

PairRule rule_of(const FrozenField& field) noexcept {
    return {field.coulomb_constant, field.replaced, field.smooth};
}

// By place: volume, strength, scale and offset; zero without solvation. What has no strength has no
// shell either, or far pairs would leave the range of power_of_minus_square.
std::array<float, 4> solvation_numbers(const FrozenField::Points& points, std::size_t i) noexcept {
    if (points.volume.empty()) return {};
    if (points.strength[i] == 0) return {static_cast<float>(points.volume[i]), 0, 0, 0};
    const double scale = std::sqrt(std::numbers::log2e) * points.inverse_lambda[i];
    return {static_cast<float>(points.volume[i]), static_cast<float>(points.strength[i]),
            static_cast<float>(scale), static_cast<float>(scale * points.radius[i])};
}

// Of points that are at `positions`, from the origin.
void update_boxes(std::span<const Vec3> positions, const Vec3& origin,
                  std::vector<FrozenBoxes>& boxes) noexcept {
    for (std::size_t sixteen = 0; sixteen < 16 * boxes.size(); ++sixteen) {
        FrozenBoxes& of = boxes[sixteen / 16];
        const std::size_t k = sixteen % 16, first = 16 * sixteen;
        if (first >= positions.size()) {
            for (auto& centre : of.centre) centre[k] = 4e4F;
            continue;
        }
        Vec3 low = positions[first], high = low;
        for (std::size_t j = first; j < std::min(first + 16, positions.size()); ++j) {
            low = low.cwiseMin(positions[j]);
            high = high.cwiseMax(positions[j]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<Eigen::Index>(axis);
            of.centre[axis][k] = static_cast<float>(0.5 * (low[a] + high[a]) - origin[a]);
            of.half[axis][k] = static_cast<float>(0.5 * (high[a] - low[a]));
        }
    }
}

void fill_smooth(FrozenField& field) {
    const FrozenField::Points& all = field.environment;
    field.solvation.assign(field.points.size(), {});
    for (std::size_t j = 0; j < all.positions.size(); ++j) {
        FrozenSolvation& solvation = field.solvation[j / 16];
        const std::size_t k = j % 16;
        const auto [volume, strength, scale, offset] = solvation_numbers(all, j);
        solvation.volume[k] = volume;
        solvation.strength[k] = strength;
        solvation.scale[k] = scale;
        solvation.offset[k] = offset;
        solvation.counts = solvation.counts || volume != 0 || strength != 0;
    }
    for (const double half_rmin : all.half_rmin)
        field.largest_half_rmin = std::max(field.largest_half_rmin, half_rmin);
    field.boxes.assign((field.points.size() + 15) / 16, {});
    update_boxes(all.positions, field.origin, field.boxes);
}

// Halves a range of points across its longest extent, into whole sixteens, again and again.
void halve(std::span<const Vec3> positions, std::span<std::uint32_t> range) {
    if (range.size() <= 16) return;
    Vec3 low = positions[range[0]], high = low;
    for (const std::uint32_t i : range) {
        low = low.cwiseMin(positions[i]);
        high = high.cwiseMax(positions[i]);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const std::size_t sixteens = (range.size() + 15) / 16, first = 16 * ((sixteens + 1) / 2);
    std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(first), range.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         return std::pair(positions[a][axis], a) < std::pair(positions[b][axis], b);
                     });
    halve(positions, range.first(first));
    halve(positions, range.subspan(first));
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

// Of one of sixteen, from the origin.
void set_place(const Vec3& place, std::size_t k, FrozenPoints& points) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = place(static_cast<Eigen::Index>(axis)), high = rounded_to_grid(x);
        points.high[axis][k] = static_cast<float>(high);
        points.low[axis][k] = static_cast<float>(x - high);
    }
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
        set_place(all.positions[j] - field.origin, k, points);
        points.charge[k] = static_cast<float>(all.charge[j]);
        points.sqrt_epsilon[k] = static_cast<float>(all.sqrt_epsilon[j]);
        points.half_rmin[k] = static_cast<float>(all.half_rmin[j]);
    }
}

const ReplacedPair* find_replaced(const FrozenField& field, std::uint32_t a, std::uint32_t b) {
    // The last one counts, as for the reference.
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
    const bool may_be_replaced = std::ranges::any_of(field.replaced, [&](const ReplacedPair& pair) {
        return pair.a == own.type[i] || pair.b == own.type[i];
    });
    const bool is_replaced =
        may_be_replaced &&
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
        const auto [volume, strength, scale, offset] = solvation_numbers(own, i);
        field.group.push_back({static_cast<float>(field.coulomb_constant * own.charge[i]),
                               static_cast<float>(12 * own.sqrt_epsilon[i]),
                               static_cast<float>(own.half_rmin[i]), row, volume, strength, scale,
                               offset});
    }
}

// Of the origin, seen from which the points are where `motion` brings them.
bool is_near(std::span<const Vec3> points, const RigidMotion& motion) noexcept {
    return std::all_of(points.begin(), points.end(), [&](const Vec3& place) {
        return (motion * place).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <
               farthest_single_precision;
    });
}

FieldPoints view(const FrozenField::Points& points, std::span<const Vec3> positions,
                 std::size_t first, std::size_t count) noexcept {
    const auto part = [&](const auto& column) {
        return std::span(column).subspan(column.empty() ? 0 : first, column.empty() ? 0 : count);
    };
    return {positions,
            part(points.charge),
            part(points.sqrt_epsilon),
            part(points.half_rmin),
            part(points.type),
            {part(points.volume), part(points.strength), part(points.inverse_lambda),
             part(points.radius)}};
}

double find_rmin(const FrozenField& field, std::size_t i, std::size_t j) noexcept {
    const FrozenField::Points &own = field.group_numbers, &others = field.environment;
    const ReplacedPair* const pair =
        field.replaced.empty() ? nullptr : find_replaced(field, own.type[i], others.type[j]);
    return pair ? pair->rmin : own.half_rmin[i] + others.half_rmin[j];
}

double find_clearance(const FrozenField& field, std::size_t i, const Vec3& place) noexcept {
    const std::vector<Vec3>& others = field.environment.positions;
    double clearance = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < others.size(); ++j)
        clearance = std::min(clearance, (place - others[j]).norm() - find_rmin(field, i, j));
    return clearance;
}

// Point by point by the reference.
FrozenSum evaluate_in_double(const FrozenField& field, std::span<const Vec3> group,
                             const RigidMotion& motion) noexcept {
    FrozenSum sum;
    for (std::size_t i = 0; i < group.size(); ++i) {
        const Vec3 place = motion * group[i];
        const FieldSum one =
            evaluate_pair_field(view(field.group_numbers, std::span(&place, 1), i, 1),
                                view(field.environment, field.environment.positions, 0,
                                     field.environment.positions.size()),
                                rule_of(field));
        sum.force += one.force;
        sum.torque += one.torque;
        sum.stiffness += one.stiffness;
        sum.largest_force = std::max(sum.largest_force, one.force.norm());
        sum.clearance = std::min(sum.clearance, find_clearance(field, i, place));
    }
    return sum;
}

// Pair by pair by the reference, of points that are where they are in `memory`, the group's as seen
// from the field's origin.
FollowingSum evaluate_following_in_double(const FrozenField& field,
                                          const FollowingPoints& following,
                                          const FollowingMemory& memory) noexcept {
    FollowingSum result;
    FrozenSum& sum = result.sum;
    for (std::size_t i = 0; i < memory.group.size(); ++i) {
        const Vec3 place = memory.group[i] + field.origin;
        Vec3 force = Vec3::Zero();
        for (std::size_t j = 0; j < memory.environment.size(); ++j) {
            const FieldSum pair = evaluate_pair_field(
                view(field.group_numbers, std::span(&place, 1), i, 1),
                view(field.environment, std::span(&memory.environment[j], 1), j, 1),
                rule_of(field));
            const Mat3 D = following.group[i] - following.environment[j];
            result.along += D.transpose() * pair.force;
            result.slope += D.transpose() * pair.stiffness * D;
            force += pair.force;
            sum.torque += pair.torque;
            sum.stiffness += pair.stiffness;
            sum.clearance = std::min(
                sum.clearance, (place - memory.environment[j]).norm() - find_rmin(field, i, j));
        }
        sum.force += force;
        sum.largest_force = std::max(sum.largest_force, force.norm());
    }
    return result;
}

void move_points(const FrozenField& field, std::span<const Vec3> group,
                 const FollowingPoints& following, const Vec3& by,
                 FollowingMemory& memory) noexcept {
    for (std::size_t i = 0; i < group.size(); ++i)
        memory.group[i] = group[i] - field.origin + following.group[i] * by;
    for (std::size_t j = 0; j < memory.environment.size(); ++j) {
        memory.environment[j] = field.environment.positions[j] + following.environment[j] * by;
        set_place(memory.environment[j] - field.origin, j % 16, memory.points[j / 16]);
    }
    if (field.smooth) update_boxes(memory.environment, field.origin, memory.boxes);
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
    field.smooth = rule.smooth;
    fill_points(field);
    fill_group(field);
    if (field.smooth) fill_smooth(field);
    return field;
}

std::vector<std::uint32_t> order_for_sixteens(std::span<const Vec3> positions,
                                              std::span<const std::uint8_t> has_solvation) {
    PALPA_ASSERT(has_solvation.empty() || has_solvation.size() == positions.size());
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto middle = has_solvation.empty()
                            ? order.end()
                            : std::ranges::stable_partition(order, [&](std::uint32_t i) {
                                  return has_solvation[i] != 0;
                              }).begin();
    halve(positions, {order.begin(), middle});
    halve(positions, {middle, order.end()});
    return order;
}

FrozenSum evaluate_frozen_field(const FrozenField& field, std::span<const Vec3> group,
                                const RigidMotion& motion) noexcept {
    PALPA_ASSERT(group.size() == field.group.size());
    const RigidMotion from_origin{Mat3::Identity(), -field.origin};
    const RigidMotion seen = from_origin * motion;
    if (is_near(group, seen) && is_near(field.environment.positions, from_origin)) {
        FrozenJobSum result = HWY_DYNAMIC_DISPATCH(sum_field)(field, group, seen);
        constexpr double nearest = nearest_single_precision;
        if (result.nearest2 > nearest * nearest) {
            result.sum.torque += field.origin.cross(result.sum.force);
            return result.sum;
        }
    }
    return evaluate_in_double(field, group, motion);
}

FieldSum evaluate_field_and_energies(const FrozenField& field,
                                     std::span<const Vec3> group) noexcept {
    PALPA_ASSERT(group.size() == field.group.size());
    const RigidMotion from_origin{Mat3::Identity(), -field.origin};
    if (is_near(group, from_origin) && is_near(field.environment.positions, from_origin)) {
        const EnergyJobSum result =
            HWY_DYNAMIC_DISPATCH(sum_with_energies)(field, group, from_origin);
        constexpr double nearest = nearest_single_precision;
        if (result.of_pairs.nearest2 > nearest * nearest) {
            const FrozenSum& sum = result.of_pairs.sum;
            return {result.van_der_waals,
                    result.electrostatic,
                    result.solvation,
                    sum.force,
                    sum.torque + field.origin.cross(sum.force),
                    sum.stiffness};
        }
    }
    return evaluate_pair_field(
        view(field.group_numbers, group, 0, group.size()),
        view(field.environment, field.environment.positions, 0, field.environment.positions.size()),
        rule_of(field));
}

FollowingPoints build_following_points(std::vector<Mat3> group, std::vector<Mat3> environment) {
    FollowingPoints points;
    points.sixteens.resize((environment.size() + 15) / 16);  // those that fill up stay
    for (std::size_t j = 0; j < environment.size(); ++j) {
        for (std::size_t k = 0; k < 9; ++k)
            points.sixteens[j / 16][k][j % 16] = static_cast<float>(environment[j].data()[k]);
    }
    points.group = std::move(group);
    points.environment = std::move(environment);
    return points;
}

FollowingMemory build_following_memory(const FrozenField& field) {
    return {std::vector<Vec3>(field.group.size()), field.environment.positions, field.points,
            field.boxes};
}

FollowingSum evaluate_following_field(const FrozenField& field, std::span<const Vec3> group,
                                      const FollowingPoints& following, const Vec3& by,
                                      FollowingMemory& memory) noexcept {
    PALPA_ASSERT(group.size() == field.group.size() && group.size() == following.group.size());
    move_points(field, group, following, by, memory);
    if (is_near(memory.group, {}) &&
        is_near(memory.environment, {Mat3::Identity(), -field.origin})) {
        const FollowingJobSum result =
            HWY_DYNAMIC_DISPATCH(sum_following)(field, following, memory);
        constexpr double nearest = nearest_single_precision;
        if (result.of_pairs.nearest2 > nearest * nearest) {
            FollowingSum sum{result.of_pairs.sum, result.along, result.slope};
            sum.sum.torque += field.origin.cross(sum.sum.force);
            return sum;
        }
    }
    return evaluate_following_in_double(field, following, memory);
}

}  // namespace palpa
#endif  // HWY_ONCE
