#include "statics/relax_rigid.h"

#include "math/minimiser.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace palpa {
namespace {

constexpr double longest_step = 0.1;  // Å, of any point
constexpr double shortest_step = 1e-9;
constexpr int most_evaluations = 1000;

using Vec6 = Eigen::Matrix<double, 6, 1>;

struct RigidPose {
    Vec3 centre = Vec3::Zero();
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};

// The variables of a step: place of the centre, and turn about it times `length`, both in Å.
RigidPose moved(const RigidPose& pose, const Vec6& step, double length) {
    const Vec3 turn = step.tail<3>() / length;
    return {pose.centre + step.head<3>(), (turn_of(turn) * pose.turn).normalized()};
}

void place(const std::vector<Vec3>& shape, const RigidPose& pose, std::span<Vec3> positions) {
    for (std::size_t i = 0; i < shape.size(); ++i) {
        positions[i] = pose.centre + pose.turn * shape[i];
    }
}

// The energy over the step's variables. The positions are those of the trial.
class RigidDescent {
public:
    RigidDescent(std::span<Vec3> positions, const Vec3& centre, const FieldPoints& group,
                 const FieldPoints& environment, const PairRule& rule)
        : positions_(positions), group_(group), environment_(environment), rule_(rule) {
        group_.positions = positions;
        double square = 0;
        for (const Vec3& position : positions) {
            shape_.push_back(position - centre);
            square += shape_.back().squaredNorm() / static_cast<double>(positions.size());
            radius_ = std::max(radius_, shape_.back().norm());
        }
        length_ = std::max(std::sqrt(square), 1e-3);
        here_ = evaluate({centre});
    }

    double value() const { return here_.field.energy(); }
    const Vec6& forces() const { return here_.forces; }
    const Vec6& trial_forces() const { return trial_.forces; }
    const Vec6& trial_move() const { return move_; }

    // Both variables are lengths: nothing more is known.
    static Vec6 precondition(const Vec6& forces) { return forces; }

    Vec6 limit(const Vec6& direction) const {
        const double reach =
            direction.head<3>().norm() + direction.tail<3>().norm() / length_ * radius_;
        return direction * std::min(1.0, longest_step / reach);
    }

    double try_move(const Vec6& direction, double length) {
        move_ = length * direction;
        const RigidPose pose = moved(here_.pose, move_, length_);
        place(shape_, pose, positions_);
        trial_ = evaluate(pose);
        return trial_.field.energy();
    }

    bool accepts(double value, double linear_change) const {
        return meets_armijo(here_.field.energy(), value, linear_change);
    }

    void accept() { here_ = trial_; }

    bool is_at_rest(double force_tolerance) const {
        return here_.forces.head<3>().norm() < force_tolerance &&
               here_.forces.tail<3>().norm() < force_tolerance;
    }

    const RigidPose& pose() const { return here_.pose; }
    const FieldSum& field() const { return here_.field; }
    int evaluations() const { return evaluations_; }

    void place_here() const { place(shape_, here_.pose, positions_); }

private:
    struct Point {
        RigidPose pose;
        FieldSum field;
        Vec6 forces;
    };

    Point evaluate(const RigidPose& pose) {
        ++evaluations_;
        Point point{pose, evaluate_pair_field(group_, environment_, rule_), Vec6::Zero()};
        point.forces << point.field.force, point.field.torque_about(pose.centre) / length_;
        return point;
    }

    std::span<Vec3> positions_;
    FieldPoints group_;
    const FieldPoints& environment_;
    const PairRule& rule_;
    std::vector<Vec3> shape_;
    double radius_ = 0, length_ = 0;
    int evaluations_ = 0;
    Point here_, trial_;
    Vec6 move_;
};

}  // namespace

RelaxReport relax_rigid(std::span<Vec3> positions, const Vec3& centre, FieldPoints group,
                        const FieldPoints& environment, const PairRule& rule,
                        double force_tolerance) {
    constexpr LineSearch search{std::numeric_limits<int>::max(), Backtracking::Halving,
                                shortest_step};
    RigidDescent descent(positions, centre, group, environment, rule);
    RelaxReport report{.energy_before = descent.value()};
    InverseHessian<6> inverse;
    while (!descent.is_at_rest(force_tolerance) && descent.evaluations() < most_evaluations) {
        if (!step_along(descent, inverse, search)) break;
    }
    descent.place_here();
    report.energy_after = descent.value();
    report.displacement = (descent.pose().centre - centre).norm();
    report.angle = rotation_vector_of(descent.pose().turn).norm();
    report.force = descent.field().force.norm();
    report.torque = descent.field().torque_about(descent.pose().centre).norm();
    report.evaluations = descent.evaluations();
    return report;
}

}  // namespace palpa
