#include "field/pair_job.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

// Of a lambda that runs in the innermost loop; other compilers know no such word there.
#undef PALPA_INLINED
#ifdef __GNUC__
#define PALPA_INLINED __attribute__((always_inline))
#else
#define PALPA_INLINED
#endif

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/pair_job.cpp"
#include <hwy/foreach_target.h>  // before highway.h

#include "field/cluster_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace palpa::HWY_NAMESPACE {
namespace {

// A pair's force is (a/r^2 + b) d with d the vector between the atoms; energies are added up.
struct Terms {
    V a, b, van_der_waals, electrostatic;
};

// S, with y = (r^2 - m^2)/(c^2 - m^2), not below 0:  S = 1 - y^2 (3 - 2y)
struct Switching {
    explicit HWY_INLINE Switching(const PairScheme& scheme) {
        const double c2 = scheme.cutoff * scheme.cutoff;
        const double m2 = scheme.switch_from * scheme.switch_from;
        scale = all(1 / (c2 - m2));
        offset = all(-m2 / (c2 - m2));
    }
    HWY_INLINE V place(V r2) const {
        return hn::Max(hn::MulAdd(r2, scale, offset), hn::Zero(floats));
    }
    HWY_INLINE V value(V y) const {
        return hn::NegMulAdd(hn::Mul(y, y), hn::NegMulAdd(y, all(2), all(3)), all(1));
    }

    V scale, offset;
};

// The same with a continuous second derivative, and its slope:
//   S = 1 - y^3 (10 - 15 y + 6 y^2),  S'/r = -60 y^2 (1 - y)^2/(c^2 - m^2)
struct SmoothSwitching : Switching {
    explicit HWY_INLINE SmoothSwitching(const PairScheme& scheme) : Switching(scheme) {
        const double c2 = scheme.cutoff * scheme.cutoff;
        slope_scale =
            hn::Mul(all(-12 / (c2 - scheme.switch_from * scheme.switch_from)), all(-5.0 / 12));
    }
    // 1 from c on, where neither is anything.
    HWY_INLINE V place(V r2) const { return hn::Min(Switching::place(r2), all(1)); }
    HWY_INLINE V value(V y) const {
        const V p = hn::MulAdd(hn::MulAdd(y, all(6), all(-15)), y, all(10));
        return hn::NegMulAdd(hn::Mul(hn::Mul(y, y), y), p, all(1));
    }
    // Of `energy`, 12 times too large, what its slope takes: -energy/12 S'/r.
    HWY_INLINE V taken(V energy, V y) const {
        const V both = hn::NegMulAdd(y, y, y);
        return hn::Mul(hn::Mul(slope_scale, energy), hn::Mul(both, both));
    }

    V slope_scale;
};

// The forms of forces/pair_law.h, put so that no two large numbers cancel in single precision.
template <ElectrostaticCutoff End, bool DistanceDielectric>
class Electrostatics {
public:
    // Whether pairs have to be cut off at c: CubicShift is nothing from there on by itself.
    static constexpr bool ends =
        End != ElectrostaticCutoff::None && End != ElectrostaticCutoff::CubicShift;
    static constexpr bool takes_root = !DistanceDielectric;

    explicit HWY_INLINE Electrostatics(const PairScheme& scheme) : switching_(scheme) {
        const double c = scheme.cutoff, m = scheme.switch_from, width = c * c - m * m;
        inverse_c2_ = all(1 / (c * c));
        inverse_c2_4_ = all(4 / (c * c));
        if constexpr (End == ElectrostaticCutoff::ForceSwitch) {
            // The energy before m is U moved by C0; after it, by x = r - m > 0,
            //   C0 + 1/r + integral over (1 - S)/r^2 = C0 + 1/r + x^3 p(x)/r
            const double width3 = width * width * width;
            m_ = all(m);
            p0_ = all(4 * m * width / width3);
            p1_ = all((width - 4 * m * m) / width3);
            p2_ = all(-2.4 * m / width3);
            p3_ = all(-0.4 / width3);
            const double x = c - m;
            shift_ = all(
                -(1 + x * x * x / width3 *
                          (4 * m * width + x * (width - 4 * m * m + x * (-2.4 * m - 0.4 * x)))) /
                c);
        }
    }

