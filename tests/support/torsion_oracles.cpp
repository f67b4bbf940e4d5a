#include "tests/support/torsion_oracles.h"

#include <Eigen/Dense>
#include <cstddef>

namespace palpa::test {

namespace {

using Long = long double;
using Long3 = Eigen::Matrix<Long, 3, 1>;
using Long6 = Eigen::Matrix<Long, 6, 1>;
using LongMatrix66 = Eigen::Matrix<Long, 6, 6>;
using LongVector = Eigen::Matrix<Long, Eigen::Dynamic, 1>;
using LongMatrix = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;

struct Molecules {
    std::vector<std::uint32_t> of_body, bases;
    std::vector<Long3> centres;
};

Molecules molecules_of(const TorsionCase& c) {
    Molecules result;
    for (std::uint32_t b = 0; b < c.bodies.bodies.size(); ++b) {
        if (c.bodies.is_base(b)) result.bases.push_back(b);
        result.of_body.push_back(c.bodies.is_base(b)
                                     ? static_cast<std::uint32_t>(result.bases.size() - 1)
                                     : result.of_body[c.bodies.bodies[b].parent]);
    }
    std::vector<Long> mass(result.bases.size(), 0);
    result.centres.assign(result.bases.size(), Long3::Zero());
    for (std::size_t i = 0; i < c.masses.size(); ++i) {
        const std::uint32_t molecule = result.of_body[c.bodies.body_of[i]];
        result.centres[molecule] += Long(c.masses[i]) * c.positions[i].cast<Long>();
        mass[molecule] += c.masses[i];
    }
    for (std::size_t i = 0; i < mass.size(); ++i) result.centres[i] /= mass[i];
    return result;
}

// What is prescribed of a base, and the point that it is prescribed of.
struct Prescribed {
    bool turn, shift;
    Long6 acceleration;
    Long3 point;
};

Prescribed prescribed(const Molecules& molecules, const Held& held, std::size_t molecule) {
    const GuidedBase& base = held.guides[molecule];
    const bool rests = held.is_active[molecules.bases[molecule]] == 0;
    Prescribed result{rests || base.guide == BaseGuide::Whole,
                      rests || base.guide != BaseGuide::None, Long6::Zero(),
                      molecules.centres[molecule]};
    if (base.guide != BaseGuide::None) result.acceleration = base.acceleration.cast<Long>();
    if (base.guide == BaseGuide::Point) {
        result.acceleration.head<3>().setZero();
        if (base.point) result.point = base.point->cast<Long>();
    }
    return result;
}

// From one point of a rigid body to another.
Long6 shifted(const Long6& acceleration, const Long3& from, const Long3& to) {
    Long6 result = acceleration;
    const Long3 turn = acceleration.head<3>();
    result.tail<3>() += turn.cross(to - from);
    return result;
}

}  // namespace

std::vector<Vec3> centres_of(const TorsionCase& c) {
    std::vector<Vec3> centres;
    for (const Long3& centre : molecules_of(c).centres) centres.push_back(centre.cast<double>());
    return centres;
}

TorsionAccelerations dense_accelerations(const TorsionCase& c, const Held& held) {
    const Molecules molecules = molecules_of(c);
    const std::size_t atoms = c.masses.size(), bodies = c.bodies.bodies.size();
    // Whether an atom moves with a body's joint.
    std::vector<std::vector<std::uint8_t>> moves(bodies, std::vector<std::uint8_t>(atoms, 0));
    for (std::size_t i = 0; i < atoms; ++i) {
        for (std::uint32_t b = c.bodies.body_of[i]; b != no_body; b = c.bodies.bodies[b].parent) {
            moves[b][i] = 1;
        }
    }
    const auto cross = [&](const Long3& axis, std::size_t atom, const Long3& point) {
        return Long3(axis.cross(c.positions[atom].cast<Long>() - point));
    };
    std::vector<LongVector> columns;
    LongVector given = LongVector::Zero(static_cast<Eigen::Index>(3 * atoms));
    const auto add_column = [&](std::size_t body, const auto& velocity) {
        LongVector column = LongVector::Zero(static_cast<Eigen::Index>(3 * atoms));
        for (std::size_t i = 0; i < atoms; ++i) {
            if (moves[body][i] != 0) {
                column.segment<3>(static_cast<Eigen::Index>(3 * i)) = velocity(i);
            }
        }
        columns.push_back(column);
    };
    for (std::size_t b = 0; b < bodies; ++b) {
        if (!c.bodies.is_base(b)) {
            if (held.is_active[b] == 0) continue;
            const auto [j, k] = c.bodies.bodies[b].axis;
            const Long3 point = c.positions[k].cast<Long>();
            const Long3 axis = (point - c.positions[j].cast<Long>()).normalized();
            add_column(b, [&](std::size_t i) { return cross(axis, i, point); });
            continue;
        }
        const Prescribed base = prescribed(molecules, held, molecules.of_body[b]);
        for (int k = 0; k < 6; ++k) {
            const Long3 unit = Long3::Unit(k % 3);
            add_column(b, [&](std::size_t i) { return k < 3 ? cross(unit, i, base.point) : unit; });
            if (!(k < 3 ? base.turn : base.shift)) continue;
            given += base.acceleration[k] * columns.back();
            columns.pop_back();
        }
    }
    LongMatrix J(static_cast<Eigen::Index>(3 * atoms), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i)
        J.col(static_cast<Eigen::Index>(i)) = columns[i];
    LongVector mass(J.rows()), force(J.rows());
    for (Eigen::Index i = 0; i < J.rows(); ++i) {
        mass[i] = c.masses[static_cast<std::size_t>(i / 3)];
        force[i] = c.forces[static_cast<std::size_t>(i / 3)][i % 3];
    }
    const LongMatrix M = J.transpose() * mass.asDiagonal() * J;
    const LongVector right = J.transpose() * (force - mass.asDiagonal() * given);
    TorsionAccelerations result{std::vector<double>(bodies, 0), {}};
    LongVector qdd;
    // A molecule in line has a direction in which nothing has inertia.
    if (!columns.empty()) {
        qdd = Eigen::CompleteOrthogonalDecomposition<LongMatrix>(M).solve(right);
    }
    Eigen::Index next = 0;
    for (std::size_t b = 0; b < bodies; ++b) {
        if (c.bodies.is_base(b)) {
            const std::uint32_t molecule = molecules.of_body[b];
            const Prescribed base = prescribed(molecules, held, molecule);
            Long6 a = base.acceleration;
            for (int k = 0; k < 6; ++k) {
                if (!(k < 3 ? base.turn : base.shift)) a[k] = qdd[next++];
            }
            result.bases.push_back(
                shifted(a, base.point, molecules.centres[molecule]).cast<double>());
        } else if (held.is_active[b] != 0) {
            result.joints[b] = static_cast<double>(qdd[next++]);
        }
    }
    return result;
}

TorsionAccelerations recursive_accelerations(const TorsionCase& c, const Held& held) {
    const Molecules molecules = molecules_of(c);
    const std::size_t bodies = c.bodies.bodies.size();
    std::vector<LongMatrix66> inertia(bodies, LongMatrix66::Zero());
    std::vector<Long6> bias(bodies, Long6::Zero()), S(bodies, Long6::Zero());
    for (std::size_t i = 0; i < c.masses.size(); ++i) {
        const std::uint32_t body = c.bodies.body_of[i];
        const Long3 arm = c.positions[i].cast<Long>() - molecules.centres[molecules.of_body[body]];
        const Long3 force = c.forces[i].cast<Long>();
        Eigen::Matrix<Long, 3, 6> J;  // the atom's acceleration
        for (int k = 0; k < 3; ++k) {
            J.col(k) = Long3::Unit(k).cross(arm);
            J.col(k + 3) = Long3::Unit(k);
        }
        inertia[body] += Long(c.masses[i]) * J.transpose() * J;
        bias[body] -= J.transpose() * force;
    }
    for (std::size_t b = 0; b < bodies; ++b) {
        if (c.bodies.is_base(b)) continue;
        const auto [j, k] = c.bodies.bodies[b].axis;
        const Long3 point = c.positions[k].cast<Long>();
        const Long3 axis = (point - c.positions[j].cast<Long>()).normalized();
        S[b] << axis, -axis.cross(point - molecules.centres[molecules.of_body[b]]);
    }
    for (std::size_t b = bodies; b-- > 0;) {
        if (c.bodies.is_base(b)) continue;
        const std::uint32_t parent = c.bodies.bodies[b].parent;
        inertia[parent] += inertia[b];
        bias[parent] += bias[b];
        if (held.is_active[b] == 0) continue;
        const Long6 U = inertia[b] * S[b];
        const Long D = S[b].dot(U);
        inertia[parent] -= U * U.transpose() / D;
        bias[parent] -= U * (S[b].dot(bias[b]) / D);
    }
    TorsionAccelerations result{std::vector<double>(bodies, 0), {}};
    std::vector<Long6> a(bodies);
    for (std::size_t b = 0; b < bodies; ++b) {
        const std::uint32_t molecule = molecules.of_body[b];
        if (c.bodies.is_base(b)) {
            const Prescribed base = prescribed(molecules, held, molecule);
            const Long3& centre = molecules.centres[molecule];
            // Inertia and bias as they are about the point, where what is prescribed is known.
            LongMatrix66 to_centre;
            for (int k = 0; k < 6; ++k) {
                to_centre.col(k) = shifted(Long6::Unit(k), base.point, centre);
            }
            const LongMatrix66 I = to_centre.transpose() * inertia[b] * to_centre;
            const Long6 p = to_centre.transpose() * bias[b];
            Long6 motion = base.acceleration;
            if (!base.turn && !base.shift) motion = -I.ldlt().solve(p);
            if (!base.turn && base.shift) {
                const Long3 push = p.head<3>() + I.topRightCorner<3, 3>() * motion.tail<3>();
                motion.head<3>() = -I.topLeftCorner<3, 3>().ldlt().solve(push);
            }
            a[b] = to_centre * motion;
            result.bases.push_back(a[b].cast<double>());
            continue;
        }
        a[b] = a[c.bodies.bodies[b].parent];
        if (held.is_active[b] == 0) continue;
        const Long6 U = inertia[b] * S[b];
        const Long qdd = -(S[b].dot(bias[b]) + U.dot(a[b])) / S[b].dot(U);
        a[b] += qdd * S[b];
        result.joints[b] = static_cast<double>(qdd);
    }
    return result;
}

}  // namespace palpa::test
