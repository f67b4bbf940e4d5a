#include "field/hessian_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/hessian_job.cpp"
#include <hwy/foreach_target.h>  // before highway.h

#include "field/smooth_law-inl.h"

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {

using BlockDoubles = hn::CappedTag<double, hessian_block>;
using B = hn::Vec<BlockDoubles>;
constexpr BlockDoubles block_doubles;

// Of whole energies: with t = (rmin/r)^6 and w = 12 epsilon t,
//   E' = -(w (t - 1) + q/r)/r^2,  E'' = (w (14 t - 8) + 3 q/r)/r^4.
struct WholeLaw {
    static constexpr bool ends = false, takes_solvation = false;

    explicit HWY_INLINE WholeLaw(const PairScheme&) {}

    HWY_INLINE Slopes evaluate(const PairNumbers& pair) const {
        const V inverse_r = inverse_root(pair.r2), inverse_r2 = hn::Mul(inverse_r, inverse_r);
        const V s = hn::Mul(pair.rmin, inverse_r), s2 = hn::Mul(s, s);
        const V t = hn::Mul(hn::Mul(s2, s2), s2), well = hn::Mul(pair.epsilon12, t);
        const V u = hn::Mul(pair.charges, inverse_r), steep = hn::Mul(well, t);
        const V first = hn::Sub(hn::Sub(well, steep), u);
        const V second = hn::MulAdd(steep, all(14), hn::MulSub(u, all(3), hn::Mul(well, all(8))));
        return {hn::Mul(first, inverse_r2), hn::Mul(second, hn::Mul(inverse_r2, inverse_r2))};
    }
};

// Both forces switched (field/cutoff.h). With u = r^-6, v = r^-3, p = u before m and
// k12 (u - c^-6) after it, q likewise of v, and k what p goes with u:
//   E' of van der Waals = -12 epsilon rmin^6 (rmin^6 p u - q v)/r^2,
//   E'' = 12 epsilon rmin^6 (rmin^6 (6 k u^2 + 8 p u) - (3 k6 v^2 + 5 q v))/r^4.
class SwitchedLaw {
public:
    static constexpr bool ends = true, takes_solvation = false;

    explicit HWY_INLINE SwitchedLaw(const PairScheme& scheme) {
        const double c = scheme.cutoff, m = scheme.switch_from, width = c * c - m * m;
        const double c3 = c * c * c, m3 = m * m * m;
        c2_ = all(c * c);
        m2_ = all(m * m);
        k12_ = all(c3 * c3 / (c3 * c3 - m3 * m3));
        k12_end_ = all(1 / (c3 * c3 - m3 * m3));
        k6_ = all(c3 / (c3 - m3));
        k6_end_ = all(1 / (c3 - m3));
        scale_ = all(1 / width);
        offset_ = all(-m * m / width);
        slope_scale_ = all(-12 / width);
    }

    HWY_INLINE Slopes evaluate(const PairNumbers& pair) const {
        const V inverse_r = inverse_root(pair.r2), inverse_r2 = hn::Mul(inverse_r, inverse_r);
        const V v = hn::Mul(inverse_r2, inverse_r), u = hn::Mul(v, v);
        const M is_before = hn::Lt(pair.r2, m2_);
        const V k12 = hn::IfThenElse(is_before, all(1), k12_);
        const V k6 = hn::IfThenElse(is_before, all(1), k6_);
        const V p = hn::Min(u, hn::MulSub(k12_, u, k12_end_));
        const V q = hn::Min(v, hn::MulSub(k6_, v, k6_end_));
        const V rmin2 = hn::Mul(pair.rmin, pair.rmin);
        const V rmin6 = hn::Mul(hn::Mul(rmin2, rmin2), rmin2);
        const V well = hn::Mul(pair.epsilon12, rmin6);
        const V pu = hn::Mul(p, u), qv = hn::Mul(q, v);
        const V ku2 = hn::Mul(k12, hn::Mul(u, u)), kv2 = hn::Mul(k6, hn::Mul(v, v));
        const V repulsion = hn::Mul(rmin6, hn::MulAdd(ku2, all(6), hn::Mul(pu, all(8))));
        const V attraction = hn::MulAdd(kv2, all(3), hn::Mul(qv, all(5)));
        const V first = hn::Mul(well, hn::NegMulAdd(rmin6, pu, qv));
        const V second = hn::Mul(well, hn::Sub(repulsion, attraction));

        // U' = -q/r^3 times S, U'' = 3 q/r^5 times S less q/r^3 S'/r.
        const V y = hn::Max(hn::MulAdd(pair.r2, scale_, offset_), hn::Zero(floats));
        const V S = hn::NegMulAdd(hn::Mul(y, y), hn::NegMulAdd(y, all(2), all(3)), all(1));
        const V slope = hn::Mul(slope_scale_, hn::NegMulAdd(y, y, y));
        const V charges = hn::Mul(pair.charges, inverse_r), switched = hn::Mul(charges, S);
        const V electric =
            hn::NegMulAdd(hn::Mul(charges, slope), pair.r2, hn::Mul(switched, all(3)));

        const M counts = hn::Lt(pair.r2, c2_);
        return {hn::IfThenElseZero(counts, hn::Mul(hn::Sub(first, switched), inverse_r2)),
                hn::IfThenElseZero(
                    counts, hn::Mul(hn::Add(second, electric), hn::Mul(inverse_r2, inverse_r2)))};
    }

private:
    V c2_, m2_, k12_, k12_end_, k6_, k6_end_, scale_, offset_, slope_scale_;
};

// HessianBlock in single precision, of as many lanes as there are.
struct Block {
    V turns[6], skew[3], mixed[9], q[3], shifts[6];

    HWY_INLINE void clear() {
        for (V& v : turns) v = hn::Zero(floats);
        for (V& v : skew) v = hn::Zero(floats);
        for (V& v : mixed) v = hn::Zero(floats);
        for (V& v : q) v = hn::Zero(floats);
        for (V& v : shifts) v = hn::Zero(floats);
    }
};

struct Row {
    V x, y, z;  // Å, from the lane's point
};

// Of one row and some columns: K = sum of E' 1 + E'' d d^T, and q = sum of E' d.
struct RowSum {
    V xx, xy, xz, yy, yz, zz, qx, qy, qz;
};

// With X = [x]x and N = X K, what T^T (K T_j) is: upper left N X^T + X [q]x, upper right N, lower
// right K. (The velocity of j is T_i less [d]x, and K d d^T annihilates that but for E'.)
HWY_INLINE void add_row(const Row& at, const RowSum& s, Block& block) {
    const V half = all(0.5);
    const auto cross = [&](V a, V b, V c, V d) HWY_ATTR { return hn::MulSub(a, b, hn::Mul(c, d)); };
    const V &x = at.x, &y = at.y, &z = at.z;
    const V n00 = cross(y, s.xz, z, s.xy), n01 = cross(y, s.yz, z, s.yy),
            n02 = cross(y, s.zz, z, s.yz);
    const V n10 = cross(z, s.xx, x, s.xz), n11 = cross(z, s.xy, x, s.yz),
            n12 = cross(z, s.xz, x, s.zz);
    const V n20 = cross(x, s.xy, y, s.xx), n21 = cross(x, s.yy, y, s.xy),
            n22 = cross(x, s.yz, y, s.xz);
    V* const mixed = block.mixed;
    mixed[0] = hn::Add(mixed[0], n00);
    mixed[1] = hn::Add(mixed[1], n01);
    mixed[2] = hn::Add(mixed[2], n02);
    mixed[3] = hn::Add(mixed[3], n10);
    mixed[4] = hn::Add(mixed[4], n11);
    mixed[5] = hn::Add(mixed[5], n12);
    mixed[6] = hn::Add(mixed[6], n20);
    mixed[7] = hn::Add(mixed[7], n21);
    mixed[8] = hn::Add(mixed[8], n22);
    // N X^T: column 0 is -z N_1 + y N_2, column 1 z N_0 - x N_2, column 2 -y N_0 + x N_1. And of
    // X [q]x = q x^T - (x q) 1 the symmetric half.
    const V xq = hn::Mul(x, s.qx), yq = hn::Mul(y, s.qy), zq = hn::Mul(z, s.qz);
    V* const turns = block.turns;
    turns[0] = hn::Add(turns[0], hn::Sub(cross(y, n02, z, n01), hn::Add(yq, zq)));
    turns[3] = hn::Add(turns[3], hn::Sub(cross(z, n10, x, n12), hn::Add(xq, zq)));
    turns[5] = hn::Add(turns[5], hn::Sub(cross(x, n21, y, n20), hn::Add(xq, yq)));
    const V x_qy = hn::Mul(x, s.qy), y_qx = hn::Mul(y, s.qx);
    const V x_qz = hn::Mul(x, s.qz), z_qx = hn::Mul(z, s.qx);
    const V y_qz = hn::Mul(y, s.qz), z_qy = hn::Mul(z, s.qy);
    turns[1] = hn::Add(turns[1], hn::MulAdd(half, hn::Add(x_qy, y_qx), cross(z, n00, x, n02)));
    turns[2] = hn::Add(turns[2], hn::MulAdd(half, hn::Add(x_qz, z_qx), cross(x, n01, y, n00)));
    turns[4] = hn::Add(turns[4], hn::MulAdd(half, hn::Add(y_qz, z_qy), cross(x, n11, y, n10)));
    V* const skew = block.skew;
    skew[0] = hn::MulAdd(half, hn::Sub(y_qz, z_qy), skew[0]);
    skew[1] = hn::MulAdd(half, hn::Sub(z_qx, x_qz), skew[1]);
    skew[2] = hn::MulAdd(half, hn::Sub(x_qy, y_qx), skew[2]);
    block.q[0] = hn::Add(block.q[0], s.qx);
    block.q[1] = hn::Add(block.q[1], s.qy);
    block.q[2] = hn::Add(block.q[2], s.qz);
    V* const shifts = block.shifts;
    shifts[0] = hn::Add(shifts[0], s.xx);
    shifts[1] = hn::Add(shifts[1], s.xy);
    shifts[2] = hn::Add(shifts[2], s.xz);
    shifts[3] = hn::Add(shifts[3], s.yy);
    shifts[4] = hn::Add(shifts[4], s.yz);
    shifts[5] = hn::Add(shifts[5], s.zz);
}

HWY_INLINE M lanes_of(std::uint16_t bits, std::size_t lane) {
    std::uint8_t bytes[8] = {};
    const auto of_lanes = static_cast<std::uint16_t>(bits >> lane);
    bytes[0] = static_cast<std::uint8_t>(of_lanes);
    bytes[1] = static_cast<std::uint8_t>(of_lanes >> 8);
    return hn::LoadMaskBits(floats, bytes);
}

// Single to double, added to what stands there or instead of it.
template <bool Starts>
HWY_INLINE void put(W value, double* at) {
    if constexpr (!Starts) value = hn::Add(value, hn::Load(doubles, at));
    hn::Store(value, doubles, at);
}
template <bool Starts>
HWY_INLINE void put(V value, LaneDoubles& lanes, std::size_t lane) {
    put<Starts>(lower_half(value), lanes.at.data() + lane);
    if constexpr (lane_count > 1)
        put<Starts>(upper_half(value), lanes.at.data() + lane + lane_count / 2);
}
template <bool Starts>
HWY_INLINE void put(const Block& block, HessianBlock& slot, std::size_t lane) {
    for (std::size_t i = 0; i < 6; ++i) put<Starts>(block.turns[i], slot.turns[i], lane);
    for (std::size_t i = 0; i < 3; ++i) put<Starts>(block.skew[i], slot.skew[i], lane);
    for (std::size_t i = 0; i < 9; ++i) put<Starts>(block.mixed[i], slot.mixed[i], lane);
    for (std::size_t i = 0; i < 3; ++i) put<Starts>(block.q[i], slot.q[i], lane);
    for (std::size_t i = 0; i < 6; ++i) put<Starts>(block.shifts[i], slot.shifts[i], lane);
}

HWY_INLINE void add_lanes(const LaneDoubles* from, std::size_t count, LaneDoubles* to) {
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t lane = 0; lane < hessian_lanes; lane += hn::MaxLanes(doubles)) {
            double* const at = to[i].at.data() + lane;
            hn::Store(hn::Add(hn::Load(doubles, at), hn::Load(doubles, from[i].at.data() + lane)),
                      doubles, at);
        }
    }
}
HWY_INLINE void add_block(const HessianBlock& from, HessianBlock& to) {
    add_lanes(from.turns.data(), 6, to.turns.data());
    add_lanes(from.skew.data(), 3, to.skew.data());
    add_lanes(from.mixed.data(), 9, to.mixed.data());
    add_lanes(from.q.data(), 3, to.q.data());
    add_lanes(from.shifts.data(), 6, to.shifts.data());
}

