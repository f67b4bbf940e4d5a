#include "field/cholesky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

// From here on once for each kind of processor.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/cholesky.cpp"
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

// A tile of the matrix that stays in registers: three vectors of rows, and so many columns that
// all fit.
constexpr std::size_t tile_vectors = 3;
constexpr std::size_t tile_rows = tile_vectors * lane_count;
constexpr std::size_t tile_columns = HWY_MAX_BYTES == 64 ? 8 : 4;

using Block = std::array<CholeskyColumn, cholesky_block>;

// Takes from a block what `count` columns of the rows and of the columns' own rows make.
HWY_INLINE void subtract_products(const CholeskyColumn* rows, const CholeskyColumn* others,
                                  std::size_t count, Block& block) {
    for (std::size_t column = 0; column < cholesky_block; column += tile_columns) {
        for (std::size_t row = 0; row < cholesky_block; row += tile_rows) {
            V sums[tile_columns][tile_vectors];
            for (std::size_t c = 0; c < tile_columns; ++c) {
                for (std::size_t r = 0; r < tile_vectors; ++r) {
                    sums[c][r] =
                        hn::Load(doubles, block[column + c].at.data() + row + r * lane_count);
                }
            }
            for (std::size_t k = 0; k < count; ++k) {
                V of_rows[tile_vectors];
                for (std::size_t r = 0; r < tile_vectors; ++r)
                    of_rows[r] = hn::Load(doubles, rows[k].at.data() + row + r * lane_count);
                for (std::size_t c = 0; c < tile_columns; ++c) {
                    const V other = hn::Set(doubles, others[k].at[column + c]);
                    for (std::size_t r = 0; r < tile_vectors; ++r)
                        sums[c][r] = hn::NegMulAdd(of_rows[r], other, sums[c][r]);
                }
            }
            for (std::size_t c = 0; c < tile_columns; ++c) {
                for (std::size_t r = 0; r < tile_vectors; ++r) {
                    hn::Store(sums[c][r], doubles,
                              block[column + c].at.data() + row + r * lane_count);
                }
            }
        }
    }
}

// Of X L^T = block, with L the factor of the diagonal's block: X, in its place.
HWY_INLINE void divide(const CholeskyColumn* diagonal, CholeskyColumn* block) {
    for (std::size_t row = 0; row < cholesky_block; row += lane_count) {
        for (std::size_t c = 0; c < cholesky_block; ++c) {
            V sum = hn::Load(doubles, block[c].at.data() + row);
            for (std::size_t k = 0; k < c; ++k) {
                sum = hn::NegMulAdd(hn::Load(doubles, block[k].at.data() + row),
                                    hn::Set(doubles, diagonal[k].at[c]), sum);
            }
            hn::Store(hn::Div(sum, hn::Set(doubles, diagonal[c].at[c])), doubles,
                      block[c].at.data() + row);
        }
    }
}

void subtract_and_divide(const CholeskyFactor& factor, std::size_t row_block,
                         std::size_t column_block, Block& block) {
    const CholeskyColumn* const rows = factor.columns.data() + factor.first[row_block];
    const CholeskyColumn* const others = factor.columns.data() + factor.first[column_block];
    const std::size_t before = column_block * cholesky_block;
    subtract_products(rows, others, before, block);
    if (row_block != column_block) divide(others + before, block.data());
}

// x of one block of rows goes from what stands before it.
void subtract_rows(const CholeskyColumn* columns, std::size_t count, const CholeskyColumn& x,
                   double* before) {
    for (std::size_t k = 0; k < count; ++k) {
        V sum = hn::Zero(doubles);
        for (std::size_t row = 0; row < cholesky_block; row += lane_count) {
            sum = hn::MulAdd(hn::Load(doubles, columns[k].at.data() + row),
                             hn::Load(doubles, x.at.data() + row), sum);
        }
        before[k] -= hn::GetLane(hn::SumOfLanes(doubles, sum));
    }
}

// What stands before a block of rows goes from it.
void subtract_columns(const CholeskyColumn* columns, std::size_t count, const double* before,
                      CholeskyColumn& x) {
    for (std::size_t row = 0; row < cholesky_block; row += lane_count) {
        // Several sums at a time: one would wait for itself.
        V sums[4] = {hn::Load(doubles, x.at.data() + row), hn::Zero(doubles), hn::Zero(doubles),
                     hn::Zero(doubles)};
        for (std::size_t k = 0; k < count; ++k) {
            V& sum = sums[k % 4];
            sum = hn::NegMulAdd(hn::Load(doubles, columns[k].at.data() + row),
                                hn::Set(doubles, before[k]), sum);
        }
        hn::Store(hn::Add(hn::Add(sums[0], sums[1]), hn::Add(sums[2], sums[3])), doubles,
                  x.at.data() + row);
    }
}

}  // namespace
}  // namespace palpa::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpa {

HWY_EXPORT(subtract_and_divide);
HWY_EXPORT(subtract_rows);
HWY_EXPORT(subtract_columns);

