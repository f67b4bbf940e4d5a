// Minimisers on a function object, all with a backtracking line search: BFGS for few variables,
// limited-memory BFGS for many, and steepest descent, preconditioned, where nothing is known of the
// curvature (J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed., algorithms 3.1, 6.1, 7.4
// and 7.5).
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

namespace palpa {

// The last steps of a minimisation and the changes of the gradient (L-BFGS memory).
class CurvaturePairs {
public:
    using Vector = Eigen::VectorXd;

    // `scales`: what is known beforehand of the inverse Hessian is scaled by the last pair, as
    // suits one whose size is a guess.
    CurvaturePairs() = default;
    explicit CurvaturePairs(bool scales) noexcept : scales_(scales) {}

    bool is_empty() const noexcept { return steps_.empty(); }

    void clear() noexcept {
        steps_.clear();
        first_scale_ = 1;
    }

    // Adds a step s and the change y of the gradient. With negative curvature it is not stored, but
    // the next step may be longer.
    void add(Eigen::VectorXd s, Eigen::VectorXd y) {
        constexpr double least = 1e-8;
        const double curvature = s.dot(y);
        if (!(curvature > least * s.norm() * y.norm())) {
            first_scale_ *= 2;
            return;
        }
        first_scale_ = 1;
        if (steps_.size() == most) steps_.pop_front();
        steps_.push_back({std::move(s), std::move(y), 1.0 / curvature});
    }

    // The two-loop recursion: the negative gradient times the estimated inverse Hessian.
    // `precondition` multiplies by that inverse as far as it is known beforehand.
    template <class Precondition>
    Eigen::VectorXd find_direction(const Eigen::VectorXd& forces,
                                   const Precondition& precondition) const {
        Eigen::VectorXd d = forces;
        std::vector<double> along(steps_.size());
        for (std::size_t i = steps_.size(); i-- > 0;) {
            along[i] = steps_[i].rho * steps_[i].s.dot(d);
            d -= along[i] * steps_[i].y;
        }
        d = precondition(d);
        if (steps_.empty()) {
            d *= first_scale_;
        } else if (scales_) {
            const Eigen::VectorXd& y = steps_.back().y;
            d /= steps_.back().rho * y.dot(precondition(y));
        }
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            d += (along[i] - steps_[i].rho * steps_[i].y.dot(d)) * steps_[i].s;
        }
        return d;
    }

private:
    static constexpr std::size_t most = 8;

    struct Step {
        Eigen::VectorXd s, y;
        double rho;  // 1/(s·y)
    };
    std::deque<Step> steps_;
    bool scales_ = true;
    double first_scale_ = 1;  // scale of steps without pairs
};

// The inverse Hessian by the BFGS formula after all steps, as a matrix.
template <int Size>
class InverseHessian {
public:
    using Vector = Eigen::Matrix<double, Size, 1>;
    using Matrix = Eigen::Matrix<double, Size, Size>;

    bool is_empty() const noexcept { return is_first_; }

    void clear() noexcept { *this = {}; }

    // Adds a step s and change y. The first step sets the scale of all directions.
    void add(const Vector& s, const Vector& y) {
        constexpr double least = 1e-12;
        const bool is_first = std::exchange(is_first_, false);
        const double curvature = s.dot(y);
        if (curvature <= least * y.squaredNorm()) return;
        if (is_first) inverse_ = Matrix::Identity() * (curvature / y.squaredNorm());
        const Matrix left = Matrix::Identity() - s * y.transpose() / curvature;
        inverse_ = (left * inverse_ * left.transpose() + s * s.transpose() / curvature).eval();
    }

    // Before the first step, and if the formula would lead uphill: steepest descent.
    template <class Precondition>
    Vector find_direction(const Vector& forces, const Precondition& precondition) const {
        if (is_first_) return precondition(forces);
        const Vector direction = inverse_ * forces;
        return direction.dot(forces) > 0 ? direction : Vector(precondition(forces));
    }

private:
    Matrix inverse_ = Matrix::Identity();
    bool is_first_ = true;
};

