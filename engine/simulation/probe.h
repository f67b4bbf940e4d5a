// Moves what a hand holds along its line and returns the force there, for starts, strokes and
// figures, outside of any step. Without a hand given: the first one.
#pragma once
#include "ecs/world.h"
#include "field/pair_field.h"
#include "haptics/local_field.h"

#include <optional>

namespace palpa {

// Energy, force and stiffness of the environment on the held molecule along its line. Engine units.
struct LineForce {
    double energy = 0;     // kcal/mol
    double force = 0;      // kcal/mol/Å, positive towards +x
    double stiffness = 0;  // kcal/mol/Å^2, -d(force)/d(distance)
};

// True if the hand moves the held molecule in space, false along a line.
bool moves_in_space(const World& world, Entity hand = {}) noexcept;

// Position of the held molecule's reference atom, or of the hand's end of its spring (Å, world
// frame).
Vec3 grabbed_place(const World& world, Entity hand = {}) noexcept;

// Moves the held molecule's reference atom to this offset (Å) from its counterpart, with the given
// or the present orientation, or to this distance (Å) along its line. The distance is then reported
// even for a molecule beside the line. Molecules that move by themselves are not turned.
void place_grabbed(World& world, const MoleculePose& pose, Entity hand = {}) noexcept;
void place_grabbed(World& world, const Vec3& place, Entity hand = {}) noexcept;
void move_grabbed(World& world, double distance, Entity hand = {}) noexcept;
double grabbed_distance(const World& world, Entity hand = {}) noexcept;

// Field of the environment on the held molecule at its present position, and at `distance` (Å)
// along its line.
FieldSum field_on_grabbed(const World& world, Entity hand = {});
FieldSum field_on_grabbed_at(const World& world, double distance, Entity hand = {});

// The same, projected on the line.
LineForce force_along_line(const World& world, Entity hand = {});
LineForce force_along_line_at(const World& world, double distance, Entity hand = {});

// The largest distance (Å) at which the repulsion reaches `force` (kcal/mol/Å), to 1e-12 Å, between
// `outermost`, where it must be weaker, and 1 Å (-60 Å for a molecule in space). Nothing if there
// is none.
std::optional<double> repulsion_distance(const World& world, double force, double outermost,
                                         Entity hand = {});

// For a molecule on a line: the largest distance (Å), between 1 and 30 Å, where repulsion turns
// into attraction. For one in space: its pose at rest from loading.
std::optional<double> equilibrium_distance(const World& world, Entity hand = {});

}  // namespace palpa
