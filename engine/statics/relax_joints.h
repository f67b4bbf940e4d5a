// Relaxes flexible molecules, all joints at once.
#pragma once
#include "core/choices.h"
#include "statics/step_quasi_static.h"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace palpa {

// Root mean square; 0 for an empty vector.
double rms_of(const Coordinates& values) noexcept;

struct RelaxSettings {
    RelaxMethod method = RelaxMethod::SecondOrder;  // L-BFGS over the mass matrix
    QuasiStaticSettings step;   // force settings for both methods; the rest for QuasiStatic
    double largest_move = 0.3;  // largest move of an atom in a step of L-BFGS, Å
    double force_tolerance =
        0.01;                  // tolerance: rms over the coordinates, kcal/mol/rad and kcal/mol/Å
    std::size_t steps = 2000;  // largest number of steps
    // Multiplies forces along the coordinates by an approximate inverse Hessian of the caller;
    // empty: by the inverse mass matrix.
    std::function<Coordinates(const Coordinates&)> precondition = {};
};

enum class RelaxEnd : std::uint8_t {
    Converged,  // the tolerance is reached
    Steps,      // the number of steps is used up, or `on_step` returned false
    Stuck,      // no step lowers the energy or, where its change is below rounding, the forces
    NotFinite,  // energy or forces are not finite
};

struct [[nodiscard]] JointRelaxReport {
    double energy_before = 0, energy_after = 0;  // kcal/mol, without terms that are constant
    double rms_force = 0;                        // at the end
    std::size_t steps = 0;                       // steps taken
    std::size_t evaluations = 0;                 // evaluations of the forces
    double largest_move = 0;  // largest displacement of an atom from its start, Å
    RelaxEnd end = RelaxEnd::Steps;
};

struct RelaxProgress {
    std::size_t step;
    double energy, rms_force;
};

// Relaxes until the rms force along the coordinates is below the tolerance. The energy never rises
// from step to step, except by rounding. At the end the state has its positions,
// forces and coordinate forces. `on_step` may be empty; if it returns false, relaxation ends.
JointRelaxReport relax_joints(const TorsionModel& model, const RelaxSettings& settings,
                              TorsionState& state, QuasiStatics& statics,
                              const std::function<bool(const RelaxProgress&)>& on_step = {});

}  // namespace palpa
