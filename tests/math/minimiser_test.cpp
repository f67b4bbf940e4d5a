#include "math/minimiser.h"

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
    CurvaturePairs memory;
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
    CurvaturePairs memory;

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

TEST_CASE("the inverse Hessian is BFGS's formula for all steps, from the first one's scale",
          "[math]") {
    std::mt19937 random(3);
    const Matrix curvature = random_curvature(random);
    const Vector forces = random_vector(random);
    InverseHessian<size> inverse;
    const auto yields = [](const Vector& f) -> Vector { return 3 * f; };
    CHECK(inverse.is_empty());
    CHECK(inverse.find_direction(forces, yields) == 3 * forces);

    Matrix H;
    Vector s, y;
    for (int i = 0; i < 20; ++i) {
        s = random_vector(random);
        y = curvature * s;
        inverse.add(s, y);
        if (i == 0) H = Matrix::Identity(size, size) * (s.dot(y) / y.squaredNorm());
        // As the book has it with all products multiplied out.
        const double r = 1 / s.dot(y);
        const Vector Hy = H * y;
        H += (r + r * r * y.dot(Hy)) * s * s.transpose() -
             r * (Hy * s.transpose() + s * Hy.transpose());
    }
    CHECK_FALSE(inverse.is_empty());
    const Vector direction = inverse.find_direction(forces, yields);
    CHECK((direction - H * forces).norm() < 1e-9 * direction.norm());
    CHECK((inverse.find_direction(y, yields) - s).norm() < 1e-9 * s.norm());

    // What bends down teaches nothing.
    inverse.add(s, -y);
    inverse.add(s, Vector::Zero(size));
    CHECK(inverse.find_direction(forces, yields) == direction);
    inverse.clear();
    CHECK(inverse.find_direction(forces, yields) == 3 * forces);
}

TEST_CASE("after one step both memories point the same way", "[math]") {
    std::mt19937 random(4);
    const Matrix curvature = random_curvature(random);
    const Vector forces = random_vector(random), s = random_vector(random);
    const auto yields = [](const Vector& f) -> Vector { return f; };
    InverseHessian<size> dense;
    CurvaturePairs limited;

    dense.add(s, curvature * s);
    limited.add(s, curvature * s);

    const Vector direction = limited.find_direction(forces, yields);
    CHECK((dense.find_direction(forces, yields) - direction).norm() < 1e-12 * direction.norm());
}

namespace {

// Rosenbrock's valley in pairs of coordinates, f = sum 100 (y - x^2)^2 + (1 - x)^2; minimum at 1.
template <class Vector = Eigen::VectorXd>
class Valley {
public:
    explicit Valley(Vector start) : x_(std::move(start)) { forces_ = forces_at(x_); }

    static double value_at(const Vector& x) {
        double value = 0;
        for (Eigen::Index i = 0; i < x.size(); i += 2) {
            const double a = x[i + 1] - x[i] * x[i], b = 1 - x[i];
            value += 100 * a * a + b * b;
        }
        return value;
    }

    double value() const { return value_at(x_); }
    const Vector& forces() const { return forces_; }
    static Vector precondition(const Vector& v) { return v / 400; }
    static Vector limit(const Vector& v) {
        return v.norm() > longest ? Vector(v * (longest / v.norm())) : v;
    }
    double try_move(const Vector& direction, double length) {
        trial_ = x_ + length * direction;
        trial_forces_ = forces_at(trial_);
        return value_at(trial_);
    }
    Vector trial_move() const { return trial_ - x_; }
    bool accepts(double value, double linear_change) const {
        return is_sufficient(value_at(x_), value, linear_change);
    }
    const Vector& trial_forces() const { return trial_forces_; }
    void accept() {
        x_ = trial_;
        forces_ = trial_forces_;
    }
    const Vector& place() const { return x_; }

    static constexpr double longest = 0.5;

private:
    static Vector forces_at(const Vector& x) {
        Vector f(x.size());
        for (Eigen::Index i = 0; i < x.size(); i += 2) {
            const double a = x[i + 1] - x[i] * x[i];
            f[i] = 400 * a * x[i] + 2 * (1 - x[i]);
            f[i + 1] = -200 * a;
        }
        return f;
    }

    Vector x_, forces_, trial_, trial_forces_;
};

}  // namespace