// The function to minimise. It is at a point and knows its value and the forces there, the negative
// gradient.
template <class Function, class Vector>
concept Minimisable = requires(Function& function, const Function& at, const Vector& v,
                               Vector& direction, double& length) {
    { at.value() } -> std::convertible_to<double>;
    { at.forces() } -> std::convertible_to<const Vector&>;
    // The inverse Hessian as far as it is known, times v.
    { function.precondition(v) } -> std::convertible_to<Vector>;
    // Limits a direction to the longest allowed step.
    { function.limit(v) } -> std::convertible_to<Vector>;
    // The value at the trial point, length times direction away. Where that is too far, the
    // direction becomes a shorter one, and the length 1.
    { function.try_move(direction, length) } -> std::convertible_to<double>;
    { at.trial_move() } -> std::convertible_to<Vector>;
    { at.trial_forces() } -> std::convertible_to<const Vector&>;
    // Whether that value is far enough down, for the change that the gradient alone would make.
    { at.accepts(length, length) } -> std::convertible_to<bool>;
    { function.accept() };  // moves to the trial point
};

// Armijo's condition: a value against the one before and the change that the gradient alone would
// make, which is negative.
inline bool meets_armijo(double before, double value, double linear_change) {
    constexpr double share = 1e-4;
    return value <= before + share * linear_change;
}

// Armijo's condition, which rounding must not hide.
inline bool is_sufficient(double before, double value, double linear_change) {
    return value < before && meets_armijo(before, value, linear_change);
}

// How a line search continues after a rejected move, and where it ends.
enum class Backtracking : std::uint8_t {
    Parabola,  // to the minimum of the parabola through both values and the slope, within bounds
    Halving,
};

struct LineSearch {
    int tries = 25;
    Backtracking backtracking = Backtracking::Parabola;
    double shortest = 0;  // shortest move that is tried
};

inline double find_shorter(Backtracking backtracking, double length, double slope, double above) {
    if (backtracking == Backtracking::Halving) return 0.5 * length;
    const double best = 0.5 * length * length * slope / above;
    return std::isfinite(best) ? std::clamp(best, 0.1 * length, 0.5 * length) : 0.1 * length;
}

// The backtracking line search: tries shorter moves until one is accepted, and passes its curvature
// to `memory`. The function may shorten the direction.
template <class Memory, Minimisable<typename Memory::Vector> Function>
bool search_line(Function& function, Memory& memory, typename Memory::Vector& direction,
                 const LineSearch& search = {}) {
    if (!direction.allFinite() || !(function.forces().dot(direction) > 0)) return false;
    double length = 1;
    for (int i = 0; i < search.tries; ++i) {
        if (search.shortest > 0 && !(length * direction.norm() > search.shortest)) return false;
        const double value = function.try_move(direction, length);
        const double slope = function.forces().dot(direction);
        if (std::isfinite(value) && function.accepts(value, -length * slope)) {
            memory.add(function.trial_move(), function.forces() - function.trial_forces());
            function.accept();
            return true;
        }
        const double above = value - (function.value() - length * slope);
        length = find_shorter(search.backtracking, length, slope, above);
    }
    return false;
}

// One step along the direction of `memory` (CurvaturePairs or InverseHessian). Returns false if the
// line search finds nothing lower.
template <class Memory, Minimisable<typename Memory::Vector> Function>
bool step_along(Function& function, Memory& memory, const LineSearch& search = {}) {
    using Vector = typename Memory::Vector;
    Vector direction = function.limit(memory.find_direction(
        function.forces(), [&](const Vector& v) { return function.precondition(v); }));
    return search_line(function, memory, direction, search);
}

// One minimisation step; false if even steepest descent finds nothing lower. The caller keeps the
// memory as long as it describes the function.
template <class Memory, Minimisable<typename Memory::Vector> Function>
bool step_downhill(Function& function, Memory& memory, const LineSearch& search = {}) {
    while (!step_along(function, memory, search)) {
        if (memory.is_empty()) return false;
        memory.clear();
    }
    return true;
}

}  // namespace palpa
