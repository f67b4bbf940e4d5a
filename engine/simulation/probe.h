// Places what a hand holds along its line and asks for the force there: for starts, strokes and
// figures, outside of any step. The first hand, where none is named.
#pragma once
#include "ecs/world.h"
#include "field/pair_field.h"
#include "haptics/local_field.h"

#include <optional>

namespace palpa {

// What the environment does to the grabbed molecule along its line. Engine units.
struct LineForce {
    double energy = 0;     // kcal/mol
    double force = 0;      // kcal/mol/Å, + pushes to +x
    double stiffness = 0;  // kcal/mol/Å^2, -d(force)/d(distance)
};

// Whether the hand moves the grabbed molecule in space, not along a line.
bool moves_in_space(const World& world, Entity hand = {}) noexcept;

// Where the grabbed molecule's reference atom is, or the hand's end of the spring that holds it (Å,
// in the world).
Vec3 grabbed_place(const World& world, Entity hand = {}) noexcept;

// Puts the grabbed molecule's reference atom at that place (Å) from its counterpart's, turned about
// it as given or as it is, or at that distance (Å) along its line; and reports the distance,
// wherever beside the line it is. What moves by itself is not turned.
void place_grabbed(World& world, const MoleculePose& pose, Entity hand = {}) noexcept;
void place_grabbed(World& world, const Vec3& place, Entity hand = {}) noexcept;
void move_grabbed(World& world, double distance, Entity hand = {}) noexcept;
double grabbed_distance(const World& world, Entity hand = {}) noexcept;

// What the environment does to the grabbed molecule where it stands, and where it would stand at
// `distance` (Å) along its line.
FieldSum field_on_grabbed(const World& world, Entity hand = {});
FieldSum field_on_grabbed_at(const World& world, double distance, Entity hand = {});

// The same along the line.
LineForce force_along_line(const World& world, Entity hand = {});
LineForce force_along_line_at(const World& world, double distance, Entity hand = {});

// The outermost distance (Å) at which the repulsion reaches `force` (kcal/mol/Å), to 1e-12 Å, if
// it does so between `outermost`, where it must be weaker, and 1 Å; for a molecule in space -60 Å.
std::optional<double> repulsion_distance(const World& world, double force, double outermost,
                                         Entity hand = {});

// Of a molecule on a line, the outermost distance (Å) where repulsion turns into attraction,
// between 1 and 30 Å. One in space has its place of rest from loading.
std::optional<double> equilibrium_distance(const World& world, Entity hand = {});

}  // namespace palpa
