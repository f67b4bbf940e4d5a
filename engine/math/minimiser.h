// Minimisers on a function object: limited-memory BFGS with a backtracking line search, and
// preconditioned steepest descent where no curvature pairs are known (J. Nocedal, S. J. Wright,
// Numerical Optimization, 2nd ed., algorithms 3.1, 7.4 and 7.5).
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

namespace palpa {

// The last steps of a way downhill and what the gradient did along them.
class CurvaturePairs {
public:
    bool is_empty() const noexcept { return steps_.empty(); }

    void clear() noexcept {
        steps_.clear();
        first_scale_ = 1;
    }

    // A step s along which the gradient rose by y. One of negative curvature is no pair, but says
    // that the next step may be longer.
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
        } else {
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
    double first_scale_ = 1;  // of steps without pairs
};

// What is minimised. It stands at a point and knows its value and the forces there, the negative
// gradient.
template <class Function>
concept Minimisable = requires(Function& function, const Function& at, const Eigen::VectorXd& v,
                               Eigen::VectorXd& direction, double& length) {
    { at.value() } -> std::convertible_to<double>;
    { at.forces() } -> std::convertible_to<const Eigen::VectorXd&>;
    // The inverse Hessian as far as it is known, times v.
    { function.precondition(v) } -> std::convertible_to<Eigen::VectorXd>;
    // Limits a direction to the longest step that is allowed.
    { function.limit(v) } -> std::convertible_to<Eigen::VectorXd>;
    // The value at the trial point, length times direction away. Where that is too far, the
    // direction becomes a shorter one, and the length 1.
    { function.try_move(direction, length) } -> std::convertible_to<double>;
    { at.trial_move() } -> std::convertible_to<Eigen::VectorXd>;
    { at.trial_forces() } -> std::convertible_to<const Eigen::VectorXd&>;
    // Whether that value is far enough down, for the change that the gradient alone would make.
    { at.accepts(length, length) } -> std::convertible_to<bool>;
    { function.accept() };  // the trial point is where it stands now
};

// Armijo's condition: a value against the one before, and against the change that the gradient
// alone would make, which is negative.
inline bool is_sufficient(double before, double value, double linear_change) {
    constexpr double share = 1e-4;
    return value < before && value <= before + share * linear_change;
}

// Shorter and shorter moves, until one is accepted, which gives a curvature pair. The direction is
// the function's to shorten.
template <Minimisable Function>
bool search_line(Function& function, CurvaturePairs& pairs, Eigen::VectorXd& direction, int tries) {
    if (!direction.allFinite() || !(function.forces().dot(direction) > 0)) return false;
    double length = 1;
    for (int i = 0; i < tries; ++i) {
        const double value = function.try_move(direction, length);
        const double slope = function.forces().dot(direction);
        if (std::isfinite(value) && function.accepts(value, -length * slope)) {
            pairs.add(function.trial_move(), function.forces() - function.trial_forces());
            function.accept();
            return true;
        }
        // To the minimum of the parabola through both values and the slope, within bounds.
        const double above = value - (function.value() - length * slope);
        const double best = 0.5 * length * length * slope / above;
        length = std::isfinite(best) ? std::clamp(best, 0.1 * length, 0.5 * length) : 0.1 * length;
    }
    return false;
}

// One step downhill; false where even steepest descent finds nothing lower. The caller keeps the
// pairs for as long as they describe the function.
template <Minimisable Function>
bool step_downhill(Function& function, CurvaturePairs& pairs, int tries = 25) {
    while (true) {
        Eigen::VectorXd direction = function.limit(pairs.find_direction(
            function.forces(), [&](const Eigen::VectorXd& v) { return function.precondition(v); }));
        if (search_line(function, pairs, direction, tries)) return true;
        if (pairs.is_empty()) return false;
        pairs.clear();
    }
}

}  // namespace palpa
