// What the last steps of a way downhill say about the curvature: limited-memory BFGS (J. Nocedal,
// S. J. Wright, Numerical Optimization, 2nd ed., algorithm 7.4).
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

namespace palpa {

class CurvatureMemory {
public:
    bool is_empty() const noexcept { return steps_.empty(); }

    void clear() noexcept {
        steps_.clear();
        boldness_ = 1;
    }

    // A step s that lowered the forces by y. Steps along which the energy bends down say nothing
    // about a minimum, but that the next may be longer.
    void add(Eigen::VectorXd s, Eigen::VectorXd y) {
        constexpr double least = 1e-8;
        const double bend = s.dot(y);
        if (!(bend > least * s.norm() * y.norm())) {
            boldness_ *= 2;
            return;
        }
        boldness_ = 1;
        if (steps_.size() == most) steps_.pop_front();
        steps_.push_back({std::move(s), std::move(y), 1.0 / bend});
    }

    // The two loops: forces times the inverse of the estimated curvature. `compliance` makes of a
    // vector of forces one of moves, and is that inverse as far as it is known beforehand.
    template <class Compliance>
    Eigen::VectorXd find_direction(const Eigen::VectorXd& forces,
                                   const Compliance& compliance) const {
        Eigen::VectorXd d = forces;
        std::vector<double> along(steps_.size());
        for (std::size_t i = steps_.size(); i-- > 0;) {
            along[i] = steps_[i].inverse_bend * steps_[i].s.dot(d);
            d -= along[i] * steps_[i].y;
        }
        d = compliance(d);
        if (steps_.empty()) {
            d *= boldness_;
        } else {
            const Eigen::VectorXd& y = steps_.back().y;
            d /= steps_.back().inverse_bend * y.dot(compliance(y));
        }
        for (std::size_t i = 0; i < steps_.size(); ++i) {
            d += (along[i] - steps_[i].inverse_bend * steps_[i].y.dot(d)) * steps_[i].s;
        }
        return d;
    }

private:
    static constexpr std::size_t most = 8;

    struct Step {
        Eigen::VectorXd s, y;
        double inverse_bend;  // 1/(s·y)
    };
    std::deque<Step> steps_;
    double boldness_ = 1;  // of steps without a memory
};

}  // namespace palpa