    template <bool WithEnergy>
    HWY_INLINE void add(V r2, V inverse_r, V inverse_r2, V charges, Terms& terms) const {
        const V unit = DistanceDielectric ? inverse_r2 : inverse_r;
        const V u = hn::Mul(charges, unit);
        if constexpr (End == ElectrostaticCutoff::None) {
            terms.a = hn::MulAdd(steepness(charges), unit, terms.a);
            if constexpr (WithEnergy)
                terms.electrostatic = hn::MulAdd(charges, unit, terms.electrostatic);
        } else if constexpr (End == ElectrostaticCutoff::CubicShift) {
            // For U = q/r^n and left = 1 - (r/c)^2: -r (U left^3)' = U left^2 (n + (6 - n) (r/c)^2)
            const V left = hn::Max(hn::NegMulAdd(r2, inverse_c2_, all(1)), hn::Zero(floats));
            const V twice = hn::Mul(hn::Mul(u, left), left);
            terms.a =
                DistanceDielectric ? hn::MulAdd(twice, all(2), terms.a) : hn::Add(terms.a, twice);
            terms.b =
                hn::MulAdd(twice, DistanceDielectric ? inverse_c2_4_ : inverse_c2_5(), terms.b);
            if constexpr (WithEnergy)
                terms.electrostatic = hn::MulAdd(twice, left, terms.electrostatic);
        } else {
            terms.a = hn::MulAdd(u, switching_.value(switching_.place(r2)), terms.a);
            if constexpr (WithEnergy) {
                terms.electrostatic =
                    hn::Add(terms.electrostatic,
                            hn::MulAdd(u, after_m(r2, inverse_r), hn::Mul(charges, shift_)));
            }
        }
    }

private:
    // -r U'/U.
    static HWY_INLINE V steepness(V u) { return DistanceDielectric ? hn::Add(u, u) : u; }

    HWY_INLINE V inverse_c2_5() const { return hn::Add(inverse_c2_4_, inverse_c2_); }

    // 1 + x^3 p(x)
    HWY_INLINE V after_m(V r2, V inverse_r) const {
        const V x = hn::Max(hn::MulSub(r2, inverse_r, m_), hn::Zero(floats));
        const V x3 = hn::Mul(hn::Mul(x, x), x);
        const V p = hn::MulAdd(hn::MulAdd(hn::MulAdd(p3_, x, p2_), x, p1_), x, p0_);
        return hn::MulAdd(x3, p, all(1));
    }

    Switching switching_;
    V inverse_c2_, inverse_c2_4_;
    V m_ = hn::Zero(floats), p0_ = m_, p1_ = m_, p2_ = m_, p3_ = m_, shift_ = m_;
};

// Of 12 times the depth of the well.
template <VanDerWaalsCutoff End>
class VanDerWaals {
public:
    // As of electrostatics; SmoothSwitch is nothing from c on.
    static constexpr bool ends =
        End != VanDerWaalsCutoff::None && End != VanDerWaalsCutoff::SmoothSwitch;

    // Whether 1/r is used, not only its square.
    static constexpr bool takes_root = End != VanDerWaalsCutoff::SmoothSwitch;

    explicit HWY_INLINE VanDerWaals(const PairScheme& scheme) : switching_(scheme) {
        const double c = scheme.cutoff, m = scheme.switch_from, c3 = c * c * c, m3 = m * m * m;
        k12_ = all(c3 * c3 / (c3 * c3 - m3 * m3));
        k12_end_ = all(1 / (c3 * c3 - m3 * m3));
        k6_ = all(c3 / (c3 - m3));
        k6_end_ = all(1 / (c3 - m3));
        inverse_c6_ = all(1 / (c3 * c3));
        inverse_c3_ = all(1 / c3);
        inverse_m6_ = all(1 / (m3 * m3));
        inverse_m3_ = all(1 / m3);
    }