// The block of each lane times one screw, which is about the origin while blocks are about points.
HWY_INLINE void multiply(const HessianBlock& block, const std::array<double, 6>& screw,
                         const std::array<LaneDoubles, 3>& points,
                         std::array<LaneDoubles, 6>& wrench) {
    const auto set = [&](std::size_t i) HWY_ATTR { return hn::Set(doubles, screw[i]); };
    const W w0 = set(0), w1 = set(1), w2 = set(2);
    for (std::size_t lane = 0; lane < hessian_lanes; lane += hn::MaxLanes(doubles)) {
        const auto at = [&](const LaneDoubles& lanes)
                            HWY_ATTR { return hn::Load(doubles, lanes.at.data() + lane); };
        const auto product = [&](const LaneDoubles& a, const LaneDoubles& b, const LaneDoubles& c,
                                 W x, W y, W z, W sum) HWY_ATTR {
            return hn::MulAdd(at(a), x, hn::MulAdd(at(b), y, hn::MulAdd(at(c), z, sum)));
        };
        const auto cross = [&](W a, W b, W c, W d)
                               HWY_ATTR { return hn::MulSub(a, b, hn::Mul(c, d)); };
        const auto store = [&](std::size_t i, W value)
                               HWY_ATTR { hn::Store(value, doubles, wrench[i].at.data() + lane); };
        const W x = at(points[0]), y = at(points[1]), z = at(points[2]);
        const W v0 = hn::Add(set(3), cross(w1, z, w2, y)),
                v1 = hn::Add(set(4), cross(w2, x, w0, z)),
                v2 = hn::Add(set(5), cross(w0, y, w1, x));
        const auto& [xx, xy, xz, yy, yz, zz] = block.turns;
        const auto& m = block.mixed;
        const W a0 = at(block.skew[0]), a1 = at(block.skew[1]), a2 = at(block.skew[2]);
        store(0, product(m[0], m[1], m[2], v0, v1, v2,
                         product(xx, xy, xz, w0, w1, w2, cross(a1, w2, a2, w1))));
        store(1, product(m[3], m[4], m[5], v0, v1, v2,
                         product(xy, yy, yz, w0, w1, w2, cross(a2, w0, a0, w2))));
        store(2, product(m[6], m[7], m[8], v0, v1, v2,
                         product(xz, yz, zz, w0, w1, w2, cross(a0, w1, a1, w0))));
        const auto& s = block.shifts;
        const W q0 = at(block.q[0]), q1 = at(block.q[1]), q2 = at(block.q[2]);
        store(3, product(s[0], s[1], s[2], v0, v1, v2,
                         product(m[0], m[3], m[6], w0, w1, w2, cross(q1, w2, q2, w1))));
        store(4, product(s[1], s[3], s[4], v0, v1, v2,
                         product(m[1], m[4], m[7], w0, w1, w2, cross(q2, w0, q0, w2))));
        store(5, product(s[2], s[4], s[5], v0, v1, v2,
                         product(m[2], m[5], m[8], w0, w1, w2, cross(q0, w1, q1, w0))));
    }
}