TEST_CASE("BFGS reaches the end of Rosenbrock's valley in few steps", "[math]") {
    using Few = Eigen::Matrix<double, 4, 1>;
    const auto backtracking = GENERATE(Backtracking::Parabola, Backtracking::Halving);
    Valley<Few> valley(Few(-1.2, 1, -0.8, 1));
    InverseHessian<4> inverse;
    double before = valley.value();
    int steps = 0;
    for (; valley.forces().norm() > 1e-9 && steps < 200; ++steps) {
        REQUIRE(step_along(valley, inverse, {.backtracking = backtracking}));
        CHECK(valley.value() < before);
        before = valley.value();
    }
    CHECK((valley.place() - Few::Ones()).norm() < 1e-8);
    CHECK(steps < 100);

    // Nothing is lower there.
    CHECK_FALSE(step_along(valley, inverse, {.shortest = 1e-9}));
    CHECK_FALSE(step_downhill(valley, inverse, {.shortest = 1e-9}));
    CHECK(inverse.is_empty());
}

namespace {

// All trials overshoot, until one is short enough; it writes down what is tried.
struct Overshoot {
    using One = Eigen::Matrix<double, 1, 1>;
    One force{1.0}, trial{0.0}, move{0.0};
    std::vector<double> tried = {};
    double accepted_below = 0;

    double value() const { return 0; }
    const One& forces() const { return force; }
    static One precondition(const One& v) { return v; }
    static One limit(const One& v) { return v; }
    double try_move(const One& direction, double length) {
        tried.push_back(length * direction[0]);
        move = length * direction;
        return 1;
    }
    const One& trial_move() const { return move; }
    const One& trial_forces() const { return trial; }
    bool accepts(double /*value*/, double linear_change) const {
        CHECK(linear_change == -tried.back());
        return tried.back() < accepted_below;
    }
    void accept() {}
};

}  // namespace

TEST_CASE("a line search goes back as it is told, and ends where it is told", "[math]") {
    InverseHessian<1> inverse;
    Overshoot halves;
    halves.accepted_below = 0.1;
    CHECK(step_along(halves, inverse, {.backtracking = Backtracking::Halving}));
    CHECK(halves.tried == std::vector<double>{1, 0.5, 0.25, 0.125, 0.0625});

    inverse.clear();
    Overshoot short_of;
    CHECK_FALSE(
        step_along(short_of, inverse, {.backtracking = Backtracking::Halving, .shortest = 0.2}));
    CHECK(short_of.tried == std::vector<double>{1, 0.5, 0.25});

    Overshoot few;
    CHECK_FALSE(step_along(few, inverse, {.tries = 2}));
    // The parabola through 0 with the slope -1 and 1 at 1 has its minimum at 1/4.
    CHECK(few.tried == std::vector<double>{1, 0.25});
}

TEST_CASE("limited-memory BFGS reaches the end of Rosenbrock's valley, always downhill", "[math]") {
    Vector start(size);
    for (Eigen::Index i = 0; i < size; i += 2) {
        start[i] = -1.2 + 0.1 * static_cast<double>(i);
        start[i + 1] = 1;
    }
    Valley<> valley(start);
    CurvaturePairs pairs;
    int steps = 0;
    double before = Valley<>::value_at(start);
    while (valley.forces().norm() > 1e-9 && steps < 500) {
        const Vector from = valley.place();
        REQUIRE(step_downhill(valley, pairs));
        CHECK((valley.place() - from).norm() <= Valley<>::longest * (1 + 1e-12));
        const double now = Valley<>::value_at(valley.place());
        CHECK(now < before);
        before = now;
        ++steps;
    }
    CHECK((valley.place() - Vector::Ones(size)).norm() < 1e-8);
    CHECK(steps < 400);  // steepest descent takes tens of thousands

    // At rest nothing is lower, with pairs or without.
    Valley<> rest(Vector::Ones(size));
    CHECK_FALSE(step_downhill(rest, pairs));
    CHECK(pairs.is_empty());
}

TEST_CASE("kept pairs make the next way shorter", "[math]") {
    Vector start = Vector::Constant(size, 0.5);
    Valley<> first(start);
    CurvaturePairs pairs;
    while (first.forces().norm() > 1e-6) REQUIRE(step_downhill(first, pairs));
    // A little beside the minimum, where the curvature is as before.
    const auto way_from = [&](CurvaturePairs known) {
        Valley<> valley(Vector::Constant(size, 1.001));
        int steps = 0;
        for (; valley.forces().norm() > 1e-6 && steps < 500; ++steps) {
            REQUIRE(step_downhill(valley, known));
        }
        return steps;
    };
    CHECK(way_from(pairs) < way_from({}));
}
