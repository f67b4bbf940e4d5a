#include "simulation/relax.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace palpa {
namespace {

constexpr double longest_step = 0.1;  // Å, of any point
constexpr double shortest_step = 1e-9;
constexpr int most_evaluations = 1000;

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

struct Pose {
    Vec3 centre = Vec3::Zero();
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};

// The variables of a step: place of the centre, and turn about it times `length`, both in Å.
Pose moved(const Pose& pose, const Vec6& step, double length) {
    const Vec3 turn = step.tail<3>() / length;
    const double angle = turn.norm();
    if (angle == 0) return {pose.centre + step.head<3>(), pose.turn};
    const Eigen::Quaterniond by(Eigen::AngleAxisd(angle, turn / angle));
    return {pose.centre + step.head<3>(), (by * pose.turn).normalized()};
}

void place(const std::vector<Vec3>& shape, const Pose& pose, std::span<Vec3> positions) {
    for (std::size_t i = 0; i < shape.size(); ++i) {
        positions[i] = pose.centre + pose.turn * shape[i];
    }
}

// Of the energy, in the step's variables.
Vec6 gradient(const FieldSum& field, const Pose& pose, double length) {
    Vec6 slope;
    slope << -field.force, -field.torque_about(pose.centre) / length;
    return slope;
}

// The inverse of the curvature, corrected by what the gradient did over a step.
void update_inverse(const Vec6& step, const Vec6& change, bool first, Mat6& inverse) {
    const double along = step.dot(change);
    if (along <= 1e-12 * change.squaredNorm()) return;  // not curved upward: nothing to learn
    if (first) inverse = Mat6::Identity() * (along / change.squaredNorm());
    const Mat6 left = Mat6::Identity() - step * change.transpose() / along;
    inverse = (left * inverse * left.transpose() + step * step.transpose() / along).eval();
}

}  // namespace

RelaxReport relax_rigid(std::span<Vec3> positions, const Vec3& centre, FieldPoints group,
                        const FieldPoints& environment, const PairRule& rule,
                        double force_tolerance) {
    group.positions = positions;
    std::vector<Vec3> shape;
    double square = 0, radius = 0;
    for (const Vec3& position : positions) {
        shape.push_back(position - centre);
        square += shape.back().squaredNorm() / static_cast<double>(positions.size());
        radius = std::max(radius, shape.back().norm());
    }
    const double length = std::max(std::sqrt(square), 1e-3);

    Pose pose{centre};
    FieldSum field = evaluate_pair_field(group, environment, rule);
    Vec6 slope = gradient(field, pose, length);
    RelaxReport report{.energy_before = field.energy(), .evaluations = 1};
    Mat6 inverse = Mat6::Identity();
    bool first = true;
    const auto is_at_rest = [&] {
        return slope.head<3>().norm() < force_tolerance && slope.tail<3>().norm() < force_tolerance;
    };
    while (!is_at_rest() && report.evaluations < most_evaluations) {
        Vec6 step = -inverse * slope;
        if (step.dot(slope) >= 0) step = -slope;
        const double reach = step.head<3>().norm() + step.tail<3>().norm() / length * radius;
        step *= std::min(1.0, longest_step / reach);

        bool lower = false;
        for (; !lower && step.norm() > shortest_step; step *= lower ? 1 : 0.5) {
            const Pose trial = moved(pose, step, length);
            place(shape, trial, positions);
            const FieldSum there = evaluate_pair_field(group, environment, rule);
            ++report.evaluations;
            if (!(there.energy() <= field.energy() + 1e-4 * slope.dot(step))) continue;
            lower = true;
            const Vec6 new_slope = gradient(there, trial, length);
            update_inverse(step, new_slope - slope, first, inverse);
            first = false;
            pose = trial;
            field = there;
            slope = new_slope;
        }
        if (!lower) break;
    }
    place(shape, pose, positions);
    report.energy_after = field.energy();
    report.displacement = (pose.centre - centre).norm();
    report.angle = Eigen::AngleAxisd(pose.turn).angle();
    report.force = field.force.norm();
    report.torque = field.torque_about(pose.centre).norm();
    return report;
}

}  // namespace palpa