template <class Law>
class PanelKernel {
public:
    explicit HWY_INLINE PanelKernel(const HessianJob& job)
        : job_(job),
          plan_(*job.plan),
          panel_(plan_.panels[job.panel]),
          workspace_(*job.workspace),
          law_(*job.scheme) {
        place_rows();
    }

    void run(HessianBlock& rows) {
        rows = {};
        const HessianMask* mask = plan_.masks_of.data() + panel_.first_mask;
        const HessianMask* const end_mask = plan_.masks_of.data() + panel_.end_mask;
        const HessianExtra* extra = plan_.extras.data() + panel_.first_extra;
        const HessianExtra* const end_extra = plan_.extras.data() + panel_.end_extra;
        for (std::uint32_t c = panel_.first_column; c < plan_.columns.size(); ++c) {
            const HessianColumn& column = plan_.columns[c];
            HessianBlock& slot = workspace_.column_slots[column.step.slot];
            std::uint8_t& has_started = workspace_.has_started[column.step.slot];
            // Of its children those that come before the panel, or are far, are not there.
            const bool starts = has_started == 0;
            if (mask != end_mask && mask->column == c) {
                add_pairs<true, 0>(column, plan_.masks.data() + mask->first, starts, slot);
                has_started = 1;
                ++mask;
            } else if (!Law::ends || is_near(c)) {
                add_all_pairs(column, starts, slot);
                has_started = 1;
            }
            for (; extra != end_extra && extra->column == c; ++extra) {
                if (std::exchange(has_started, std::uint8_t{1}) == 0) slot = {};
                add_extra(*extra, slot);
            }
            for (std::uint32_t k = column.first_motion; k < column.end_motion; ++k) {
                if (has_started != 0) {
                    multiply(slot, workspace_.screws[k], points_, workspace_.panel[k]);
                } else {
                    workspace_.panel[k] = {};
                }
            }
            if (has_started != 0) pass_on(column.step, slot, rows);
        }
    }

private:
    HWY_INLINE void place_rows() {
        for (std::size_t lane = 0; lane < hessian_lanes; ++lane) {
            const auto place = [&](std::size_t k) -> Vec3 {
                return job_.positions[panel_.atoms[k][lane]] - job_.call_origin;
            };
            const bool is_there = panel_.column[lane] != no_number;
            const Vec3 point = is_there ? place(0) : Vec3::Zero();
            workspace_.lane_points[lane] = point;
            float reach = -1e4F;
            for (int i = 0; i < 3; ++i) points_[static_cast<std::size_t>(i)].at[lane] = point[i];
            for (std::size_t k = 0; k < hessian_places; ++k) {
                // Far from all, and without charge and well.
                Vec3 from_panel = Vec3(4e3, 4e3, 4e3), from_point = Vec3::Zero();
                if (panel_.atoms[k][lane] != no_number) {
                    from_panel = place(k) - job_.origin;
                    from_point = place(k) - point;
                    places_ = std::max(places_, k + 1);
                    reach = std::max(reach, static_cast<float>(from_point.norm()));
                }
                for (int i = 0; i < 3; ++i) {
                    const auto axis = static_cast<std::size_t>(i);
                    places_of_[k][axis].at[lane] = static_cast<float>(from_panel[i]);
                    arms_of_[k][axis].at[lane] = static_cast<float>(from_point[i]);
                }
            }
            reach_.at[lane] = reach;
        }
        std::ranges::fill(workspace_.has_started, std::uint8_t{0});
        // What columns before the panel have left of the first block that it has to do with.
        const std::uint32_t first = plan_.columns[panel_.first_column].first_motion;
        for (std::uint32_t k = first / hessian_block * hessian_block; k < first; ++k)
            workspace_.panel[k] = {};
    }

