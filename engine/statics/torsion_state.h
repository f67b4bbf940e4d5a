// The state of a torsion model: coordinates, positions, energies and forces.
#pragma once
#include "forces/force_field.h"
#include "forces/pair_list.h"
#include "math/rigid_motion.h"
#include "math/spatial.h"
#include "statics/springs.h"
#include "statics/torsion_model.h"

#include <cstddef>
#include <vector>

namespace palpa {

// How forces are computed. Everything except fast pairs is in double precision, as the reference.
struct ForceSettings {
    NonbondedSettings nonbonded;  // pairs are listed if both energies have a cutoff
    bool fast = false;            // pairs in single precision (forces/fast_nonbonded.h)
    double skin = 2;              // skin of the neighbour list, Å
    std::size_t threads = 1;
};

// True if the single-precision kernel computes the pairs; false for schemes that it does not
// support.
bool is_fast(const ForceSettings& settings) noexcept;

// Neighbour lists reused between evaluations, for any states.
struct ForceMemory {
    PairList list;
    FastPairs fast_pairs;
    std::size_t evaluations = 0;
};

struct TorsionState {
    // Coordinates. The pose of a base is its reference, turned by `turns`, then moved by `shifts`.
    std::vector<double> angles;             // angle of each body's joint, rad; 0 for bases
    std::vector<Eigen::Quaterniond> turns;  // of each molecule
    std::vector<Vec3> shifts;               // of each molecule, Å
    std::vector<ModelSpring> springs;       // set by the caller: springs of hands and restraints

    // update_positions
    std::vector<RigidMotion> motions;  // motion of each body from its reference
    std::vector<Vec3> positions;       // Å; fixed atoms stay at the reference
    std::vector<Vec3> pivots;          // of each molecule, Å: point about which its base turns

    // update_forces
    EnergyTerms terms;         // without constant terms
    double spring_energy = 0;  // kcal/mol
    std::vector<Vec3> forces;  // kcal/mol/Å

    // update_coordinate_forces
    std::vector<Vec6>
        wrenches;  // of each body with all its descendants, about the origin; not for fixed ones
    Coordinates coordinate_forces;  // kcal/mol/rad, kcal/mol/Å

    double energy() const noexcept { return terms.total() + spring_energy; }
    std::size_t count_bytes() const noexcept;  // memory
};

// The state at the reference; only positions are computed.
TorsionState build_torsion_state(const TorsionModel& model);

// Computes positions from coordinates; bond lengths stay exact after any number of steps.
void update_positions(const TorsionModel& model, TorsionState& state) noexcept;

// The same for marked molecules only; the others must be up to date.
void update_positions(const TorsionModel& model, std::span<const std::uint8_t> is_changed,
                      TorsionState& state) noexcept;

// Computes the pivots from the positions.
void update_pivots(const TorsionModel& model, TorsionState& state) noexcept;

// Adds the force field's forces on all atoms to `forces`, one entry per atom, and returns its
// energies. Allocates where a list has to be built.
EnergyTerms add_model_forces(const TorsionModel& model, const ForceSettings& settings,
                             ForceMemory& memory, std::span<const Vec3> positions,
                             std::span<Vec3> forces);

// Computes energy and forces on atoms, including springs.
void update_forces(const TorsionModel& model, const ForceSettings& settings, ForceMemory& memory,
                   TorsionState& state);

// Computes the forces along each coordinate, the negative gradient of the energy, from the forces
// on atoms.
void update_coordinate_forces(const TorsionModel& model, TorsionState& state) noexcept;

// Adds `move` to the coordinates and updates the positions.
void add_move(const TorsionModel& model, const Coordinates& move, TorsionState& state) noexcept;

// Displaces a base without turning it; the whole molecule moves.
void shift_base(const TorsionModel& model, std::size_t molecule, const Vec3& by,
                TorsionState& state) noexcept;

// Turns a base about its pivot, then displaces it (Å). The whole molecule moves.
void turn_base(const TorsionModel& model, std::size_t molecule, const Eigen::Quaterniond& turn,
               const Vec3& by, TorsionState& state) noexcept;

// Force and torque about the origin on a molecule, from the forces on its atoms; internal forces
// cancel.
Vec6 find_wrench_on(const TorsionModel& model, const TorsionState& state,
                    std::size_t molecule) noexcept;

// Copies coordinates and positions only.
void copy_coordinates(const TorsionState& from, TorsionState& to) noexcept;

// Swaps coordinates and positions.
void swap_coordinates(TorsionState& a, TorsionState& b) noexcept;

// Swaps energies, forces and coordinate forces as well.
void take_over(TorsionState& from, TorsionState& to) noexcept;

// The part of a state that a hand holds: a molecule of the torsion model, or a spring by its index.
struct HeldInState {
    std::uint32_t base = 0;
    std::int32_t spring = -1;  // -1: none
};

// The force on the molecule, or on the hand's end of its spring; the state must have all forces.
Vec3 find_force_on_held(const TorsionModel& model, const TorsionState& state,
                        const HeldInState& held) noexcept;

}  // namespace palpa
