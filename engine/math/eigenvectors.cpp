#include "math/eigenvectors.h"

#include <Eigen/Eigenvalues>

namespace palpa {
namespace {

template <int Size, class Matrix>
Eigenvectors<Size> decompose(const Matrix& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(symmetric);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace

Eigenvectors<3> find_eigenvectors(const Mat3& symmetric) noexcept {
    return decompose<3>(symmetric);
}

Eigenvectors<6> find_eigenvectors(const Mat6& symmetric) noexcept {
    return decompose<6>(symmetric);
}

Eigenvectors<Eigen::Dynamic> find_eigenvectors(const Eigen::MatrixXd& symmetric) {
    return decompose<Eigen::Dynamic>(symmetric);
}

Vec3 find_eigenvalues(const Mat3& symmetric) noexcept {
    return Eigen::SelfAdjointEigenSolver<Mat3>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

Quat turn_between(const Vec3& from, const Vec3& to) noexcept {
    return Quat::FromTwoVectors(from, to);
}

}  // namespace palpa
