// What the forces of any energy term must obey, wherever the atoms are.
#pragma once
#include "math/vec.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

namespace palpa::test {

// `add(positions, forces)` adds a term's forces and returns its energy.
template <class Add>
double forces_of(const Add& add, const std::vector<Vec3>& positions, std::vector<Vec3>& forces) {
    forces.assign(positions.size(), Vec3::Zero());
    return add(std::span<const Vec3>(positions), std::span<Vec3>(forces));
}

// Energy and forces are numbers, and the forces sum up to nothing and turn nothing.
template <class Add>
void check_balance(const Add& add, const std::vector<Vec3>& positions) {
    std::vector<Vec3> forces;
    CHECK(std::isfinite(forces_of(add, positions, forces)));
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double size = 0, turn = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        CHECK(forces[i].allFinite());
        force += forces[i];
        torque += positions[i].cross(forces[i]);
        size += forces[i].norm();
        turn += positions[i].norm() * forces[i].norm();
    }
    // Rounding only.
    CHECK(force.norm() <= 1e-13 * size);
    CHECK(torque.norm() <= 1e-12 * turn);
}

// Balanced, the derivative of the energy, and moving with the molecule.
template <class Add>
void check_forces(const Add& add, const std::vector<Vec3>& positions) {
    check_balance(add, positions);
    std::vector<Vec3> forces, ignored;
    const double energy = forces_of(add, positions, forces);
    double largest = 0;
    for (const Vec3& force : forces) largest = std::max(largest, force.norm());

    constexpr double h = 1e-5;  // Å: an error of h^2 E'''/6
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            INFO("atom " << i << " axis " << axis);
            std::vector<Vec3> up = positions, down = positions;
            up[i](axis) += h;
            down[i](axis) -= h;
            const double slope =
                (forces_of(add, up, ignored) - forces_of(add, down, ignored)) / (2 * h);
            CHECK(forces[i](axis) == Approx(-slope).margin(1e-7 * (1 + largest)));
        }
    }

    const Mat3 turn = Eigen::AngleAxisd(1.2, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    std::vector<Vec3> moved, moved_forces;
    for (const Vec3& position : positions) moved.push_back(turn * position + Vec3(3, -5, 7));
    CHECK(forces_of(add, moved, moved_forces) == Approx(energy).epsilon(1e-11).margin(1e-11));
    for (std::size_t i = 0; i < positions.size(); ++i) {
        CHECK((moved_forces[i] - turn * forces[i]).norm() < 1e-10 * (1 + largest));
    }
}

// Atoms in a cube of 2 `spread` Å, none closer than `apart` to another.
inline std::vector<Vec3> random_positions(std::mt19937& random, std::size_t count, double spread,
                                          double apart) {
    std::uniform_real_distribution<double> uniform(-spread, spread);
    std::vector<Vec3> positions;
    while (positions.size() < count) {
        const double x = uniform(random), y = uniform(random), z = uniform(random);
        bool free = true;
        for (const Vec3& other : positions) free = free && (Vec3(x, y, z) - other).norm() > apart;
        if (free) positions.emplace_back(x, y, z);
    }
    return positions;
}

}  // namespace palpa::test
