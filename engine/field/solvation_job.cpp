#include "field/solvation_job.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>

// Of a lambda that runs in the innermost loop; other compilers know no such word there.
#undef PALPA_INLINED
#ifdef __GNUC__
#define PALPA_INLINED __attribute__((always_inline))
#else
#define PALPA_INLINED
#endif

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/solvation_job.cpp"
#include <hwy/foreach_target.h>  // before highway.h

#include "field/cluster_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {

// The atoms of one cluster, which a row of pairs each is about.
struct SolvationRows {
    alignas(64) float x[cluster_size], y[cluster_size], z[cluster_size];  // Å, from the centre
    alignas(64) float volume[cluster_size], strength[cluster_size];
    alignas(64) float scale[cluster_size], offset[cluster_size];
    // The forces on them, of some hundred columns, side by side.
    alignas(64) float fx[cluster_size][lane_count], fy[cluster_size][lane_count],
        fz[cluster_size][lane_count];
};

class SolvationKernel {
public:
    explicit HWY_INLINE SolvationKernel(const SolvationJob& job)
        : list_(*job.list),
          atoms_(job.atoms),
          forces_(job.forces),
          width_(all(1 / (job.end - job.begin))),
          begin_(all(job.begin / (job.end - job.begin))),
          slope_(all(15 / (job.end - job.begin))),
          farthest_(all(job.end)),
          nearest2_(all(std::numeric_limits<float>::infinity())),
          energy_(hn::Zero(doubles)) {}

    SolvationJobSum sum(std::size_t first, std::size_t last) {
        for (std::size_t c = first; c < last; ++c) sum_cluster(c);
        return {0.5 * sum_of(energy_), hn::GetLane(hn::MinOfLanes(floats, nearest2_))};
    }

private:
    static constexpr std::size_t step = lane_count > cluster_size ? 2 : 1;
    // As in pair_job.cpp.
    static constexpr std::size_t most_tiles = 16 * step;
    static constexpr std::size_t most_stretches = 8;

    // Of a few hundred pairs; kept in registers.
    struct Sums {
        V nearest2, energy;
    };

    HWY_INLINE void sum_cluster(std::size_t c) {
        load_rows(c);
        Sums sums{nearest2_, hn::Zero(floats)};
        std::size_t stretches = 0;
        const std::size_t plain_end = list_.first_plain[c + 1];
        for (std::size_t t = list_.first_plain[c]; t < plain_end && list_.plain[t].rows != 0;) {
            const std::size_t end = std::min(t + most_tiles, plain_end);
            for (; t < end && list_.plain[t].rows != 0; t += step) {
                const ClusterTile& first = list_.plain[t];
                const ClusterTile& second = list_.plain[t + step - 1];
                sum_tile<false>(sums, first.cluster, second.cluster, first.rows | second.rows, 0,
                                0);
            }
            flush_energy(sums);
            if (++stretches % most_stretches == 0) flush_rows(c);
        }
        const std::size_t masked_end = list_.first_masked[c + 1];
        for (std::size_t t = list_.first_masked[c]; t < masked_end && list_.masked[t].pairs != 0;) {
            const std::size_t end = std::min(t + most_tiles, masked_end);
            for (; t < end && list_.masked[t].pairs != 0; t += step) {
                const MaskedTile& first = list_.masked[t];
                const MaskedTile& second = list_.masked[t + step - 1];
                sum_tile<true>(sums, first.cluster, second.cluster,
                               rows_of(first.pairs | second.pairs), first.pairs, second.pairs);
            }
            flush_energy(sums);
            if (++stretches % most_stretches == 0) flush_rows(c);
        }
        flush_rows(c);
        nearest2_ = sums.nearest2;
    }

    HWY_INLINE void load_rows(std::size_t c) {
        const SolvationCluster& atoms = atoms_[c];
        for (std::size_t k = 0; k < 3; ++k) centre_[k] = atoms.high[k][0];
        for (std::size_t r = 0; r < cluster_size; ++r) {
            rows_.x[r] = (atoms.high[0][r] - centre_[0]) + atoms.low[0][r];
            rows_.y[r] = (atoms.high[1][r] - centre_[1]) + atoms.low[1][r];
            rows_.z[r] = (atoms.high[2][r] - centre_[2]) + atoms.low[2][r];
            rows_.volume[r] = atoms.volume[r];
            rows_.strength[r] = 2 * atoms.strength[r];
            rows_.scale[r] = atoms.scale[r];
            rows_.offset[r] = atoms.offset[r];
        }
        clear_row_forces();
    }

    HWY_INLINE void clear_row_forces() {
        for (std::size_t r = 0; r < cluster_size; ++r) {
            hn::Store(hn::Zero(floats), floats, rows_.fx[r]);
            hn::Store(hn::Zero(floats), floats, rows_.fy[r]);
            hn::Store(hn::Zero(floats), floats, rows_.fz[r]);
        }
    }

    // Move sums in single precision to those in double.
    HWY_INLINE void flush_rows(std::size_t c) {
        ClusterForces& forces = forces_[c];
        for (std::size_t r = 0; r < cluster_size; ++r) {
            forces.on[0][r] += sum_of(hn::Load(floats, rows_.fx[r]));
            forces.on[1][r] += sum_of(hn::Load(floats, rows_.fy[r]));
            forces.on[2][r] += sum_of(hn::Load(floats, rows_.fz[r]));
        }
        clear_row_forces();
    }

    HWY_INLINE void flush_energy(Sums& sums) {
        energy_ = hn::Add(energy_, hn::Add(lower_half(sums.energy), upper_half(sums.energy)));
        sums.energy = hn::Zero(floats);
    }

