// Decompositions that Eigen's templates take long to compile, in one place.
#pragma once
#include "math/spatial.h"
#include "math/vec.h"

namespace palpa {

// Eigenvalues of a symmetric matrix, rising, and its orthonormal eigenvectors as columns.
template <int Size>
struct Eigenvectors {
    Eigen::Matrix<double, Size, 1> values;
    Eigen::Matrix<double, Size, Size> vectors;
};

Eigenvectors<3> find_eigenvectors(const Mat3& symmetric) noexcept;
Eigenvectors<6> find_eigenvectors(const Mat6& symmetric) noexcept;
Eigenvectors<Eigen::Dynamic> find_eigenvectors(const Eigen::MatrixXd& symmetric);
Vec3 find_eigenvalues(const Mat3& symmetric) noexcept;

// The shortest rotation that takes one direction to another.
Quat turn_between(const Vec3& from, const Vec3& to) noexcept;

}  // namespace palpa
