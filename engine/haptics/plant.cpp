#include "haptics/plant.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

namespace palpa {
namespace {

// Largest |eigenvalue| of the loop; its states are the plant's and the force under way.
double loop_radius(const SampledPlant& plant, double K) {
    const Eigen::Index n = plant.A.rows();
    Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(n + 1, n + 1);
    loop.topLeftCorner(n, n) = plant.A;
    loop.topRightCorner(n, 1) = plant.B.col(0);
    loop(n, 0) = -K;
    return loop.eigenvalues().cwiseAbs().maxCoeff();
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

double find_critical_stiffness(const Plant& plant, double period_s) {
    const SampledPlant sampled = sample_plant(plant, period_s);
    const auto is_unstable = [&](double K) { return loop_radius(sampled, K) > 1 + 1e-12; };
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
