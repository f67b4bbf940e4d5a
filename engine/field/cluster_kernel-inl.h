// What the kernels over lists of clusters share, compiled once for each kind of processor: included
// again and again by Highway's foreach_target, so there is no #pragma once.
#if defined(PALPA_CLUSTER_KERNEL_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef PALPA_CLUSTER_KERNEL_INL
#undef PALPA_CLUSTER_KERNEL_INL
#else
#define PALPA_CLUSTER_KERNEL_INL
#endif

#include "field/pair_kernel-inl.h"
#include "field/pair_kernel.h"

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {

// Loads as many atoms as there are lanes: part of one cluster, or two clusters.
HWY_INLINE V load_columns(const ClusterAtoms::Column& first,
                          [[maybe_unused]] const ClusterAtoms::Column& second, std::size_t column) {
#if HWY_MAX_BYTES == 64
    const HalfFloats half;
    return hn::Combine(floats, hn::Load(half, second.data()), hn::Load(half, first.data()));
#else
    return hn::Load(floats, first.data() + column);
#endif
}

HWY_INLINE void subtract(W force, double* sums) {
    hn::Store(hn::Sub(hn::Load(doubles, sums), force), doubles, sums);
}

// Subtracts the forces on the rows from those on their columns.
HWY_INLINE void subtract_from_columns(V force, std::array<double, cluster_size>& first,
                                      std::array<double, cluster_size>& second,
                                      std::size_t column) {
    subtract(lower_half(force), first.data() + column);
    if constexpr (lane_count > cluster_size) {
        subtract(upper_half(force), second.data());
    } else if constexpr (lane_count > 1) {
        subtract(upper_half(force), first.data() + column + lane_count / 2);
    }
}

// Adds gradient times distance to the force on a column and to that on a row.
HWY_INLINE void add_force(V gradient, V distance, V& on_column, float* on_row) {
#if HWY_NATIVE_FMA
    on_column = hn::MulAdd(gradient, distance, on_column);
    hn::Store(hn::MulAdd(gradient, distance, hn::Load(floats, on_row)), floats, on_row);
#else
    const V force = hn::Mul(gradient, distance);
    on_column = hn::Add(on_column, force);
    hn::Store(hn::Add(hn::Load(floats, on_row), force), floats, on_row);
#endif
}

// Mask of the pairs of a row.
HWY_INLINE M load_mask(std::uint64_t first, std::uint64_t second, std::uint32_t row,
                       std::size_t column) {
    std::uint8_t bits[8] = {};
    const std::uint64_t of_first = first >> (8 * row) & 0xff;
    if constexpr (lane_count > cluster_size) {
        bits[0] = static_cast<std::uint8_t>(of_first);
        bits[1] = static_cast<std::uint8_t>(second >> (8 * row));
    } else {
        bits[0] = static_cast<std::uint8_t>(of_first >> column);
    }
    return hn::LoadMaskBits(floats, bits);
}

// Bits of the rows with at least one pair.
HWY_INLINE std::uint32_t rows_of(std::uint64_t pairs) {
    pairs |= pairs >> 4;
    pairs |= pairs >> 2;
    pairs |= pairs >> 1;
    pairs &= 0x0101010101010101U;
    return static_cast<std::uint32_t>(pairs * 0x0102040810204080U >> 56);
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
