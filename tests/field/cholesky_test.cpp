#include "field/cholesky.h"

#include "field/processor.h"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cstdint>
#include <random>
#include <string>

using namespace palpa;

namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::MatrixXd result(rows, columns);
    for (double& value : result.reshaped()) value = uniform(random);
    return result;
}

// Positive definite, with eigenvalues of 1e-4 to some hundred.
Eigen::MatrixXd stiffness(Eigen::Index size, std::uint32_t seed) {
    const Eigen::MatrixXd a = random_matrix(size, size, seed);
    return a * a.transpose() + 1e-4 * Eigen::MatrixXd::Identity(size, size);
}

}  // namespace

TEST_CASE("a Cholesky factor solves, whatever the size", "[field][cholesky]") {
    for (const std::string& kind : list_processor_kinds()) {
        use_processor_kind(kind);
        CholeskyFactor factor;
        for (const Eigen::Index size : {1, 2, 23, 24, 25, 48, 100, 131}) {
            INFO(kind << ", size " << size);
            const Eigen::MatrixXd matrix = stiffness(size, 3);
            const Eigen::MatrixXd b = random_matrix(size, 3, 5);

            CHECK(!update_cholesky(matrix, 1e-12, factor));
            Eigen::MatrixXd x = b;
            solve_cholesky(factor, x);

            const Eigen::MatrixXd L = matrix.llt().matrixL();
            double worst = 0;
            for (Eigen::Index r = 0; r < size; ++r) {
                for (Eigen::Index c = 0; c <= r; ++c) {
                    const double own =
                        factor.at(static_cast<std::size_t>(r), static_cast<std::size_t>(c));
                    worst = std::max(worst, std::abs(own - L(r, c)));
                }
            }
            CHECK(worst < 1e-9);
            CHECK((matrix * x - b).norm() < 1e-12 * matrix.norm() * x.norm());
        }
    }
    use_processor_kind(list_processor_kinds().front());
}

TEST_CASE("where there is no Cholesky factor a direction of negative curvature says why",
          "[field][cholesky]") {
    for (const Eigen::Index at : {0, 5, 30, 99}) {
        INFO("at " << at);
        Eigen::MatrixXd matrix = stiffness(100, 9);
        matrix(at, at) -= 200;
        CholeskyFactor factor;

        const auto failure = update_cholesky(matrix, 1e-12, factor);

        REQUIRE(failure);
        CHECK(failure->pivot == static_cast<std::size_t>(at));
        const Eigen::VectorXd direction = find_direction(factor, *failure);
        CHECK(direction[at] == 1);
        CHECK(failure->value < 0);
        CHECK(direction.dot(matrix * direction) == Approx(failure->value).epsilon(1e-6));
        CHECK(!update_cholesky(stiffness(100, 9), 1e-12, factor));
    }
}

TEST_CASE("a singular matrix has no Cholesky factor", "[field][cholesky]") {
    const Eigen::MatrixXd a = random_matrix(40, 39, 2);
    CholeskyFactor factor;

    CHECK(update_cholesky(a * a.transpose(), 1e-12, factor));
    CHECK(update_cholesky(Eigen::MatrixXd::Zero(3, 3), 1e-12, factor)->pivot == 0);
    CHECK(!update_cholesky(Eigen::MatrixXd(0, 0), 1e-12, factor));
}
