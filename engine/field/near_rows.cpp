#include "field/near_rows.h"

#include <cstddef>
#include <cstdint>

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/near_rows.cpp"
#include <hwy/foreach_target.h>  // before highway.h

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

const hn::CappedTag<double, cluster_size> doubles;

// Calls visit(row, first column, which of the columns from there on are near).
template <class Visit>
HWY_INLINE void visit_near(const ClusterPlaces& a, const ClusterPlaces& b, double reach2,
                           const Visit& visit) {
    const auto reach = hn::Set(doubles, reach2);
    for (std::size_t column = 0; column < cluster_size; column += hn::Lanes(doubles)) {
        const auto x = hn::Load(doubles, b.x.data() + column);
        const auto y = hn::Load(doubles, b.y.data() + column);
        const auto z = hn::Load(doubles, b.z.data() + column);
        for (std::size_t row = 0; row < cluster_size; ++row) {
            const auto dx = hn::Sub(hn::Set(doubles, a.x[row]), x);
            const auto dy = hn::Sub(hn::Set(doubles, a.y[row]), y);
            const auto dz = hn::Sub(hn::Set(doubles, a.z[row]), z);
            // Not fused: the same bits everywhere.
            const auto xy = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
            visit(row, column, hn::Lt(hn::Add(xy, hn::Mul(dz, dz)), reach));
        }
    }
}

std::uint32_t near_rows(const ClusterPlaces& a, const ClusterPlaces& b, double reach2) {
    std::uint32_t rows = 0;
    visit_near(a, b, reach2, [&](std::size_t row, std::size_t, auto is_near) HWY_ATTR {
        rows |= static_cast<std::uint32_t>(!hn::AllFalse(doubles, is_near)) << row;
    });
    return rows;
}

std::uint64_t near_pairs(const ClusterPlaces& a, const ClusterPlaces& b, double reach2) {
    std::uint64_t pairs = 0;
    visit_near(a, b, reach2, [&](std::size_t row, std::size_t column, auto is_near) HWY_ATTR {
        std::uint8_t bits[8] = {};
        (void)hn::StoreMaskBits(doubles, is_near, bits);
        pairs |= std::uint64_t{bits[0]} << (row * cluster_size + column);
    });
    return pairs;
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {

HWY_EXPORT(near_rows);
HWY_EXPORT(near_pairs);

std::uint32_t find_near_rows(const ClusterPlaces& a, const ClusterPlaces& b,
                             double reach2) noexcept {
    return HWY_DYNAMIC_DISPATCH(near_rows)(a, b, reach2);
}

std::uint64_t find_near_pairs(const ClusterPlaces& a, const ClusterPlaces& b,
                              double reach2) noexcept {
    return HWY_DYNAMIC_DISPATCH(near_pairs)(a, b, reach2);
}

}  // namespace palpa
#endif  // HWY_ONCE