    // Sets a and b.
    template <bool WithEnergy>
    HWY_INLINE void set(V r2, V inverse_r, V inverse_r2, V epsilon12, V rmin, Terms& terms) const {
        if constexpr (End == VanDerWaalsCutoff::ForceSwitch) {
            set_force_switched<WithEnergy>(inverse_r, inverse_r2, epsilon12, rmin, terms);
            return;
        }
        const V s = hn::Mul(rmin, inverse_r);
        const V s2 = takes_root ? hn::Mul(s, s) : hn::Mul(hn::Mul(rmin, rmin), inverse_r2);
        const V s6 = hn::Mul(hn::Mul(s2, s2), s2), well = hn::Mul(epsilon12, s6);
        terms.a = hn::MulSub(well, s6, well);
        terms.b = hn::Zero(floats);
        if constexpr (End == VanDerWaalsCutoff::SmoothSwitch) {
            const V y = switching_.place(r2), value = switching_.value(y);
            const V energy = hn::Mul(well, hn::Sub(s6, all(2)));
            terms.a = hn::Mul(terms.a, value);
            terms.b = switching_.taken(energy, y);
            if constexpr (WithEnergy)
                terms.van_der_waals = hn::MulAdd(energy, value, terms.van_der_waals);
        } else if constexpr (WithEnergy) {
            terms.van_der_waals = hn::MulAdd(well, hn::Sub(s6, all(2)), terms.van_der_waals);
        }
    }

private:
    // With u = r^-6 and v = r^-3: p = u before m and k12 (u - c^-6) after it, the smaller of the
    // two everywhere; q the same of v. The energy is A (p u - min(p, m^-6) c^-6) and so on.
    template <bool WithEnergy>
    HWY_INLINE void set_force_switched(V inverse_r, V inverse_r2, V epsilon12, V rmin,
                                       Terms& terms) const {
        const V v = hn::Mul(inverse_r2, inverse_r), u = hn::Mul(v, v);
        const V rmin2 = hn::Mul(rmin, rmin), rmin6 = hn::Mul(hn::Mul(rmin2, rmin2), rmin2);
        const V p = hn::Min(u, hn::MulSub(k12_, u, k12_end_));
        const V q = hn::Min(v, hn::MulSub(k6_, v, k6_end_));
        const V pu = hn::Mul(p, u), qv = hn::Mul(q, v), well = hn::Mul(epsilon12, rmin6);
        terms.a = hn::Mul(well, hn::MulSub(rmin6, pu, qv));
        terms.b = hn::Zero(floats);
        if constexpr (WithEnergy) {
            const V repulsion = hn::NegMulAdd(hn::Min(p, inverse_m6_), inverse_c6_, pu);
            const V attraction = hn::NegMulAdd(hn::Min(q, inverse_m3_), inverse_c3_, qv);
            terms.van_der_waals =
                hn::MulAdd(well, hn::MulSub(rmin6, repulsion, hn::Add(attraction, attraction)),
                           terms.van_der_waals);
        }
    }

    std::conditional_t<End == VanDerWaalsCutoff::SmoothSwitch, SmoothSwitching, Switching>
        switching_;
    V k12_, k12_end_, k6_, k6_end_, inverse_c6_, inverse_c3_, inverse_m6_, inverse_m3_;
};

// The atoms of one cluster, which a row of pairs each is about.
struct Rows {
    alignas(64) float x[cluster_size], y[cluster_size], z[cluster_size];  // Å, from the centre
    alignas(64) float charge[cluster_size];     // times the Coulomb constant
    alignas(64) float epsilon12[cluster_size];  // 12 sqrt(epsilon)
    alignas(64) float half_rmin[cluster_size];
    // The forces on them, of some hundred columns, side by side.
    alignas(64) float fx[cluster_size][lane_count], fy[cluster_size][lane_count],
        fz[cluster_size][lane_count];
};

template <class Electrostatics, class VanDerWaals, bool WithEnergy>
class Kernel {
public:
    explicit HWY_INLINE Kernel(const PairJob& job)
        : list_(*job.list),
          atoms_(job.atoms),
          forces_(job.forces),
          coulomb_(static_cast<float>(job.scheme->coulomb)),
          electrostatics_(*job.scheme),
          van_der_waals_(*job.scheme),
          cutoff2_(all(job.scheme->cutoff * job.scheme->cutoff)),
          nearest2_(all(std::numeric_limits<float>::infinity())),
          lj_sum_(hn::Zero(doubles)),
          coulomb_sum_(lj_sum_) {}

    JobSum sum(std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) sum_cluster(c);
        return {sum_of(lj_sum_) / 12, sum_of(coulomb_sum_),
                hn::GetLane(hn::MinOfLanes(floats, nearest2_))};
    }

private:
    static constexpr std::size_t step = lane_count > cluster_size ? 2 : 1;
    // Tiles between two sums of energies in double, which are of eight rows each; and how many such
    // stretches between two of the forces on a row.
    static constexpr std::size_t most_tiles = 16 * step;
    static constexpr std::size_t most_stretches = 8;

    // Of a few hundred pairs; kept in registers.
    struct Sums {
        V nearest2, van_der_waals, electrostatic;
    };