    // Whether a column's atoms may be within the cutoff of a lane's.
    HWY_INLINE bool is_near(std::uint32_t c) const {
        const Vec3 centre = workspace_.centre[c] - job_.origin;
        const double reach =
            std::max(job_.scheme->cutoff, job_.scheme->solvation_end) + workspace_.radius[c];
        for (std::size_t lane = 0; lane < hessian_lanes; lane += lane_count) {
            const auto distance = [&](std::size_t axis) HWY_ATTR {
                const LaneFloats& places = places_of_[0][axis];
                return hn::Sub(hn::Load(floats, places.at.data() + lane),
                               all(centre[static_cast<int>(axis)]));
            };
            const V dx = distance(0), dy = distance(1), dz = distance(2);
            const V r2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
            const V most = hn::Add(hn::Load(floats, reach_.at.data() + lane), all(reach));
            const M is_within =
                hn::And(hn::Lt(r2, hn::Mul(most, most)), hn::Gt(most, hn::Zero(floats)));
            if (!hn::AllFalse(floats, is_within)) return true;
        }
        return false;
    }

    // Most bodies have few atoms: loops of a fixed number of rounds.
    HWY_INLINE void add_all_pairs(const HessianColumn& column, bool starts, HessianBlock& slot) {
        switch (column.end_atom - column.first_atom) {
            case 2:
                return add_pairs<false, 2>(column, nullptr, starts, slot);
            case 3:
                return add_pairs<false, 3>(column, nullptr, starts, slot);
            case 4:
                return add_pairs<false, 4>(column, nullptr, starts, slot);
            default:
                return add_pairs<false, 0>(column, nullptr, starts, slot);
        }
    }

