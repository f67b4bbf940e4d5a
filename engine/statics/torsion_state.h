// Where the bodies of a torsion model are, and what pulls at its coordinates.
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

// How forces are summed. Everything but the fast pairs is in double, the reference implementation.
struct ForceSettings {
    NonbondedSettings nonbonded;  // pairs are listed where both energies end at a cutoff
    bool fast = false;            // pairs in single precision (forces/fast_nonbonded.h)
    double skin = 2;              // of the list, Å
    std::size_t threads = 1;
};

// Whether the kernel has them: not for what single precision cannot do.
bool is_fast(const ForceSettings& settings) noexcept;

// Lists of pairs from one evaluation to the next, whatever states they are of.
struct ForceMemory {
    PairList list;
    FastPairs fast_pairs;
    std::size_t evaluations = 0;
};

struct TorsionState {
    // The coordinates. A base has gone from its reference by its turn, then its shift.
    std::vector<double> angles;             // of each body's joint, rad; 0 of bases
    std::vector<Eigen::Quaterniond> turns;  // of each molecule
    std::vector<Vec3> shifts;               // of each molecule, Å
    std::vector<Spring> springs;            // the caller's: of hands, and restraints

    // update_positions
    std::vector<RigidMotion> motions;  // of each body from its reference
    std::vector<Vec3> positions;       // Å; of fixed atoms the reference
    std::vector<Vec3> pivots;          // of each molecule, Å: where its base turns about

    // update_forces
    EnergyTerms terms;         // without those that are constant
    double spring_energy = 0;  // kcal/mol
    std::vector<Vec3> forces;  // kcal/mol/Å

    // update_coordinate_forces
    std::vector<Vec6> wrenches;     // of each body with all behind it, about the origin; not fixed
    Coordinates coordinate_forces;  // kcal/mol/rad, kcal/mol/Å

    double energy() const noexcept { return terms.total() + spring_energy; }
};

// At the reference; nothing is evaluated yet but positions.
TorsionState build_torsion_state(const TorsionModel& model);

// Positions from coordinates: no bond gets longer, however many steps there were.
void update_positions(const TorsionModel& model, TorsionState& state) noexcept;

// Only of molecules that are marked; the others are where their coordinates say.
void update_positions(const TorsionModel& model, std::span<const std::uint8_t> is_changed,
                      TorsionState& state) noexcept;

// From the positions.
void update_pivots(const TorsionModel& model, TorsionState& state) noexcept;

// Adds the force field's forces on all atoms to `forces`, one entry per atom, and returns its
// energies. Allocates where a list has to be built.
EnergyTerms add_model_forces(const TorsionModel& model, const ForceSettings& settings,
                             ForceMemory& memory, std::span<const Vec3> positions,
                             std::span<Vec3> forces);

// Energy and forces on atoms, those of springs too.
void update_forces(const TorsionModel& model, const ForceSettings& settings, ForceMemory& memory,
                   TorsionState& state);

// What the forces on atoms do along each coordinate: the negative gradient of the energy.
void update_coordinate_forces(const TorsionModel& model, TorsionState& state) noexcept;

// Changes the coordinates, and with them the positions.
void add_move(const TorsionModel& model, const Coordinates& move, TorsionState& state) noexcept;

// Moves a base by hand, without turning it; the whole molecule goes with it.
void shift_base(const TorsionModel& model, std::size_t molecule, const Vec3& by,
                TorsionState& state) noexcept;

// Moves a base by hand: turns it about its pivot, then shifts it (Å). The whole molecule goes with
// it.
void turn_base(const TorsionModel& model, std::size_t molecule, const Eigen::Quaterniond& turn,
               const Vec3& by, TorsionState& state) noexcept;

// Force and torque about the origin on a molecule, from the forces on its atoms. What these do to
// each other adds up to nothing.
Vec6 find_wrench_on(const TorsionModel& model, const TorsionState& state,
                    std::size_t molecule) noexcept;

// Puts the coordinates and positions of `from` into `to`, nothing else.
void copy_coordinates(const TorsionState& from, TorsionState& to) noexcept;

// Exchanges them.
void swap_coordinates(TorsionState& a, TorsionState& b) noexcept;

// The same with energies, forces and coordinate forces.
void take_over(TorsionState& from, TorsionState& to) noexcept;

}  // namespace palpa
