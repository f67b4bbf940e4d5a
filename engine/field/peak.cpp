#include "field/peak.h"

#include <cstddef>

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/peak.cpp"
#include <hwy/foreach_target.h>  // before highway.h

#include "field/pair_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {

PeakRun multiply_and_add(std::size_t rounds) {
    // Twelve chains hide how long one step takes: on no processor more than six are under way at a
    // time on each of two ports.
    const V a = all(0.5), b = all(1);
    V x0 = all(1), x1 = x0, x2 = x0, x3 = x0, x4 = x0, x5 = x0;
    V x6 = x0, x7 = x0, x8 = x0, x9 = x0, x10 = x0, x11 = x0;
    for (std::size_t round = 0; round < rounds; ++round) {
        x0 = hn::MulAdd(x0, a, b);
        x1 = hn::MulAdd(x1, a, b);
        x2 = hn::MulAdd(x2, a, b);
        x3 = hn::MulAdd(x3, a, b);
        x4 = hn::MulAdd(x4, a, b);
        x5 = hn::MulAdd(x5, a, b);
        x6 = hn::MulAdd(x6, a, b);
        x7 = hn::MulAdd(x7, a, b);
        x8 = hn::MulAdd(x8, a, b);
        x9 = hn::MulAdd(x9, a, b);
        x10 = hn::MulAdd(x10, a, b);
        x11 = hn::MulAdd(x11, a, b);
    }
    V sum = hn::Add(hn::Add(hn::Add(x0, x1), hn::Add(x2, x3)), hn::Add(hn::Add(x4, x5), x6));
    sum = hn::Add(sum, hn::Add(hn::Add(hn::Add(x7, x8), hn::Add(x9, x10)), x11));
    return {2.0 * 12 * static_cast<double>(lane_count) * static_cast<double>(rounds),
            hn::GetLane(sum)};
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {

HWY_EXPORT(multiply_and_add);

PeakRun run_multiply_adds(std::size_t rounds) noexcept {
    return HWY_DYNAMIC_DISPATCH(multiply_and_add)(rounds);
}

}  // namespace palpa
#endif  // HWY_ONCE
