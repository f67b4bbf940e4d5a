#include "math/curvature_memory.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

constexpr Eigen::Index size = 12;

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

Vector random_vector(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Vector result(size);
    for (double& value : result) value = uniform(random);
    return result;
}

// A bowl: symmetric, all eigenvalues above 0.
Matrix random_curvature(std::mt19937& random) {
    Matrix half(size, size);
    for (Eigen::Index i = 0; i < size; ++i) half.col(i) = random_vector(random);
    return half * half.transpose() + 0.1 * Matrix::Identity(size, size);
}

}  // namespace

TEST_CASE("the two loops are BFGS's formula for the last eight steps", "[math]") {
    std::mt19937 random(1);
    const Matrix curvature = random_curvature(random);
    const Matrix compliance = random_curvature(random);
    const Vector forces = random_vector(random);
    const std::size_t count =
        GENERATE(std::size_t{1}, std::size_t{3}, std::size_t{8}, std::size_t{11});
    CurvatureMemory memory;
    std::vector<std::pair<Vector, Vector>> steps;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector s = random_vector(random);
        const Vector y = curvature * s;
        memory.add(s, y);
        steps.emplace_back(s, y);
    }
    if (steps.size() > 8) steps.erase(steps.begin(), steps.end() - 8);

    // H <- (1 - r s y^T) H (1 - r y s^T) + r s s^T, r = 1/(s·y), from a multiple of the compliance
    const auto& [s_last, y_last] = steps.back();
    Matrix H = compliance * (s_last.dot(y_last) / y_last.dot(compliance * y_last));
    for (const auto& [s, y] : steps) {
        const double r = 1 / s.dot(y);
        const Matrix left = Matrix::Identity(size, size) - r * s * y.transpose();
        H = (left * H * left.transpose() + r * s * s.transpose()).eval();
    }
    const auto yields = [&](const Vector& f) -> Vector { return compliance * f; };
    const Vector direction = memory.find_direction(forces, yields);

    CHECK_FALSE(memory.is_empty());
    CHECK((direction - H * forces).norm() < 1e-9 * direction.norm());
    // The last step is met whatever is thought of the rest.
    CHECK((memory.find_direction(y_last, yields) - s_last).norm() < 1e-10 * s_last.norm());
    CHECK(direction.dot(forces) > 0);
}

TEST_CASE("steps that bend down only make the next one bolder", "[math]") {
    std::mt19937 random(2);
    const Vector forces = random_vector(random), s = random_vector(random);
    const auto yields = [](const Vector& f) -> Vector { return 3 * f; };
    CurvatureMemory memory;

    CHECK(memory.is_empty());
    CHECK((memory.find_direction(forces, yields) - 3 * forces).norm() < 1e-15);
    memory.add(s, -s);
    memory.add(s, Vector::Zero(size));
    CHECK(memory.is_empty());
    CHECK((memory.find_direction(forces, yields) - 12 * forces).norm() < 1e-14);

    memory.add(s, 2 * s);
    CHECK_FALSE(memory.is_empty());
    CHECK((memory.find_direction(forces, yields) - 0.5 * forces).norm() < 1e-14);
    memory.clear();
    CHECK(memory.is_empty());
    CHECK((memory.find_direction(forces, yields) - 3 * forces).norm() < 1e-15);
}
