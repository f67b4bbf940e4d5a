// What hands hold and what is around it: questions to a world, never an order of its atom table.
#pragma once
#include "ecs/world.h"
#include "field/pair_field.h"
#include "simulation/components.h"
#include "simulation/resources.h"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

// Hands in the order of their devices.
std::vector<Entity> find_hands(const World& world);
// The world must have one.
Entity first_hand(const World& world);

// Of a hand that holds something.
const Grip& grip_of(const World& world, Entity hand) noexcept;
const Contact& contact_of(const World& world, Entity hand) noexcept;
// Of the first.
const LocalContactModel& local_contact_of(const World& world) noexcept;
LocalContactModel& local_contact_of(World& world) noexcept;

// Whether it holds a part of the mechanics, and no molecule that moves as one piece outside of
// them.
bool is_mobile(const Grip& grip) noexcept;

// The molecule that a hand holds, whole or at a spring; without atoms where it holds nothing.
AtomRange held_range(const World& world, Entity hand) noexcept;
// The spring by which it holds it, with the model's numbers of atoms; null: as a whole, or nothing.
const Spring* spring_of(const World& world, Entity hand) noexcept;
// The atoms that it holds: those at its spring, or all of the molecule.
std::vector<std::uint32_t> held_atoms(const World& world, Entity hand);

// Of a molecule, counted from its first: all.
std::vector<std::uint32_t> all_atoms_of(const World& world, Entity molecule);

// The same atoms, as the table numbers them.
std::vector<std::uint32_t> numbers_of(const World& world, const AtomsOf& atoms);

// Their centre of mass.
Vec3 middle_of(const World& world, const AtomsOf& atoms);

// Of a molecule, counted from its first: the atom "25 CA", all of residue "25" ("27A" with its
// insertion code), or its 17th atom, "#17". Nothing where there is none.
std::vector<std::uint32_t> atoms_called(const World& world, Entity molecule, std::string_view name);

// Of a hand that holds something: where the reference atom of that is, or its end of the spring (Å,
// in the world).
Vec3 held_place(const World& world, Entity hand) noexcept;

// Puts what it holds there, turned as the pose says: what is mobile only where the handle turns it.
void place_held(World& world, Entity hand, const MoleculePose& pose) noexcept;

// By mass; of massless atoms the first's place.
Vec3 centre_of_mass(const AtomTable& atoms, AtomRange range) noexcept;

// The table's columns of these atoms, as the pair kernel wants them.
FieldPoints points_of(const AtomTable& atoms, AtomRange range) noexcept;

// The same of atoms that do not stand beside each other.
struct GatheredPoints {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;
    std::vector<std::uint32_t> type;
    SolvationColumns solvation;

    GatheredPoints(const AtomTable& atoms, std::span<const std::uint32_t> numbers);
    FieldPoints view() const noexcept;
};

// The molecule in the hand, and the ranges of all other atoms.
FieldPoints held_points(const World& world, Entity hand) noexcept;
std::vector<AtomRange> environment_of(const World& world, Entity hand);
std::size_t count_environment(const World& world, Entity hand) noexcept;
PairRule pair_rule(const World& world) noexcept;

// What the environment does to the molecule in the hand, or to these points in its place; all pairs
// in double.
FieldSum field_on_held(const World& world, Entity hand);
FieldSum field_on(const World& world, Entity hand, const FieldPoints& group);

// From so many pairs on steps have them in single precision. Fewer take less than 0.1 ms in double
// (7 ns each on one core of an AMD EPYC), a tenth of the shortest period, so nothing is gained.
inline constexpr std::size_t fewest_fast_pairs = 10'000;

// Whether steps have them so, of a molecule that a hand moves as one piece outside of the
// mechanics: always in double where the scene has `statics.pairs = "double"`.
bool has_fast_pairs(const World& world, Entity hand) noexcept;

// What the environment does to it, as a step has it: by field/frozen_field.h or as above.
FieldSum fast_field_on_held(const World& world, Entity hand);

// Whether anything but the hand moves molecules.
bool has_mobile(const World& world) noexcept;
const TorsionModel& model_of(const World& world) noexcept;
const ModelAtoms& model_atoms_of(const World& world) noexcept;

// Of all atoms of the table, where mobile ones are as the model has them at angles of 0.
std::vector<Vec3> reference_positions(const World& world);

// Degrees of freedom that can move now.
std::size_t find_active_freedom(const World& world) noexcept;

// What pulls at the hand, kcal/mol/Å: that on the mobile molecule it moves, or its spring. Nothing
// where it holds nothing, or what moves as one piece outside of the mechanics; the next one too.
Vec3 find_force_on_held(const World& world, Entity hand) noexcept;
// Force and torque about the origin on the molecule that the hand moves, from all others.
Vec6 find_pull_on_held(const World& world, Entity hand) noexcept;

// Where everything mobile follows by second order and has a model; else null.
const SecondOrder* find_second_order(const World& world) noexcept;

// Energy of what is mobile, kcal/mol, without terms that are constant, and without what clients
// pull by.
double find_energy(const World& world) noexcept;

// The last error estimate of the force on the first hand, pN.
std::optional<double> find_error_estimate(const World& world) noexcept;

// The places of atoms in the table, those that mechanics have changed since they were written the
// last time.
void copy_positions(World& world);

}  // namespace palpa
