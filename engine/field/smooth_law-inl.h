// Derivatives and energies of pairs by the two smooth ends and of solvation, compiled once for each
// kind of processor: included again and again by Highway's foreach_target, so there is no #pragma
// once.
#if defined(PALPA_SMOOTH_LAW_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PALPA_SMOOTH_LAW_INL
#undef PALPA_SMOOTH_LAW_INL
#else
#define PALPA_SMOOTH_LAW_INL
#endif

#include "field/pair_kernel-inl.h"
#include "field/pair_kernel.h"

#include <algorithm>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {

// E' and E'' of some pairs.
struct Slopes {
    V first, second;
};

struct PairNumbers {
    V r2, charges, epsilon12, rmin;
};

// What a pair loses of its water, by row and column: strengths times volumes, and the exponents.
struct SolvationOfPair {
    V of_row, of_column, row_scale, row_offset, column_scale, column_offset;
};

// E' and E'' of a pair, and its energies; of Lennard-Jones 12 times.
struct SmoothTerms {
    V first, second, van_der_waals, electrostatic, solvation;
};

// Both smooth ends, with a dielectric that grows with the distance, and solvation. With s = r^2, so
// that d/du = 2 d/ds:
//   E' = -2 K (1 - s/c^2)^2 (1 + 2 s/c^2)/s^2,  E'' = 8 K (1/s^3 - 1/c^6) of electrostatics.
class SmoothLaw {
public:
    static constexpr bool ends = true, takes_solvation = true;

    explicit HWY_INLINE SmoothLaw(const PairScheme& scheme) {
        const double c2 = scheme.cutoff * scheme.cutoff;
        const double range = c2 - scheme.switch_from * scheme.switch_from;
        c2_ = all(c2);
        inverse_c2_ = all(1 / c2);
        inverse_c6_ = all(1 / (c2 * c2 * c2));
        scale_ = all(1 / range);
        offset_ = all(-scheme.switch_from * scheme.switch_from / range);
        slope_ = all(-60 / range);
        curvature_ = all(-240 / (range * range));
        // Without solvation all is beyond its end.
        const bool is_solvated = scheme.solvation_end > 0;
        const double begin = is_solvated ? scheme.solvation_begin : -2;
        const double end = is_solvated ? scheme.solvation_end : -1;
        begin_ = all(begin / (end - begin));
        width_ = all(1 / (end - begin));
        solvation_slope_ = all(-30 / (end - begin));
        solvation_curvature_ = all(-60 / ((end - begin) * (end - begin)));
        farthest_ = all(std::max(1.0, end));
    }

    HWY_INLINE Slopes evaluate(const PairNumbers& pair) const {
        const SmoothTerms terms = find(pair, inverse(pair.r2));
        return {terms.first, terms.second};
    }

    // With 1/r^2; without solvation.
    HWY_INLINE SmoothTerms find(const PairNumbers& pair, V inverse_s) const {
        const V inverse_s2 = hn::Mul(inverse_s, inverse_s);
        // Electrostatics.
        const V q = hn::Min(hn::Mul(pair.r2, inverse_c2_), all(1)), left = hn::Sub(all(1), q);
        const V steep = hn::Mul(hn::Mul(left, left), hn::MulAdd(q, all(2), all(1)));
        const V twice = hn::Mul(pair.charges, all(-2));
        V first = hn::Mul(hn::Mul(twice, steep), inverse_s2);
        const V cubes = hn::MulSub(inverse_s2, inverse_s, inverse_c6_);
        V second =
            hn::IfThenElseZero(hn::Lt(pair.r2, c2_), hn::Mul(hn::Mul(twice, all(-4)), cubes));
        // Lennard-Jones, whole: e, e' and e''.
        const V t2 = hn::Mul(hn::Mul(pair.rmin, pair.rmin), inverse_s);
        const V t = hn::Mul(hn::Mul(t2, t2), t2), well = hn::Mul(pair.epsilon12, t);
        const V wall = hn::Mul(well, t);
        const V e12 = hn::NegMulAdd(well, all(2), wall), e = hn::Mul(e12, all(1.0 / 12));
        const V e1 = hn::Mul(hn::Sub(well, wall), inverse_s);
        const V e2 = hn::Mul(hn::MulSub(wall, all(14), hn::Mul(well, all(8))), inverse_s2);
        const V y =
            hn::Min(hn::Max(hn::MulAdd(pair.r2, scale_, offset_), hn::Zero(floats)), all(1));
        const V both = hn::NegMulAdd(y, y, y);
        const V p = hn::MulAdd(hn::MulAdd(y, all(6), all(-15)), y, all(10));
        const V S = hn::NegMulAdd(hn::Mul(hn::Mul(y, y), y), p, all(1));
        const V S1 = hn::Mul(slope_, hn::Mul(both, both));
        const V S2 = hn::Mul(hn::Mul(curvature_, both), hn::NegMulAdd(y, all(2), all(1)));
        first = hn::Add(first, hn::MulAdd(e1, S, hn::Mul(e, S1)));
        second =
            hn::Add(second, hn::MulAdd(e2, S, hn::MulAdd(hn::Mul(e1, all(2)), S1, hn::Mul(e, S2))));
        const V electrostatic =
            hn::Mul(hn::Mul(hn::Mul(pair.charges, left), hn::Mul(left, left)), inverse_s);
        return {first, second, hn::Mul(e12, S), electrostatic, hn::Zero(floats)};
    }