namespace {

using Block = std::array<CholeskyColumn, cholesky_block>;

void prepare(std::size_t size, CholeskyFactor& factor) {
    if (factor.size == size && !factor.first.empty()) return;
    factor.size = size;
    factor.first.assign(1, 0);
    for (std::size_t b = 0; b * cholesky_block < size; ++b)
        factor.first.push_back(factor.first.back() + (b + 1) * cholesky_block);
    factor.columns.assign(factor.first.back(), {});
}

// Of the lower triangle, continued by the unit matrix.
void load_block(const Eigen::Ref<const Eigen::MatrixXd>& matrix, std::size_t row_block,
                std::size_t column_block, Block& block) {
    const auto size = static_cast<std::size_t>(matrix.cols());
    const std::size_t row = row_block * cholesky_block, column = column_block * cholesky_block;
    const std::size_t rows = std::min(cholesky_block, size - row);
    for (std::size_t c = 0; c < cholesky_block; ++c) {
        block[c] = {};
        if (column + c >= size) {
            block[c].at[c] = 1;
            continue;
        }
        const double* const from =
            matrix.data() + static_cast<Eigen::Index>(column + c) * matrix.outerStride() + row;
        std::copy_n(from, rows, block[c].at.begin());
    }
}

// The diagonal's block, which others are already taken from, by its own factor.
std::optional<CholeskyFailure> factor_diagonal(const Block& original, double least, Block& block) {
    for (std::size_t c = 0; c < cholesky_block; ++c) {
        for (std::size_t k = 0; k < c; ++k) {
            for (std::size_t r = c; r < cholesky_block; ++r)
                block[c].at[r] -= block[k].at[r] * block[k].at[c];
        }
        const double value = block[c].at[c];
        std::fill_n(block[c].at.begin(), c, 0.0);
        if (!(value > least * std::abs(original[c].at[c])) || !std::isfinite(value))
            return CholeskyFailure{c, value};
        const double root = std::sqrt(value);
        for (std::size_t r = c; r < cholesky_block; ++r) block[c].at[r] /= root;
    }
    return std::nullopt;
}

CholeskyColumn load_rows(const double* x, std::size_t rows) {
    CholeskyColumn result;
    std::copy_n(x, rows, result.at.begin());
    return result;
}

// L^T x = b in place, of the first `size` rows.
void solve_transposed(const CholeskyFactor& factor, std::size_t size, double* x) {
    constexpr std::size_t n = cholesky_block;
    for (std::size_t b = (size + n - 1) / n; b-- > 0;) {
        const CholeskyColumn* const columns = factor.columns.data() + factor.first[b];
        const CholeskyColumn* const own = columns + b * n;
        const std::size_t rows = std::min(n, size - b * n);
        CholeskyColumn y = load_rows(x + b * n, rows);
        for (std::size_t c = rows; c-- > 0;) {
            for (std::size_t r = c + 1; r < rows; ++r) y.at[c] -= own[c].at[r] * y.at[r];
            y.at[c] /= own[c].at[c];
        }
        std::copy_n(y.at.begin(), rows, x + b * n);
        HWY_DYNAMIC_DISPATCH(subtract_rows)(columns, b * n, y, x);
    }
}

void solve_one(const CholeskyFactor& factor, double* x) {
    constexpr std::size_t n = cholesky_block;
    for (std::size_t b = 0; b < factor.blocks(); ++b) {
        const CholeskyColumn* const columns = factor.columns.data() + factor.first[b];
        const CholeskyColumn* const own = columns + b * n;
        const std::size_t rows = std::min(n, factor.size - b * n);
        CholeskyColumn y = load_rows(x + b * n, rows);
        HWY_DYNAMIC_DISPATCH(subtract_columns)(columns, b * n, x, y);
        for (std::size_t c = 0; c < rows; ++c) {
            y.at[c] /= own[c].at[c];
            for (std::size_t r = c + 1; r < rows; ++r) y.at[r] -= own[c].at[r] * y.at[c];
        }
        std::copy_n(y.at.begin(), rows, x + b * n);
    }
    solve_transposed(factor, factor.size, x);
}

}  // namespace

std::optional<CholeskyFailure> update_cholesky(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                                               double least, CholeskyFactor& factor) {
    prepare(static_cast<std::size_t>(matrix.cols()), factor);
    Block block;
    const auto put = [&](std::size_t row_block, std::size_t column_block) {
        std::ranges::copy(block, factor.columns.begin() +
                                     static_cast<std::ptrdiff_t>(factor.first[row_block] +
                                                                 column_block * cholesky_block));
    };
    for (std::size_t c = 0; c < factor.blocks(); ++c) {
        load_block(matrix, c, c, block);
        const Block original = block;
        HWY_DYNAMIC_DISPATCH(subtract_and_divide)(factor, c, c, block);
        std::optional<CholeskyFailure> failure = factor_diagonal(original, least, block);
        put(c, c);
        if (failure) {
            failure->pivot += c * cholesky_block;
            return failure;
        }
        for (std::size_t r = c + 1; r < factor.blocks(); ++r) {
            load_block(matrix, r, c, block);
            HWY_DYNAMIC_DISPATCH(subtract_and_divide)(factor, r, c, block);
            put(r, c);
        }
    }
    return std::nullopt;
}

void solve_cholesky(const CholeskyFactor& factor, Eigen::Ref<Eigen::MatrixXd> b) {
    for (Eigen::Index column = 0; column < b.cols(); ++column)
        solve_one(factor, b.col(column).data());
}

Eigen::VectorXd find_direction(const CholeskyFactor& factor, const CholeskyFailure& failure) {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(factor.size));
    // L^T x = -(the pivot's row of L).
    for (std::size_t k = 0; k < failure.pivot; ++k)
        direction[static_cast<Eigen::Index>(k)] = -factor.at(failure.pivot, k);
    solve_transposed(factor, failure.pivot, direction.data());
    direction[static_cast<Eigen::Index>(failure.pivot)] = 1;
    return direction;
}

}  // namespace palpa
#endif  // HWY_ONCE
