// Flexible molecules to rest, all joints at once.
#pragma once
#include "core/choices.h"
#include "statics/step_quasi_static.h"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace palpa {

// Root of the mean square; 0 of none.
double rms_of(const Coordinates& values) noexcept;

struct RelaxSettings {
    RelaxMethod method = RelaxMethod::InverseMass;
    QuasiStaticSettings step;   // forces of all methods, the rest of QuasiStatic
    double largest_move = 0.3;  // of any atom in one step of the other methods, Å
    double force_tolerance =
        0.01;                  // rms over the coordinates, kcal/mol/rad and kcal/mol/Å: the end
    std::size_t steps = 2000;  // at most
    bool keeps_pairs = false;  // curvature pairs of the call before still hold
    // Multiplies forces along the coordinates by an inverse Hessian that the caller knows; empty:
    // as the method has it.
    std::function<Coordinates(const Coordinates&)> precondition = {};
};

enum class RelaxEnd : std::uint8_t {
    Converged,  // the tolerance is reached
    Steps,      // there were no more steps, or `on_step` wanted none
    Stuck,      // nothing lowers the energy by more than rounding
    NotFinite,  // energy or forces where it is
};

struct [[nodiscard]] JointRelaxReport {
    double energy_before = 0, energy_after = 0;  // kcal/mol, without terms that are constant
    double rms_force = 0;                        // at the end
    std::size_t steps = 0;                       // taken
    std::size_t evaluations = 0;                 // of the forces
    double largest_move = 0;                     // of any atom from where it started, Å
    RelaxEnd end = RelaxEnd::Steps;
};

struct RelaxProgress {
    std::size_t step;
    double energy, rms_force;
};

// Until nothing pulls at the coordinates by more than the tolerance. The energy never rises from
// step to step, but by what fast pairs round. In the end the state has its positions, forces and
// coordinate forces. `on_step` may be empty; where it returns false the way ends.
JointRelaxReport relax_joints(const TorsionModel& model, const RelaxSettings& settings,
                              TorsionState& state, QuasiStatics& statics,
                              const std::function<bool(const RelaxProgress&)>& on_step = {});

}  // namespace palpa