    HWY_INLINE void sum_cluster(std::size_t c) {
        load_rows(c);
        // Copies: stores to memory cannot change them.
        const Electrostatics electrostatics = electrostatics_;
        const VanDerWaals van_der_waals = van_der_waals_;
        Sums sums{nearest2_, hn::Zero(floats), hn::Zero(floats)};
        std::size_t stretches = 0;
        // What follows a tile without rows or pairs has none either.
        const std::size_t plain_end = list_.first_plain[c + 1];
        for (std::size_t t = list_.first_plain[c]; t < plain_end && list_.plain[t].rows != 0;) {
            const std::size_t end = std::min(t + most_tiles, plain_end);
            for (; t < end && list_.plain[t].rows != 0; t += step) {
                const ClusterTile& first = list_.plain[t];
                const ClusterTile& second = list_.plain[t + step - 1];
                sum_tile<false>(electrostatics, van_der_waals, sums, first.cluster, second.cluster,
                                first.rows | second.rows, 0, 0);
            }
            flush_energies(sums);
            if (++stretches % most_stretches == 0) flush_rows(c);
        }
        const std::size_t masked_end = list_.first_masked[c + 1];
        for (std::size_t t = list_.first_masked[c]; t < masked_end && list_.masked[t].pairs != 0;) {
            const std::size_t end = std::min(t + most_tiles, masked_end);
            for (; t < end && list_.masked[t].pairs != 0; t += step) {
                const MaskedTile& first = list_.masked[t];
                const MaskedTile& second = list_.masked[t + step - 1];
                sum_tile<true>(electrostatics, van_der_waals, sums, first.cluster, second.cluster,
                               rows_of(first.pairs | second.pairs), first.pairs, second.pairs);
            }
            flush_energies(sums);
            if (++stretches % most_stretches == 0) flush_rows(c);
        }
        flush_rows(c);
        nearest2_ = sums.nearest2;
    }

