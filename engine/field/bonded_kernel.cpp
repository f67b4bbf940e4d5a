#include "field/bonded_kernel.h"

#include <array>
#include <cstddef>

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/bonded_kernel.cpp"
#include <hwy/foreach_target.h>  // before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using V = hn::Vec<Doubles>;

constexpr Doubles doubles;
constexpr std::size_t lane_count = hn::MaxLanes(Doubles());

HWY_INLINE V all(double value) { return hn::Set(doubles, value); }
HWY_INLINE V load(const Column& column, std::size_t t) {
    return hn::Load(doubles, column.at.data() + t);
}

struct Vector {
    V x, y, z;
};
HWY_INLINE Vector load(const Columns3& columns, std::size_t t) {
    return {load(columns.x, t), load(columns.y, t), load(columns.z, t)};
}
HWY_INLINE void store(const Vector& v, Columns3& columns, std::size_t t) {
    hn::Store(v.x, doubles, columns.x.at.data() + t);
    hn::Store(v.y, doubles, columns.y.at.data() + t);
    hn::Store(v.z, doubles, columns.z.at.data() + t);
}
HWY_INLINE V dot(const Vector& a, const Vector& b) {
    return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}
HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
HWY_INLINE Vector scaled(V factor, const Vector& v) {
    return {hn::Mul(factor, v.x), hn::Mul(factor, v.y), hn::Mul(factor, v.z)};
}
HWY_INLINE double sum_of(V v) { return hn::GetLane(hn::SumOfLanes(doubles, v)); }

// atan2(y, x). The tangent of half the angle is halved until
// fourteen terms of the series are as good as all; for angles of a molecule at rest, a few degrees
// from where they belong, at once.
HWY_INLINE V angle_of(V x, V y) {
    const V r = hn::Sqrt(hn::MulAdd(y, y, hn::Mul(x, x)));
    const V above = hn::Max(hn::Add(r, hn::Abs(x)), all(1e-270)), beside = hn::Abs(y);
    const auto is_wide = hn::Lt(x, hn::Zero(doubles));
    V t = hn::Div(hn::IfThenElse(is_wide, above, beside),
                  hn::IfThenElse(is_wide, hn::Max(beside, hn::Mul(above, all(1e-30))), above));
    V times = all(2);
    while (!hn::AllFalse(doubles, hn::Gt(t, all(0.25)))) {
        t = hn::Div(t, hn::Add(all(1), hn::Sqrt(hn::MulAdd(t, t, all(1)))));
        times = hn::Add(times, times);
    }
    const V minus_t2 = hn::Neg(hn::Mul(t, t));
    V series = all(1.0 / 27);
    for (int n = 25; n > 0; n -= 2) series = hn::MulAdd(series, minus_t2, all(1.0 / n));
    return hn::CopySign(hn::Mul(hn::Mul(times, t), series), y);
}

double sum_springs(const SpringNumbers& numbers, const Columns3& d, Columns3& on_a) {
    V energy = hn::Zero(doubles);
    for (std::size_t t = 0; t < block_size; t += lane_count) {
        const Vector vector = load(d, t);
        const V r = hn::Sqrt(dot(vector, vector));
        const V stretch = hn::Sub(r, load(numbers.r0, t));
        const V k_stretch = hn::Mul(load(numbers.k, t), stretch);
        energy = hn::MulAdd(k_stretch, stretch, energy);
        const V gradient = hn::IfThenElseZero(hn::Gt(r, hn::Zero(doubles)),
                                              hn::Div(hn::Mul(all(-2), k_stretch), r));
        store(scaled(gradient, vector), on_a, t);
    }
    return sum_of(energy);
}