    template <bool IsMasked, std::size_t Count>
    HWY_INLINE void add_pairs(const HessianColumn& column, const std::uint16_t* masks, bool starts,
                              HessianBlock& slot) {
        const Law law = law_;
        const std::size_t count = Count > 0 ? Count : column.end_atom - column.first_atom;
        const float* const xs = workspace_.x.data() + column.first_atom;
        const float* const ys = workspace_.y.data() + column.first_atom;
        const float* const zs = workspace_.z.data() + column.first_atom;
        const float* const charges = plan_.charge.data() + column.first_atom;
        const float* const sqrt_epsilons = plan_.sqrt_epsilon.data() + column.first_atom;
        const float* const half_rmins = plan_.half_rmin.data() + column.first_atom;
        for (std::size_t lane = 0; lane < hessian_lanes; lane += lane_count) {
            Block block;
            block.clear();
            for (std::size_t k = 0; k < places_; ++k) {
                const auto load = [&](const LaneFloats& lanes)
                                      HWY_ATTR { return hn::Load(floats, lanes.at.data() + lane); };
                const V x = load(places_of_[k][0]), y = load(places_of_[k][1]),
                        z = load(places_of_[k][2]);
                const HessianPlan::Numbers& numbers = plan_.row_numbers[job_.panel][k];
                const V charge = hn::Mul(load(numbers.charge), all(job_.scheme->coulomb));
                const V epsilon12 = load(numbers.epsilon12), half_rmin = load(numbers.half_rmin);
                const V zero = hn::Zero(floats);
                RowSum s{zero, zero, zero, zero, zero, zero, zero, zero, zero};
                for (std::size_t j = 0; j < count; ++j) {
                    const V dx = hn::Sub(x, hn::Set(floats, xs[j]));
                    const V dy = hn::Sub(y, hn::Set(floats, ys[j]));
                    const V dz = hn::Sub(z, hn::Set(floats, zs[j]));
                    const V r2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
                    Slopes slopes =
                        law.evaluate({r2, hn::Mul(charge, hn::Set(floats, charges[j])),
                                      hn::Mul(epsilon12, hn::Set(floats, sqrt_epsilons[j])),
                                      hn::Add(half_rmin, hn::Set(floats, half_rmins[j]))});
                    if constexpr (Law::takes_solvation) {
                        const std::size_t atom = column.first_atom + j;
                        if (plan_.volume[atom] != 0 || plan_.strength[atom] != 0) {
                            law.add_solvation(r2,
                                              {hn::Mul(load(numbers.strength),
                                                       hn::Set(floats, plan_.volume[atom])),
                                               hn::Mul(load(numbers.volume),
                                                       hn::Set(floats, plan_.strength[atom])),
                                               load(numbers.scale), load(numbers.offset),
                                               hn::Set(floats, plan_.scale[atom]),
                                               hn::Set(floats, plan_.offset[atom])},
                                              slopes);
                        }
                    }
                    auto [first, second] = slopes;
                    if constexpr (IsMasked) {
                        const M counts = lanes_of(masks[k * count + j], lane);
                        first = hn::IfThenElseZero(counts, first);
                        second = hn::IfThenElseZero(counts, second);
                    }
                    const V ex = hn::Mul(second, dx), ey = hn::Mul(second, dy),
                            ez = hn::Mul(second, dz);
                    s.xx = hn::MulAdd(ex, dx, hn::Add(s.xx, first));
                    s.xy = hn::MulAdd(ex, dy, s.xy);
                    s.xz = hn::MulAdd(ex, dz, s.xz);
                    s.yy = hn::MulAdd(ey, dy, hn::Add(s.yy, first));
                    s.yz = hn::MulAdd(ey, dz, s.yz);
                    s.zz = hn::MulAdd(ez, dz, hn::Add(s.zz, first));
                    s.qx = hn::MulAdd(first, dx, s.qx);
                    s.qy = hn::MulAdd(first, dy, s.qy);
                    s.qz = hn::MulAdd(first, dz, s.qz);
                }
                add_row({load(arms_of_[k][0]), load(arms_of_[k][1]), load(arms_of_[k][2])}, s,
                        block);
            }
            if (starts) {
                put<true>(block, slot, lane);
            } else {
                put<false>(block, slot, lane);
            }
        }
    }

