// Finds what hands hold and what is around it; takes, shapes and moves it.
#pragma once
#include "ecs/world.h"
#include "field/pair_field.h"
#include "simulation/components.h"
#include "simulation/resources.h"
#include "statics/torsion_state.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace palpa {

// Hands in the order of their devices.
std::vector<Entity> find_hands(const World& world);
// The hand of this number, from 0; none where the world has fewer.
Entity hand_at(const World& world, std::size_t number);

// The grip of a hand that holds something.
const Grip& grip_of(const World& world, Entity hand) noexcept;
const Contact& contact_of(const World& world, Entity hand) noexcept;
// The last contact model of the hand of this number.
const LocalContactModel& contact_at(const World& world, std::size_t number);
const Coupling& coupling_of(const World& world, Entity hand) noexcept;

// True if the hand holds a part of the mechanics, false for a rigid molecule outside of them.
bool is_mobile(const World& world, Entity hand) noexcept;
// True if it holds a molecule as a whole, false for atoms at a spring.
bool holds_whole(const World& world, Entity hand) noexcept;
// Adds the hand's spring to these atoms; k in kcal/mol/Å^2.
void hold_by_spring(World& world, Entity hand, AtomsOf atoms, double k);
// The atoms at its spring, or all of the molecule.
AtomsOf held_part_of(const World& world, Entity hand);
// The molecule, or the spring, of the mechanics that the hand moves.
HeldInState held_in_state(const World& world, Entity hand) noexcept;

// Atoms of the molecule that a hand holds, as a whole or at a spring; empty if it holds nothing.
AtomRange held_range(const World& world, Entity hand) noexcept;
// The spring of the hand, with atom numbers of the model; null if it holds a molecule as a whole,
// or nothing.
const ModelSpring* spring_of(const World& world, Entity hand) noexcept;
// The held atoms: those at its spring, or all of the molecule.
std::vector<std::uint32_t> held_atoms(const World& world, Entity hand);

// A null entity if no molecule has that name.
Entity molecule_called(const World& world, std::string_view name) noexcept;

// All atoms of a molecule, counted from its first.
std::vector<std::uint32_t> all_atoms_of(const World& world, Entity molecule);

// Indices of the same atoms in the table.
std::vector<std::uint32_t> numbers_of(const World& world, const AtomsOf& atoms);

// The centre of mass of these atoms.
Vec3 middle_of(const World& world, const AtomsOf& atoms);

// The atoms with this name, counted from the molecule's first: the atom "25 CA", all of residue
// "25" ("27A" with its insertion code), or its 17th atom, "#17". Empty if there is none.
std::vector<std::uint32_t> atoms_called(const World& world, Entity molecule, std::string_view name);

// The rotation of a molecule about its reference atom since it was loaded. A molecule that a hand
// holds as a whole outside of the mechanics has it in the pose of the grip instead.
Quat orientation_of(const World& world, Entity molecule);

// Makes a molecule rigid at its present position, which is turned by `orientation` from the shape
// as loaded.
void set_shape(World& world, Entity molecule, const Quat& orientation = Quat::Identity());

// Position of the held molecule's reference atom, or of the hand's end of the spring (Å, world
// frame). The hand must hold something.
Vec3 held_place(const World& world, Entity hand) noexcept;

// Moves what the hand holds to this pose; a mobile molecule is turned only if the handle turns it.
void place_held(World& world, Entity hand, const MoleculePose& pose) noexcept;

// The centre of mass; for atoms without mass the position of the first one.
Vec3 centre_of_mass(const AtomTable& atoms, AtomRange range) noexcept;

// The columns of the table for these atoms, as the pair kernel needs them.
FieldPoints points_of(const AtomTable& atoms, AtomRange range) noexcept;

// The same for atoms that are not adjacent in the table.
struct GatheredPoints {
    std::vector<Vec3> positions;
    std::vector<double> charge, sqrt_epsilon, half_rmin;
    std::vector<std::uint32_t> type;
    // Empty without implicit solvent.
    std::vector<double> volume, strength, inverse_lambda, radius;

    GatheredPoints(const AtomTable& atoms, std::span<const std::uint32_t> numbers);
    FieldPoints view() const noexcept;
};

// The held molecule, and the ranges of all other atoms.
FieldPoints held_points(const World& world, Entity hand) noexcept;
std::vector<AtomRange> environment_of(const World& world, Entity hand);
std::size_t count_environment(const World& world, Entity hand) noexcept;
PairRule pair_rule(const World& world) noexcept;

// Energy, force and derivatives of the environment's field on the held molecule, or on these points
// in its place; all pairs in double precision.
FieldSum field_on_held(const World& world, Entity hand);
FieldSum field_on(const World& world, Entity hand, const FieldPoints& group);

// From this number of pairs on, steps compute them in single precision. Fewer pairs take less than
// 0.1 ms in double (7 ns each on one core of an AMD EPYC), a tenth of the shortest period.
inline constexpr std::size_t fewest_fast_pairs = 10'000;

// True if steps compute the pairs of this rigid molecule outside of the mechanics in single
// precision. Always false with `statics.pairs = "double"` in the scene.
bool has_fast_pairs(const World& world, Entity hand) noexcept;

// The same field as a step computes it: by field/frozen_field.h or in double as above.
FieldSum fast_field_on_held(const World& world, Entity hand);

// True if anything but hands moves molecules.
bool has_mobile(const World& world) noexcept;
const TorsionModel& model_of(const World& world) noexcept;
const ModelAtoms& model_atoms_of(const World& world) noexcept;

// Positions of all atoms of the table; mobile ones as in the model with all joint angles 0.
std::vector<Vec3> reference_positions(const World& world);

}  // namespace palpa