double sum_angles(const AngleNumbers& numbers, const Columns3& u_columns, const Columns3& v_columns,
                  Columns3& on_a, Columns3& on_c) {
    const V shortest2 = all(1e-20);  // Å^2
    const V in_line2 = all(1e-20);   // of the sine
    V energy = hn::Zero(doubles);
    for (std::size_t t = 0; t < block_size; t += lane_count) {
        const Vector u = load(u_columns, t), v = load(v_columns, t), normal = cross(u, v);
        const V u2 = dot(u, u), v2 = dot(v, v), normal2 = dot(normal, normal);
        // Times |u| |v|; an angle of nothing is 0.
        const V sine = hn::Sqrt(normal2), product = dot(u, v);
        const auto is_somewhere = hn::Gt(hn::Max(sine, hn::Abs(product)), hn::Zero(doubles));
        const V cosine = hn::IfThenElse(is_somewhere, product, all(1));
        const V cosine0 = load(numbers.cos_theta0, t), sine0 = load(numbers.sin_theta0, t);
        const V bend = angle_of(hn::MulAdd(cosine, cosine0, hn::Mul(sine, sine0)),
                                hn::MulSub(sine, cosine0, hn::Mul(cosine, sine0)));
        const V k_bend = hn::Mul(load(numbers.k, t), bend);
        energy = hn::MulAdd(k_bend, bend, energy);
        const V u2v2 = hn::Mul(u2, v2);
        const auto bends = hn::And(hn::And(hn::Gt(u2, shortest2), hn::Gt(v2, shortest2)),
                                   hn::Gt(normal2, hn::Mul(in_line2, u2v2)));
        const V force =
            hn::IfThenElseZero(bends, hn::Div(hn::Mul(all(-2), k_bend), hn::Mul(sine, u2v2)));
        store(scaled(hn::Mul(force, v2), cross(u, normal)), on_a, t);
        store(scaled(hn::Mul(force, u2), cross(normal, v)), on_c, t);
    }
    return sum_of(energy);
}

// As `evaluate_torsion` of forces/torsion.h.
struct Torsion {
    V cosine, sine;
    Vector of_F, of_G, of_H;  // d(angle)/dF and so on, rad/Å
};
HWY_INLINE Torsion evaluate_torsion(const TorsionBlock& block, std::size_t t) {
    constexpr double guard = 0.005;  // torsion_guard
    const Vector F = load(block.F, t), G = load(block.G, t), H = load(block.H, t);
    const Vector A = cross(F, G), B = cross(H, G);
    const V a2 = dot(A, A), b2 = dot(B, B), length2 = dot(G, G), length = hn::Sqrt(length2);
    const V x = dot(A, B), y = hn::Mul(length, dot(H, A));
    const V r2 = hn::MulAdd(y, y, hn::Mul(x, x));
    const auto is_turned = hn::Gt(r2, all(1e-200));
    const V inverse_r = hn::Div(all(1), hn::Sqrt(r2));
    Torsion torsion;
    torsion.cosine = hn::IfThenElse(is_turned, hn::Mul(x, inverse_r), all(1));
    torsion.sine = hn::IfThenElseZero(is_turned, hn::Mul(y, inverse_r));

    const V planes2 = hn::Mul(a2, b2);
    const auto has_planes =
        hn::And(hn::Gt(planes2, all(1e-200)), hn::Gt(length2, hn::Zero(doubles)));
    const V scale = hn::Min(all(1), hn::Mul(hn::Min(a2, b2), all(1 / (guard * guard))));
    const V factor = hn::IfThenElseZero(has_planes, hn::Div(hn::Mul(length, scale), planes2));
    const V inverse_length2 = hn::IfThenElseZero(has_planes, hn::Div(all(1), length2));
    torsion.of_F = scaled(hn::Neg(hn::Mul(factor, b2)), A);
    torsion.of_H = scaled(hn::Mul(factor, a2), B);
    const V along_F = hn::Mul(dot(F, G), inverse_length2),
            along_H = hn::Mul(dot(H, G), inverse_length2);
    const auto of_G = [&](V of_F, V of_H) HWY_ATTR {
        return hn::Neg(hn::MulAdd(along_F, of_F, hn::Mul(along_H, of_H)));
    };
    torsion.of_G = {of_G(torsion.of_F.x, torsion.of_H.x), of_G(torsion.of_F.y, torsion.of_H.y),
                    of_G(torsion.of_F.z, torsion.of_H.z)};
    return torsion;
}

