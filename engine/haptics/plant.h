// Device and hand along one axis as a linear system, and when a delayed spring makes it unstable.
#pragma once
#include "haptics/hand.h"

#include <Eigen/Core>
#include <optional>

namespace palpa {

// The moving parts of a device along one axis.
struct DeviceDynamics {
    double inertia_kg = 0.045;
    double viscosity_N_s_per_m = 0.1;
};

// At most four states, never on the heap: handle position and velocity; with a grip, those of the
// hand as well.
using PlantMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
using PlantInputs = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, 4, 2>;
using PlantState = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;

// d(state)/dt = A state + B inputs. Inputs: force on the handle (N), and what pulls the hand to
// its target, stiffness * target + damping * target velocity (N).
struct Plant {
    PlantMatrix A;
    PlantInputs B;
    double handle_mass_kg = 0;  // mass that moves rigidly with the handle
};

Plant build_plant(const DeviceDynamics& device, const std::optional<HandModel>& hand);

// The same in steps of `period_s` with inputs held in between: state' = A state + B inputs, exact.
struct SampledPlant {
    PlantMatrix A;
    PlantInputs B;
};

SampledPlant sample_plant(const Plant& plant, double period_s);

// The largest spring K (N/m) felt at the handle that the paper's loop keeps stable: position
// sampled every `period_s`, force -K x sent one period and `delay_s` later and held (z^-1 and
// hold). K = A_f k_e / A_d. Found as the first K for which an eigenvalue of the sampled loop leaves
// the unit circle; infinity if none below 1e7 N/m does.
double critical_stiffness(const Plant& plant, double period_s, double delay_s = 0);

// Eq. 1 of the paper, A_f k_e / A_d < M_h / T_s^2, as a bound of K (N/m). It knows neither damping
// nor hand, and allows loops that vibrate (critical_stiffness).
inline double stiffness_of_equation_1(const DeviceDynamics& device, double period_s) noexcept {
    return device.inertia_kg / (period_s * period_s);
}

}  // namespace palpa