    template <bool IsMasked>
    HWY_INLINE void sum_tile(Sums& sums, std::uint32_t first, std::uint32_t second,
                             std::uint32_t rows, std::uint64_t first_pairs,
                             std::uint64_t second_pairs) {
        const SolvationCluster& a = atoms_[first];
        const SolvationCluster& b = atoms_[second];
        const V width = width_, begin = begin_, slope = slope_, farthest = farthest_;
        HWY_UNROLL(1)
        for (std::size_t column = 0; column < cluster_size; column += lane_count) {
            const auto place = [&](std::size_t k) HWY_ATTR {
                return hn::Add(hn::Sub(load_columns(a.high[k], b.high[k], column),
                                       hn::Set(floats, centre_[k])),
                               load_columns(a.low[k], b.low[k], column));
            };
            const V x = place(0), y = place(1), z = place(2);
            const V volume = load_columns(a.volume, b.volume, column);
            const V strength = hn::Mul(load_columns(a.strength, b.strength, column), all(2));
            const V scale = load_columns(a.scale, b.scale, column);
            const V offset = load_columns(a.offset, b.offset, column);
            V fx = hn::Zero(floats), fy = fx, fz = fx;
            const auto add_row = [&](std::uint32_t r) HWY_ATTR PALPA_INLINED {
                const V dx = hn::Sub(hn::Set(floats, rows_.x[r]), x);
                const V dy = hn::Sub(hn::Set(floats, rows_.y[r]), y);
                const V dz = hn::Sub(hn::Set(floats, rows_.z[r]), z);
                const V distance2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
                const V row_scale = hn::Set(floats, rows_.scale[r]);
                V counted2 = distance2, r2 = distance2;
                V of_row = hn::Mul(hn::Set(floats, rows_.strength[r]), volume);
                V of_column = hn::Mul(hn::Set(floats, rows_.volume[r]), strength);
                if constexpr (IsMasked) {
                    const M pairs = load_mask(first_pairs, second_pairs, r, column);
                    counted2 = hn::IfThenElse(pairs, distance2, all(1e30));
                    of_row = hn::IfThenElseZero(pairs, of_row);
                    of_column = hn::IfThenElseZero(pairs, of_column);
                    r2 = hn::Max(distance2, all(1e-2));  // one that does not count
                }
                sums.nearest2 = hn::Min(sums.nearest2, counted2);
                const V inverse_r = inverse_root(r2), inverse_r2 = hn::Mul(inverse_r, inverse_r);
                // There is nothing farther out, where the power would overflow.
                const V distance = hn::Min(hn::Mul(r2, inverse_r), farthest);
                // Twice what row and column lose, times r^2, and its slope's part by the exponent.
                const V row_x = hn::MulSub(distance, row_scale, hn::Set(floats, rows_.offset[r]));
                const V column_x = hn::MulSub(distance, scale, offset);
                of_row = hn::Mul(of_row, power_of_minus_square(row_x));
                of_column = hn::Mul(of_column, power_of_minus_square(column_x));
                const V both = hn::Add(of_row, of_column);
                const V steep = hn::MulAdd(hn::Mul(row_x, row_scale), of_row,
                                           hn::Mul(hn::Mul(column_x, scale), of_column));
                // The switch: 1 - t^3 (10 - 15 t + 6 t^2), and minus its slope.
                const V t = hn::Max(hn::MulSub(distance, width, begin), hn::Zero(floats));
                const V t2 = hn::Mul(t, t), left = hn::NegMulAdd(t, t, t);
                const V p = hn::MulAdd(hn::MulAdd(t, all(6), all(-15)), t, all(10));
                const V S = hn::NegMulAdd(hn::Mul(t2, t), p, all(1));
                const V falls = hn::Mul(hn::Mul(left, left), slope);
                sums.energy = hn::NegMulAdd(hn::Mul(both, inverse_r2), S, sums.energy);
                // -(dE/dr)/r
                const V by_r = hn::MulAdd(both, inverse_r, hn::Mul(steep, all(std::numbers::ln2)));
                const V gradient = hn::Mul(hn::NegMulSub(by_r, S, hn::Mul(both, falls)),
                                           hn::Mul(inverse_r2, inverse_r));
                add_force(gradient, dx, fx, rows_.fx[r]);
                add_force(gradient, dy, fy, rows_.fy[r]);
                add_force(gradient, dz, fz, rows_.fz[r]);
            };
            if (lane_count >= cluster_size && !IsMasked && rows == 0xff) {
                HWY_UNROLL(8)
                for (std::uint32_t r = 0; r < cluster_size; ++r) add_row(r);
            } else {
                for (std::uint32_t left = rows; left != 0; left &= left - 1)
                    add_row(static_cast<std::uint32_t>(std::countr_zero(left)));
            }
            ClusterForces& on_a = forces_[first];
            ClusterForces& on_b = forces_[second];
            subtract_from_columns(fx, on_a.on[0], on_b.on[0], column);
            subtract_from_columns(fy, on_a.on[1], on_b.on[1], column);
            subtract_from_columns(fz, on_a.on[2], on_b.on[2], column);
        }
    }

    const ClusterList& list_;
    const SolvationCluster* atoms_;
    ClusterForces* forces_;
    V width_, begin_, slope_, farthest_;
    std::array<float, 3> centre_{};
    SolvationRows rows_;
    V nearest2_;
    W energy_;
};

SolvationJobSum sum_solvation(const SolvationJob& job) {
    return SolvationKernel(job).sum(job.first, job.last);
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {

HWY_EXPORT(sum_solvation);

SolvationJobSum run_solvation_job(const SolvationJob& job) {
    return HWY_DYNAMIC_DISPATCH(sum_solvation)(job);
}

}  // namespace palpa
#endif  // HWY_ONCE