// Of an energy with this slope over the angle.
HWY_INLINE void store_forces(V slope, const Torsion& torsion, TorsionBlock& block, std::size_t t) {
    const V factor = hn::Neg(slope);
    store(scaled(factor, torsion.of_F), block.on_F, t);
    store(scaled(factor, torsion.of_G), block.on_G, t);
    store(scaled(factor, torsion.of_H), block.on_H, t);
}

double sum_dihedrals(const DihedralNumbers& numbers, TorsionBlock& block) {
    V energy = hn::Zero(doubles);
    for (std::size_t t = 0; t < block_size; t += lane_count) {
        const Torsion torsion = evaluate_torsion(block, t);
        V cosine = torsion.cosine, sine = torsion.sine;  // of n phi
        V slope = hn::Zero(doubles), n = all(1);
        for (std::size_t i = 0; i < numbers.cosine.size(); ++i) {
            const V c = load(numbers.cosine[i], t), s = load(numbers.sine[i], t);
            energy = hn::MulAdd(c, cosine, hn::MulAdd(s, sine, energy));
            slope = hn::MulAdd(n, hn::MulSub(s, cosine, hn::Mul(c, sine)), slope);
            const V next = hn::MulSub(cosine, torsion.cosine, hn::Mul(sine, torsion.sine));
            sine = hn::MulAdd(sine, torsion.cosine, hn::Mul(cosine, torsion.sine));
            cosine = next;
            n = hn::Add(n, all(1));
        }
        store_forces(slope, torsion, block, t);
    }
    return sum_of(energy);
}

double sum_impropers(const ImproperNumbers& numbers, TorsionBlock& block) {
    V energy = hn::Zero(doubles);
    for (std::size_t t = 0; t < block_size; t += lane_count) {
        const Torsion torsion = evaluate_torsion(block, t);
        const V cosine0 = load(numbers.cos_psi0, t), sine0 = load(numbers.sin_psi0, t);
        const V bend = angle_of(hn::MulAdd(torsion.cosine, cosine0, hn::Mul(torsion.sine, sine0)),
                                hn::MulSub(torsion.sine, cosine0, hn::Mul(torsion.cosine, sine0)));
        const V k_bend = hn::Mul(load(numbers.k, t), bend);
        energy = hn::MulAdd(k_bend, bend, energy);
        store_forces(hn::Add(k_bend, k_bend), torsion, block, t);
    }
    return sum_of(energy);
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {

HWY_EXPORT(sum_springs);
HWY_EXPORT(sum_angles);
HWY_EXPORT(sum_dihedrals);
HWY_EXPORT(sum_impropers);

double evaluate_springs(const SpringNumbers& numbers, const Columns3& d, Columns3& on_a) noexcept {
    return HWY_DYNAMIC_DISPATCH(sum_springs)(numbers, d, on_a);
}

double evaluate_angles(const AngleNumbers& numbers, const Columns3& u, const Columns3& v,
                       Columns3& on_a, Columns3& on_c) noexcept {
    return HWY_DYNAMIC_DISPATCH(sum_angles)(numbers, u, v, on_a, on_c);
}

double evaluate_dihedrals(const DihedralNumbers& numbers, TorsionBlock& block) noexcept {
    return HWY_DYNAMIC_DISPATCH(sum_dihedrals)(numbers, block);
}

double evaluate_impropers(const ImproperNumbers& numbers, TorsionBlock& block) noexcept {
    return HWY_DYNAMIC_DISPATCH(sum_impropers)(numbers, block);
}

}  // namespace palpa
#endif  // HWY_ONCE