    // As add_row, of one lane and in double.
    void add_extra(const HessianExtra& extra, HessianBlock& slot) {
        const Vec3 x =
            job_.positions[extra.i] - job_.call_origin - workspace_.lane_points[extra.lane];
        const Vec3 d = job_.positions[extra.i] - job_.positions[extra.j];
        const RadialSlopes& slopes = job_.replaced[extra.number];
        const Mat3 K = slopes.first * Mat3::Identity() + slopes.second * d * d.transpose();
        const Vec3 q = slopes.first * d;
        const Mat3 X = cross_matrix(x), N = X * K;
        const Mat3 turns = N * X.transpose() + 0.5 * (q * x.transpose() + x * q.transpose()) -
                           x.dot(q) * Mat3::Identity();
        const Vec3 skew = 0.5 * x.cross(q);
        const auto add = [&](LaneDoubles& lanes, double value) { lanes.at[extra.lane] += value; };
        for (std::size_t i = 0; i < 9; ++i)
            add(slot.mixed[i], N(static_cast<int>(i / 3), static_cast<int>(i % 3)));
        for (int i = 0, n = 0; i < 3; ++i) {
            for (int j = i; j < 3; ++j, ++n) {
                add(slot.turns[static_cast<std::size_t>(n)], turns(i, j));
                add(slot.shifts[static_cast<std::size_t>(n)], K(i, j));
            }
            add(slot.skew[static_cast<std::size_t>(i)], skew[i]);
            add(slot.q[static_cast<std::size_t>(i)], q[i]);
        }
    }

    HWY_INLINE void pass_on(const HessianStep& step, const HessianBlock& slot, HessianBlock& rows) {
        if (step.to == step.slot) return;
        workspace_.has_started[step.slot] = 0;
        if (step.to == no_number) {
            add_block(slot, rows);
        } else if (std::exchange(workspace_.has_started[step.to], std::uint8_t{1}) == 0) {
            workspace_.column_slots[step.to] = slot;
        } else {
            add_block(slot, workspace_.column_slots[step.to]);
        }
    }

