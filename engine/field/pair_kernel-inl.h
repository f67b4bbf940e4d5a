// What the single-precision kernels share, compiled once for each kind of processor: included
// again and again by Highway's foreach_target, so there is no #pragma once.
#if defined(PALPA_PAIR_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PALPA_PAIR_KERNEL_INL
#undef PALPA_PAIR_KERNEL_INL
#else
#define PALPA_PAIR_KERNEL_INL
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
#if HWY_TARGET == HWY_SCALAR
using Doubles = hn::CappedTag<double, 1>;
#else
using HalfFloats = hn::Half<Floats>;
using Doubles = hn::Rebind<double, HalfFloats>;
#endif
using V = hn::Vec<Floats>;
using M = hn::Mask<Floats>;
using W = hn::Vec<Doubles>;

constexpr Floats floats;
constexpr Doubles doubles;
constexpr std::size_t lane_count = hn::MaxLanes(Floats());

HWY_INLINE V all(double value) { return hn::Set(floats, static_cast<float>(value)); }

// 1/sqrt(x) to the last bit or two, from the processor's estimate e: with h = 1 - x e^2,
// (1 - h)^(-1/2) = 1 + h/2 + 3h^2/8 + ...
HWY_INLINE V inverse_root(V x) {
    const V e = hn::ApproximateReciprocalSqrt(x);
    const V h = hn::NegMulAdd(hn::Mul(x, e), e, all(1));
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return hn::MulAdd(hn::Mul(e, all(0.5)), h, e);  // 14 bits to begin with
#else
    const V first = hn::MulAdd(hn::Mul(e, h), hn::MulAdd(h, all(0.375), all(0.5)), e);
#if HWY_ARCH_ARM
    return hn::MulAdd(hn::Mul(first, all(0.5)), hn::NegMulAdd(hn::Mul(x, first), first, all(1)),
                      first);  // 8 bits
#else
    return first;
#endif
#endif
}

// 1/x to the last bit or two: with h = 1 - x e, 1/(1 - h) = 1 + h + h^2 + ...
HWY_INLINE V inverse(V x) {
    const V e = hn::ApproximateReciprocal(x);
    const V h = hn::NegMulAdd(x, e, all(1));
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
    return hn::MulAdd(e, h, e);  // 14 bits to begin with
#else
    const V first = hn::MulAdd(hn::Mul(e, h), hn::Add(h, all(1)), e);
#if HWY_ARCH_ARM
    return hn::MulAdd(first, hn::NegMulAdd(x, first, all(1)), first);  // 8 bits
#else
    return first;
#endif
#endif
}

// 2^(-x^2) to 1e-7, for x^2 below 100: with n whole and f within a half of zero, 2^n p(f).
HWY_INLINE V power_of_minus_square(V x) {
    const hn::RebindToSigned<Floats> integers;
    const V whole = all(12582912);  // 1.5 * 2^23: what is added to it is rounded to a whole number
    const V shifted = hn::NegMulAdd(x, x, whole);
    const V f = hn::NegMulSub(x, x, hn::Sub(shifted, whole));
    V p = hn::MulAdd(f, all(0.0013390863364533504), all(0.009676031918326564));
    p = hn::MulAdd(p, f, all(0.05550357114219461));
    p = hn::MulAdd(p, f, all(0.24022107485308208));
    p = hn::MulAdd(p, f, all(0.6931471880262287));
    p = hn::MulAdd(p, f, all(1.0000000754548972));
    const auto exponent = hn::ShiftLeft<23>(hn::BitCast(integers, shifted));
    return hn::BitCast(floats, hn::Add(hn::BitCast(integers, p), exponent));
}

// The two halves of some floats, in double; of a single one, the upper half is nothing.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE W lower_half(V v) { return hn::PromoteTo(doubles, v); }
HWY_INLINE W upper_half(V) { return hn::Zero(doubles); }
#else
HWY_INLINE W lower_half(V v) { return hn::PromoteTo(doubles, hn::LowerHalf(v)); }
HWY_INLINE W upper_half(V v) { return hn::PromoteTo(doubles, hn::UpperHalf(HalfFloats(), v)); }
#endif

HWY_INLINE double sum_of(W v) { return hn::GetLane(hn::SumOfLanes(doubles, v)); }
HWY_INLINE double sum_of(V v) { return sum_of(hn::Add(lower_half(v), upper_half(v))); }

}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
