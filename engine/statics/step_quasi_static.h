// The quasi-static step: joints and bases go where they would accelerate to from rest, as long as
// the energy falls.
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
    double growth = 1.2;         // of h where a step was taken
    double shrinkage = 0.5;      // of h where it would have raised the energy
    double largest_move = 0.05;  // of any atom, Å
};

// What steps remember from one to the next.
struct QuasiStatics {
    ForceMemory memory;
    AssemblyState assembly;
    TorsionState trial;
    Coordinates move;
    double h = 0;          // AKMA time; 0 before the first step
    CurvaturePairs pairs;  // of the minimisers (relax_joints.h)
};

QuasiStatics build_quasi_statics(const TorsionModel& model);

struct [[nodiscard]] QuasiStaticReport {
    bool is_taken = false;     // else nothing has moved
    bool is_finite = true;     // forces and accelerations
    bool is_bounded = false;   // the largest move decided how far, not h
    double energy_change = 0;  // kcal/mol, of the step that was tried
    double largest_move = 0;   // of any atom, Å
};

// q += h^2/2 q'', the accelerations those of the forces that the state holds; a base turns by the
// exponential map about its pivot. A step that would raise the energy is not taken and halves h.
// (S. Redon et al., ACM Trans. Graph. 24, 936 (2005), for the dynamics; a step from rest is here
// the whole of it.) In the end the state has its positions and forces, coordinate forces not.
//
// In double no step that is taken raises the energy. Fast pairs round it; where the energy
// changes by less than that, the forces at both ends tell whether it falls.
QuasiStaticReport step_quasi_static(const TorsionModel& model, const QuasiStaticSettings& settings,
                                    TorsionState& state, QuasiStatics& statics);

// Accelerations of all coordinates under the forces on atoms that the state holds.
void update_coordinate_accelerations(const TorsionModel& model, const TorsionState& state,
                                     AssemblyState& assembly, Coordinates& accelerations) noexcept;

// The same under forces along the coordinates: the inverse of the mass matrix times them.
void multiply_by_inverse_mass(const TorsionModel& model, const TorsionState& state,
                              const Coordinates& coordinate_forces, AssemblyState& assembly,
                              Coordinates& accelerations) noexcept;

// The largest distance between places of one atom, Å.
double find_largest_move(const std::vector<Vec3>& from, const std::vector<Vec3>& to) noexcept;
// Of these atoms.
double find_largest_move(std::span<const std::uint32_t> atoms, const std::vector<Vec3>& from,
                         const std::vector<Vec3>& to) noexcept;

// Moves `trial` from where `from` is by `move`, or by so much less that no atom goes farther than
// the largest move; `move` becomes what was done. Returns how far the farthest atom went.
double place_within(const TorsionModel& model, const TorsionState& from, double largest_move,
                    Coordinates& move, TorsionState& trial) noexcept;

// Where the points are that guided bases turn about.
void guide_pivots(const TorsionModel& model, const TorsionState& state,
                  AssemblyState& assembly) noexcept;

// Fast pairs round the energy, the sum of terms of some magnitude; for a change that is smaller
// than that rounding the work of the forces along the move, `find_work()`, decides.
template <class FindWork>
bool is_energy_lower(const ForceSettings& settings, double magnitude, double change,
                     const FindWork& find_work) noexcept {
    // A fifth of that is what fast pairs round as a rule, of 22 atoms and of 3,275.
    const double rounding = 3e-7 * magnitude;
    if (!settings.fast || std::abs(change) > rounding) return change <= 0;
    return find_work() >= 0;
}

// Whether energy is lower at `to`, `move` away from `from`; both have their forces, `to` and
// `from` coordinate forces too where pairs are fast.
bool is_lower(const ForceSettings& settings, const TorsionState& from, const TorsionState& to,
              const Coordinates& move) noexcept;

}  // namespace palpa
