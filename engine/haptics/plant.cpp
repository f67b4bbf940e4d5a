#include "haptics/plant.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

namespace palpa {
namespace {

// One period of the loop without its spring: the plant, and the forces that are under way. In a
// period the oldest of them acts first, for the broken part of the delay, then the one after it.
struct DelayedLoop {
    Eigen::MatrixXd matrix;   // state: plant, then forces under way, the newest first
    Eigen::Index newest = 0;  // row of the force computed now, -K times the handle's position
};

DelayedLoop build_loop(const Plant& plant, double period_s, double delay_s) {
    const double periods = std::floor(delay_s / period_s + 1e-9);
    const double broken = std::max(delay_s - periods * period_s, 0.0);
    const SampledPlant early = sample_plant(plant, broken);
    const SampledPlant late = sample_plant(plant, period_s - broken);
    const Eigen::Index n = plant.A.rows();
    const auto forces = static_cast<Eigen::Index>(periods) + 2;
    DelayedLoop loop{Eigen::MatrixXd::Zero(n + forces, n + forces), n};
    loop.matrix.topLeftCorner(n, n) = late.A * early.A;
    loop.matrix.block(0, n + forces - 2, n, 1) = late.B.col(0);
    loop.matrix.block(0, n + forces - 1, n, 1) = late.A * early.B.col(0);
    for (Eigen::Index i = 1; i < forces; ++i) loop.matrix(n + i, n + i - 1) = 1;
    return loop;
}

// Largest |eigenvalue| of the loop with a spring of K.
double loop_radius(DelayedLoop loop, double K) {
    loop.matrix(loop.newest, 0) = -K;
    return loop.matrix.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

Plant build_plant(const DeviceDynamics& device, const std::optional<HandModel>& hand) {
    const bool has_grip = hand && hand->grip_stiffness_N_per_m > 0;
    const Eigen::Index states = has_grip ? 4 : 2;
    Plant plant{PlantMatrix::Zero(states, states), PlantInputs::Zero(states, 2), device.inertia_kg};
    double damping = device.viscosity_N_s_per_m;
    double stiffness = 0;
    if (hand && !has_grip) {  // hand and handle are one body
        plant.handle_mass_kg += hand->mass_kg;
        damping += hand->damping_N_s_per_m;
        stiffness = hand->stiffness_N_per_m;
        plant.B(1, 1) = 1 / plant.handle_mass_kg;
    }
    const double mass = plant.handle_mass_kg;
    plant.A(0, 1) = 1;
    plant.A(1, 0) = -stiffness / mass;
    plant.A(1, 1) = -damping / mass;
    plant.B(1, 0) = 1 / mass;
    if (has_grip) {
        const double k = hand->grip_stiffness_N_per_m, b = hand->grip_damping_N_s_per_m;
        plant.A.row(1) << -k / mass, -(damping + b) / mass, k / mass, b / mass;
        plant.A(2, 3) = 1;
        plant.A.row(3) << k, b, -(k + hand->stiffness_N_per_m), -(b + hand->damping_N_s_per_m);
        plant.A.row(3) /= hand->mass_kg;
        plant.B(3, 1) = 1 / hand->mass_kg;
    }
    return plant;
}

SampledPlant sample_plant(const Plant& plant, double period_s) {
    const Eigen::Index n = plant.A.rows();
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 2, n + 2);
    system.topLeftCorner(n, n) = plant.A * period_s;
    system.topRightCorner(n, 2) = plant.B * period_s;
    const Eigen::MatrixXd step = system.exp();
    return {step.topLeftCorner(n, n), step.topRightCorner(n, 2)};
}

double critical_stiffness(const Plant& plant, double period_s, double delay_s) {
    const DelayedLoop loop = build_loop(plant, period_s, delay_s);
    const auto is_unstable = [&](double K) { return loop_radius(loop, K) > 1 + 1e-12; };
    double stable = 0;
    for (double K = 1e-4; K < 1e7; K *= 1.01) {
        if (is_unstable(K)) {
            double unstable = K;
            for (int halving = 0; halving < 50; ++halving) {
                const double middle = 0.5 * (stable + unstable);
                (is_unstable(middle) ? unstable : stable) = middle;
            }
            return stable;
        }
        stable = K;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace palpa
