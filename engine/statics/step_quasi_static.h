// The quasi-static step: joints and bases move along their accelerations from rest as long as the
// energy falls.
#pragma once
#include "assembly/passes.h"
#include "math/minimiser.h"
#include "statics/torsion_state.h"

#include <cmath>

namespace palpa {

inline constexpr double longest_h = 10;  // AKMA time

struct QuasiStaticSettings {
    ForceSettings forces;
    double first_h = 0.2;        // AKMA time, 48.888 fs
    double growth = 1.2;         // factor of h after a step that is taken
    double shrinkage = 0.5;      // factor of h after a step that would raise the energy
    double largest_move = 0.05;  // limit for each atom, Å
};

// State that steps carry over from one to the next.
struct QuasiStatics {
    ForceMemory memory;
    AssemblyState assembly;
    TorsionState trial;
    Coordinates move;
    double h = 0;          // AKMA time; 0 before the first step
    CurvaturePairs pairs;  // for the minimisers (relax_joints.h)
};

QuasiStatics build_quasi_statics(const TorsionModel& model);

struct [[nodiscard]] QuasiStaticReport {
    bool is_taken = false;     // if false, nothing has moved
    bool is_finite = true;     // forces and accelerations are finite
    bool is_bounded = false;   // the largest move limited the step, not h
    double energy_change = 0;  // kcal/mol, of the attempted step
    double largest_move = 0;   // displacement of the farthest atom, Å
};

// Moves by q += h^2/2 q'', with accelerations from the forces of the state; a base turns by the
// exponential map about its pivot. A step that would raise the energy is not taken and halves h.
// (S. Redon et al., ACM Trans. Graph. 24, 936 (2005), describe the dynamics; here every step starts
// from rest.) Afterwards the state has its positions and forces, but not its coordinate forces.
// In double precision no step raises the energy. Fast pairs round it; for changes smaller than that
// rounding the forces at both ends decide.
QuasiStaticReport step_quasi_static(const TorsionModel& model, const QuasiStaticSettings& settings,
                                    TorsionState& state, QuasiStatics& statics);

// Accelerations of all coordinates under the forces on atoms that the state holds.
void update_coordinate_accelerations(const TorsionModel& model, const TorsionState& state,
                                     AssemblyState& assembly, Coordinates& accelerations) noexcept;

// The same for forces along the coordinates: the inverse of the mass matrix times them.
void multiply_by_inverse_mass(const TorsionModel& model, const TorsionState& state,
                              const Coordinates& coordinate_forces, AssemblyState& assembly,
                              Coordinates& accelerations) noexcept;

// The largest displacement of an atom, Å.
double find_largest_move(const std::vector<Vec3>& from, const std::vector<Vec3>& to) noexcept;
// The same for these atoms only.
double find_largest_move(std::span<const std::uint32_t> atoms, const std::vector<Vec3>& from,
                         const std::vector<Vec3>& to) noexcept;

// Moves `trial` from the coordinates of `from` by `move`, scaled down so that no atom moves farther
// than the largest move; `move` becomes the actual one. Returns the displacement of the farthest
// atom.
double place_within(const TorsionModel& model, const TorsionState& from, double largest_move,
                    Coordinates& move, TorsionState& trial) noexcept;

// Updates the points about which guided bases turn.
void guide_pivots(const TorsionModel& model, const TorsionState& state,
                  AssemblyState& assembly) noexcept;

// The sum of the absolute terms of the energy, to which its rounding is proportional (kcal/mol).
double sum_of_terms(const TorsionState& state) noexcept;

// Fast pairs round the energy, a sum of terms of known magnitude. For a change below that rounding
// the work of the forces along the move, `find_work()`, decides.
template <class FindWork>
bool is_energy_lower(const ForceSettings& settings, double magnitude, double change,
                     const FindWork& find_work) noexcept {
    // Five times the typical rounding of fast pairs, measured for 22 and 3,275 atoms.
    const double rounding = 3e-7 * magnitude;
    if (!settings.fast || std::abs(change) > rounding) return change <= 0;
    return find_work() >= 0;
}

// True if the energy is lower at `to`, which is `move` away from `from`; both need their forces,
// and with fast pairs also coordinate forces.
bool is_lower(const ForceSettings& settings, const TorsionState& from, const TorsionState& to,
              const Coordinates& move) noexcept;

}  // namespace palpa
