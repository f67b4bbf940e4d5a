// Where the bodies of a torsion model are, and what pulls at its coordinates.
#pragma once
#include "forces/force_field.h"
#include "forces/pair_list.h"
#include "math/rigid_motion.h"
#include "math/spatial.h"
#include "statics/torsion_model.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// How forces are summed. Everything but the fast pairs is in double, the slow twin.
struct ForceSettings {
    NonbondedSettings nonbonded;  // pairs are listed where both energies end at a cutoff
    bool fast = false;            // pairs in single precision (forces/fast_nonbonded.h)
    double skin = 2;              // of the list, Å
    std::size_t threads = 1;
};

// Whether the kernel has them: not for what single precision cannot do.
bool is_fast(const ForceSettings& settings) noexcept;

// A spring from the centre of mass of some atoms to a place: the hand on them. E = k |x -
// place|^2/2.
struct Tether {
    std::vector<std::uint32_t> atoms;
    double k = 0;               // kcal/mol/Å^2
    Vec3 place = Vec3::Zero();  // Å
};

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
    std::optional<Tether> tether;

    // update_positions
    std::vector<RigidMotion> motions;  // of each body from its reference
    std::vector<Vec3> positions;       // Å
    std::vector<Vec3> pivots;          // of each molecule, Å: where its base turns about

    // update_forces
    EnergyTerms terms;         // without those that are constant
    double tether_energy = 0;  // kcal/mol
    std::vector<Vec3> forces;  // kcal/mol/Å

    // update_coordinate_forces
    std::vector<Vec6> wrenches;     // of each body with all behind it, about the origin
    Coordinates coordinate_forces;  // kcal/mol/rad, kcal/mol/Å

    double energy() const noexcept { return terms.total() + tether_energy; }
};

// At the reference; nothing is evaluated yet but positions.
TorsionState build_torsion_state(const TorsionModel& model);

// Positions from coordinates: no bond gets longer, however many steps there were.
void update_positions(const TorsionModel& model, TorsionState& state) noexcept;

// From the positions.
void update_pivots(const TorsionModel& model, TorsionState& state) noexcept;

// Energy and forces on atoms. Allocates where a list has to be built.
void update_forces(const TorsionModel& model, const ForceSettings& settings, ForceMemory& memory,
                   TorsionState& state);

// What the forces on atoms do along each coordinate: the negative gradient of the energy.
void update_coordinate_forces(const TorsionModel& model, TorsionState& state) noexcept;

// Changes the coordinates, and with them the positions.
void add_move(const TorsionModel& model, const Coordinates& move, TorsionState& state) noexcept;

// Moves a base by hand, without turning it; the whole molecule goes with it.
void shift_base(const TorsionModel& model, std::size_t molecule, const Vec3& by,
                TorsionState& state) noexcept;

// The centre of mass of the tether's atoms, Å.
Vec3 find_tethered(const TorsionModel& model, const Tether& tether,
                   std::span<const Vec3> positions) noexcept;

// Puts the coordinates and positions of `from` into `to`, nothing else.
void copy_coordinates(const TorsionState& from, TorsionState& to) noexcept;

// The same with energies, forces and coordinate forces.
void take_over(TorsionState& from, TorsionState& to) noexcept;

}  // namespace palpa