    // With P what the pair has without an end, by r: P = -sum of b g, g = exp(-x^2)/r^2 with
    // a = 2 x/lambda; g' = -(a + 2/r) g, g'' = (a^2 + 4 a/r + 6/r^2 - 2/lambda^2) g.
    HWY_INLINE void add_solvation(V r2, const SolvationOfPair& pair, Slopes& slopes) const {
        const SmoothTerms terms = find_solvation(r2, inverse_root(r2), pair);
        slopes.first = hn::Add(slopes.first, terms.first);
        slopes.second = hn::Add(slopes.second, terms.second);
    }

    HWY_INLINE SmoothTerms find_solvation(V r2, V inverse_r, const SolvationOfPair& pair) const {
        const V inverse_r2 = hn::Mul(inverse_r, inverse_r);
        const V r = hn::Min(hn::Mul(r2, inverse_r), farthest_);
        const V ln4 = all(2 * std::numbers::ln2);
        const V row_x = hn::MulSub(r, pair.row_scale, pair.row_offset);
        const V column_x = hn::MulSub(r, pair.column_scale, pair.column_offset);
        const V row = hn::Mul(pair.of_row, power_of_minus_square(row_x));
        const V column = hn::Mul(pair.of_column, power_of_minus_square(column_x));
        const V row_a = hn::Mul(hn::Mul(row_x, pair.row_scale), ln4);
        const V column_a = hn::Mul(hn::Mul(column_x, pair.column_scale), ln4);
        const V sum = hn::Add(row, column);
        const V sum_a = hn::MulAdd(row, row_a, hn::Mul(column, column_a));
        const V of_row =
            hn::NegMulAdd(hn::Mul(pair.row_scale, pair.row_scale), ln4, hn::Mul(row_a, row_a));
        const V of_column = hn::NegMulAdd(hn::Mul(pair.column_scale, pair.column_scale), ln4,
                                          hn::Mul(column_a, column_a));
        const V P = hn::Neg(hn::Mul(sum, inverse_r2));
        const V P1 = hn::Mul(hn::MulAdd(hn::Add(sum, sum), inverse_r, sum_a), inverse_r2);
        const V near = hn::MulAdd(hn::Mul(sum_a, all(4)), inverse_r,
                                  hn::Mul(hn::Mul(sum, all(6)), inverse_r2));
        const V P2 = hn::Neg(hn::Mul(
            hn::Add(near, hn::MulAdd(row, of_row, hn::Mul(column, of_column))), inverse_r2));
        const V t = hn::Min(hn::Max(hn::MulSub(r, width_, begin_), hn::Zero(floats)), all(1));
        const V both = hn::NegMulAdd(t, t, t);
        const V p = hn::MulAdd(hn::MulAdd(t, all(6), all(-15)), t, all(10));
        const V S = hn::NegMulAdd(hn::Mul(hn::Mul(t, t), t), p, all(1));
        const V S1 = hn::Mul(solvation_slope_, hn::Mul(both, both));
        const V S2 = hn::Mul(hn::Mul(solvation_curvature_, both), hn::NegMulAdd(t, all(2), all(1)));
        const V along = hn::MulAdd(P1, S, hn::Mul(P, S1));
        const V bend = hn::MulAdd(P2, S, hn::MulAdd(hn::Mul(P1, all(2)), S1, hn::Mul(P, S2)));
        const V first = hn::Mul(along, inverse_r);
        return {first, hn::Mul(hn::Sub(bend, first), inverse_r2), hn::Zero(floats),
                hn::Zero(floats), hn::Mul(P, S)};
    }

private:
    V c2_, inverse_c2_, inverse_c6_, scale_, offset_, slope_, curvature_;
    V begin_, width_, solvation_slope_, solvation_curvature_, farthest_;
};

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