    const HessianJob& job_;
    const HessianPlan& plan_;
    const HessianPanel& panel_;
    HessianSums::Workspace& workspace_;
    Law law_;
    std::size_t places_ = 0;
    std::array<std::array<LaneFloats, 3>, hessian_places> places_of_, arms_of_;  // Å
    LaneFloats reach_;                   // of each lane's atoms from its point, Å
    std::array<LaneDoubles, 3> points_;  // of each lane, from the call's origin, Å
};

void run_panel(const HessianJob& job, HessianBlock& rows) {
    if (job.scheme->electrostatics == ElectrostaticCutoff::None) {
        PanelKernel<WholeLaw>(job).run(rows);
    } else if (job.scheme->electrostatics == ElectrostaticCutoff::CubicShift) {
        PanelKernel<SmoothLaw>(job).run(rows);
    } else {
        PanelKernel<SwitchedLaw>(job).run(rows);
    }
}

// ---- along the rows -------------------------------------------------------------------------

HWY_INLINE B load(const std::array<double, hessian_block>& at, std::size_t lane) {
    return hn::Load(block_doubles, at.data() + lane);
}

#if HWY_MAX_BYTES == 64
// Eight vectors of eight: columns for rows.
HWY_INLINE void turn_round(std::array<B, 8>& v) {
    std::array<B, 8> pairs;  // of lanes 2i and 2i + 1: lower ones, then upper ones
    for (std::size_t i = 0; i < 4; ++i) {
        pairs[i] = hn::InterleaveLower(block_doubles, v[2 * i], v[2 * i + 1]);
        pairs[i + 4] = hn::InterleaveUpper(block_doubles, v[2 * i], v[2 * i + 1]);
    }
    for (std::size_t odd = 0; odd < 2; ++odd) {
        const B a = pairs[4 * odd], b = pairs[4 * odd + 1], c = pairs[4 * odd + 2],
                d = pairs[4 * odd + 3];
        const B ab0 = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a);
        const B ab1 = hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a));
        const B cd0 = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(d), c);
        const B cd1 = hn::OddEvenBlocks(d, hn::SwapAdjacentBlocks(c));
        v[odd] = hn::ConcatLowerLower(block_doubles, cd0, ab0);
        v[odd + 2] = hn::ConcatLowerLower(block_doubles, cd1, ab1);
        v[odd + 4] = hn::ConcatUpperUpper(block_doubles, cd0, ab0);
        v[odd + 6] = hn::ConcatUpperUpper(block_doubles, cd1, ab1);
    }
}
#endif

// Of eight motions, what stands lane by lane: motion by motion.
HWY_INLINE void turn_round(const std::array<LaneDoubles, 6>* motions, std::size_t count,
                           std::array<WrenchBlock, hessian_lanes>& lanes) {
    for (std::size_t i = 0; i < 6; ++i) {
#if HWY_MAX_BYTES == 64
        for (std::size_t first = 0; first < hessian_lanes; first += 8) {
            std::array<B, 8> v;
            for (std::size_t m = 0; m < 8; ++m) {
                v[m] = m < count ? hn::Load(block_doubles, motions[m][i].at.data() + first)
                                 : hn::Zero(block_doubles);
            }
            turn_round(v);
            for (std::size_t lane = 0; lane < 8; ++lane)
                hn::Store(v[lane], block_doubles, lanes[first + lane].at[i].data());
        }
#else
        for (std::size_t m = 0; m < count; ++m) {
            const LaneDoubles& from = motions[m][i];
            for (std::size_t lane = 0; lane < hessian_lanes; ++lane)
                lanes[lane].at[i][m] = from.at[lane];
        }
        for (std::size_t m = count; m < hessian_block; ++m) {
            for (std::size_t lane = 0; lane < hessian_lanes; ++lane) lanes[lane].at[i][m] = 0;
        }
#endif
    }
}