    HWY_INLINE void load_rows(std::size_t c) {
        const ClusterAtoms& atoms = atoms_[c];
        for (std::size_t k = 0; k < 3; ++k) centre_[k] = atoms.high[k][0];
        for (std::size_t r = 0; r < cluster_size; ++r) {
            rows_.x[r] = (atoms.high[0][r] - centre_[0]) + atoms.low[0][r];
            rows_.y[r] = (atoms.high[1][r] - centre_[1]) + atoms.low[1][r];
            rows_.z[r] = (atoms.high[2][r] - centre_[2]) + atoms.low[2][r];
            rows_.charge[r] = coulomb_ * atoms.charge[r];
            rows_.epsilon12[r] = 12 * atoms.sqrt_epsilon[r];
            rows_.half_rmin[r] = atoms.half_rmin[r];
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

    HWY_INLINE void flush_energies(Sums& sums) {
        if constexpr (WithEnergy) {
            lj_sum_ = hn::Add(
                lj_sum_, hn::Add(lower_half(sums.van_der_waals), upper_half(sums.van_der_waals)));
            coulomb_sum_ = hn::Add(coulomb_sum_, hn::Add(lower_half(sums.electrostatic),
                                                         upper_half(sums.electrostatic)));
            sums.van_der_waals = hn::Zero(floats);
            sums.electrostatic = hn::Zero(floats);
        }
    }

    template <bool IsMasked>
    HWY_INLINE void sum_tile(const Electrostatics& electrostatics, const VanDerWaals& van_der_waals,
                             Sums& sums, std::uint32_t first, std::uint32_t second,
                             std::uint32_t rows, std::uint64_t first_pairs,
                             std::uint64_t second_pairs) {
        const ClusterAtoms& a = atoms_[first];
        const ClusterAtoms& b = atoms_[second];
        HWY_UNROLL(1)
        for (std::size_t column = 0; column < cluster_size; column += lane_count) {
            const auto place = [&](std::size_t k) HWY_ATTR {
                return hn::Add(hn::Sub(load_columns(a.high[k], b.high[k], column),
                                       hn::Set(floats, centre_[k])),
                               load_columns(a.low[k], b.low[k], column));
            };
            const V x = place(0), y = place(1), z = place(2);
            const V charge = load_columns(a.charge, b.charge, column);
            const V sqrt_epsilon = load_columns(a.sqrt_epsilon, b.sqrt_epsilon, column);
            const V half_rmin = load_columns(a.half_rmin, b.half_rmin, column);
            V fx = hn::Zero(floats), fy = fx, fz = fx;
            const auto add_row = [&](std::uint32_t r) HWY_ATTR PALPA_INLINED {
                const V dx = hn::Sub(hn::Set(floats, rows_.x[r]), x);
                const V dy = hn::Sub(hn::Set(floats, rows_.y[r]), y);
                const V dz = hn::Sub(hn::Set(floats, rows_.z[r]), z);
                const V distance2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
                V charges = hn::Mul(hn::Set(floats, rows_.charge[r]), charge);
                V epsilon12 = hn::Mul(hn::Set(floats, rows_.epsilon12[r]), sqrt_epsilon);
                const V rmin = hn::Add(hn::Set(floats, rows_.half_rmin[r]), half_rmin);
                V counted2 = distance2;
                M counts = hn::Lt(distance2, cutoff2_);
                if constexpr (IsMasked) {
                    const M pairs = load_mask(first_pairs, second_pairs, r, column);
                    counted2 = hn::IfThenElse(pairs, distance2, all(1e30));
                    counts = hn::And(counts, pairs);
                    if constexpr (!electrostatics_end) charges = hn::IfThenElseZero(pairs, charges);
                    if constexpr (!van_der_waals_ends)
                        epsilon12 = hn::IfThenElseZero(pairs, epsilon12);
                }
                if constexpr (electrostatics_end) charges = hn::IfThenElseZero(counts, charges);
                if constexpr (van_der_waals_ends) epsilon12 = hn::IfThenElseZero(counts, epsilon12);
                sums.nearest2 = hn::Min(sums.nearest2, counted2);
                // A pair that does not count may be at one place.
                const V r2 = IsMasked ? hn::Max(distance2, all(1e-2)) : distance2;
                V inverse_r = hn::Zero(floats), inverse_r2;
                if constexpr (Electrostatics::takes_root || VanDerWaals::takes_root) {
                    inverse_r = inverse_root(r2);
                    inverse_r2 = hn::Mul(inverse_r, inverse_r);
                } else {
                    inverse_r2 = inverse(r2);
                }
                Terms terms{hn::Zero(floats), hn::Zero(floats), sums.van_der_waals,
                            sums.electrostatic};
                van_der_waals.template set<WithEnergy>(r2, inverse_r, inverse_r2, epsilon12, rmin,
                                                       terms);
                electrostatics.template add<WithEnergy>(r2, inverse_r, inverse_r2, charges, terms);
                sums.van_der_waals = terms.van_der_waals;
                sums.electrostatic = terms.electrostatic;
                const V gradient = hn::MulAdd(terms.a, inverse_r2, terms.b);
                add_force(gradient, dx, fx, rows_.fx[r]);
                add_force(gradient, dy, fy, rows_.fy[r]);
                add_force(gradient, dz, fz, rows_.fz[r]);
            };
            if (lane_count >= cluster_size && !IsMasked && rows == 0xff) {
                // Most tiles: without looking for the next row. Narrow vectors gain little by it
                // and take minutes to compile.
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

    static constexpr bool electrostatics_end = Electrostatics::ends;
    static constexpr bool van_der_waals_ends = VanDerWaals::ends;

    const ClusterList& list_;
    const ClusterAtoms* atoms_;
    ClusterForces* forces_;
    float coulomb_;
    Electrostatics electrostatics_;
    VanDerWaals van_der_waals_;
    V cutoff2_;
    std::array<float, 3> centre_{};
    Rows rows_;
    V nearest2_;
    W lj_sum_, coulomb_sum_;  // the first times 12
};

template <class Electrostatics, class VanDerWaals>
JobSum sum_with_laws(const PairJob& job) {
    if (job.with_energies)
        return Kernel<Electrostatics, VanDerWaals, true>(job).sum(job.begin, job.end);
    return Kernel<Electrostatics, VanDerWaals, false>(job).sum(job.begin, job.end);
}

// The two ends that are smooth to the second derivative go together.
JobSum sum_smooth_ends(const PairJob& job) {
    using enum ElectrostaticCutoff;
    using SmoothVanDerWaals = VanDerWaals<VanDerWaalsCutoff::SmoothSwitch>;
    if (job.scheme->distance_dielectric)
        return sum_with_laws<Electrostatics<CubicShift, true>, SmoothVanDerWaals>(job);
    return sum_with_laws<Electrostatics<CubicShift, false>, SmoothVanDerWaals>(job);
}

JobSum sum_job(const PairJob& job) {
    using enum ElectrostaticCutoff;
    if (job.scheme->electrostatics == CubicShift) return sum_smooth_ends(job);
    if (job.scheme->electrostatics == ForceSwitch) {
        return sum_with_laws<Electrostatics<ForceSwitch, false>,
                             VanDerWaals<VanDerWaalsCutoff::ForceSwitch>>(job);
    }
    using Whole = VanDerWaals<VanDerWaalsCutoff::None>;
    // A rare one has no code of its own for forces alone.
    if (job.scheme->distance_dielectric)
        return Kernel<Electrostatics<None, true>, Whole, true>(job).sum(job.begin, job.end);
    return sum_with_laws<Electrostatics<None, false>, Whole>(job);
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {

HWY_EXPORT(sum_job);

JobSum run_pair_job(const PairJob& job) { return HWY_DYNAMIC_DISPATCH(sum_job)(job); }

}  // namespace palpa
#endif  // HWY_ONCE
