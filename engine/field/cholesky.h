// Cholesky's factor of a symmetric matrix, in double, as fast as the processor at hand can, and
// where a matrix has none, a direction that says why.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// Rows of the factor that stand beside each other.
inline constexpr std::size_t cholesky_block = 24;

struct alignas(64) CholeskyColumn {
    std::array<double, cholesky_block> at{};
};

// L with L L^T = A. Of block b of rows: columns [first[b], first[b + 1]) of `columns`, one per
// column of L up to the last of the block's own; what is above the diagonal is zero. Rows beyond
// the size are those of the unit matrix.
struct CholeskyFactor {
    std::size_t size = 0;
    std::vector<std::size_t> first;
    std::vector<CholeskyColumn> columns;

    std::size_t blocks() const noexcept { return first.empty() ? 0 : first.size() - 1; }
    double at(std::size_t row, std::size_t column) const noexcept {
        return columns[first[row / cholesky_block] + column].at[row % cholesky_block];
    }
};

// Where a matrix is not positive definite: its first `pivot` rows and columns are, with one more
// they are not. The reduced diagonal element there is `value`: the curvature along the coordinate
// where those before it relax.
struct CholeskyFailure {
    std::size_t pivot = 0;
    double value = 0;
};

// Of the lower triangle of `matrix`. A pivot that is not above `least` times what stood there is
// rounding: no factor. After a failure the factor holds the first `pivot` rows. Takes n^3/6 fused
// multiply-adds; the memory of the factor is used again.
std::optional<CholeskyFailure> update_cholesky(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                                               double least, CholeskyFactor& factor);

// Solves A x = b in place, for each column of b. Single ones take n^2 multiply-adds.
void solve_cholesky(const CholeskyFactor& factor, Eigen::Ref<Eigen::MatrixXd> b);

// The direction of a failure: 1 along the coordinate of the pivot, those before yield, 0 along
// those after. d^T A d is the failure's value.
Eigen::VectorXd find_direction(const CholeskyFactor& factor, const CholeskyFailure& failure);

}  // namespace palpa