template <bool Starts>
HWY_INLINE void add_wrenches(const WrenchBlock& from, const Vec3& origin, WrenchBlock& to) {
    const B x = hn::Set(block_doubles, origin.x()), y = hn::Set(block_doubles, origin.y()),
            z = hn::Set(block_doubles, origin.z());
    for (std::size_t lane = 0; lane < hessian_block; lane += hn::MaxLanes(block_doubles)) {
        const B fx = load(from.at[3], lane), fy = load(from.at[4], lane),
                fz = load(from.at[5], lane);
        const auto put_one = [&](std::size_t i, B value) HWY_ATTR {
            if constexpr (!Starts) value = hn::Add(value, load(to.at[i], lane));
            hn::Store(value, block_doubles, to.at[i].data() + lane);
        };
        put_one(0, hn::NegMulAdd(z, fy, hn::MulAdd(y, fz, load(from.at[0], lane))));
        put_one(1, hn::NegMulAdd(x, fz, hn::MulAdd(z, fx, load(from.at[1], lane))));
        put_one(2, hn::NegMulAdd(y, fx, hn::MulAdd(x, fy, load(from.at[2], lane))));
        put_one(3, fx);
        put_one(4, fy);
        put_one(5, fz);
    }
}

HWY_INLINE void multiply_rows(const std::array<double, 6>& screw, const WrenchBlock& wrench,
                              MotionBlock& product) {
    for (std::size_t lane = 0; lane < hessian_block; lane += hn::MaxLanes(block_doubles)) {
        B sum = hn::Zero(block_doubles);
        for (std::size_t i = 0; i < 6; ++i)
            sum = hn::NegMulAdd(hn::Set(block_doubles, screw[i]), load(wrench.at[i], lane), sum);
        hn::Store(sum, block_doubles, product.at.data() + lane);
    }
}

HWY_INLINE void add_rows(const WrenchBlock& from, WrenchBlock& to) {
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t lane = 0; lane < hessian_block; lane += hn::MaxLanes(block_doubles)) {
            hn::Store(hn::Add(load(to.at[i], lane), load(from.at[i], lane)), block_doubles,
                      to.at[i].data() + lane);
        }
    }
}

// Eight motions of a panel's rows.
class RowBlock {
public:
    HWY_INLINE RowBlock(const HessianPlan& plan, std::size_t panel, std::size_t block,
                        HessianSums& sums)
        : plan_(plan),
          panel_(plan.panels[panel]),
          block_(block),
          sums_(sums),
          slots_(sums.workspace.row_slots.data() + block * plan.slots) {}

    void run() {
        const std::uint32_t first = plan_.columns[panel_.first_column].first_motion / hessian_block;
        has_own_ = block_ >= first;
        if (has_own_) {
            const std::size_t begin = block_ * hessian_block;
            turn_round(sums_.workspace.panel.data() + begin,
                       std::min(hessian_block, plan_.motions.size() - begin), lanes_);
        }
        for (std::size_t lane = 0; lane < hessian_lanes; ++lane) {
            if (panel_.column[lane] != no_number) add_lane(lane);
        }
    }

private:
    HWY_INLINE void add_lane(std::size_t lane) {
        const HessianColumn& column = plan_.columns[panel_.column[lane]];
        if (block_ < column.first_block) return;
        WrenchBlock& slot = slots_[column.step.slot];
        const bool starts = column.is_leaf && (panel_.is_first >> lane & 1U) != 0;
        const Vec3& point = sums_.workspace.lane_points[lane];
        if (has_own_ && starts) {
            add_wrenches<true>(lanes_[lane], point, slot);
        } else if (has_own_) {
            add_wrenches<false>(lanes_[lane], point, slot);
        } else if (starts) {
            slot = {};
        }
        if ((panel_.is_last >> lane & 1U) == 0) return;
        for (std::uint32_t k = column.first_motion; k < column.end_motion; ++k) {
            multiply_rows(sums_.workspace.screws[k], slot,
                          sums_.products[k * sums_.blocks + block_]);
        }
        if (column.step.to == no_number) {
            add_rows(slot, sums_.wrenches[block_]);
        } else if (column.step.to != column.step.slot) {
            add_rows(slot, slots_[column.step.to]);
        }
    }

    const HessianPlan& plan_;
    const HessianPanel& panel_;
    std::size_t block_;
    HessianSums& sums_;
    WrenchBlock* slots_;
    bool has_own_ = false;
    std::array<WrenchBlock, hessian_lanes> lanes_;
};

void carry_panel(const HessianPlan& plan, std::size_t panel, HessianSums& sums) {
    for (std::size_t block = 0; block < plan.blocks(); ++block)
        RowBlock(plan, panel, block, sums).run();
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {

HWY_EXPORT(run_panel);
HWY_EXPORT(carry_panel);

void run_hessian_panel(const HessianJob& job, HessianBlock& rows) noexcept {
    HWY_DYNAMIC_DISPATCH(run_panel)(job, rows);
}

void carry_rows(const HessianPlan& plan, std::size_t panel, HessianSums& sums) noexcept {
    HWY_DYNAMIC_DISPATCH(carry_panel)(plan, panel, sums);
}

}  // namespace palpa
#endif  // HWY_ONCE
