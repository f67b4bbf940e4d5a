// Places the grabbed molecule along its line and asks for the force there: for starts, strokes and
// figures, outside of any step.
#pragma once
#include "simulation/simulation.h"

#include <optional>

namespace palpa {

// What the environment does to the grabbed molecule along its line. Engine units.
struct LineForce {
    double energy = 0;     // kcal/mol
    double force = 0;      // kcal/mol/Å, + pushes away
    double stiffness = 0;  // kcal/mol/Å^2, -d(force)/d(distance)
};

// Where the grabbed molecule's reference atom is (Å, in the world).
Vec3 grabbed_place(const Simulation& simulation) noexcept;

// Puts the grabbed molecule's reference atom at that distance (Å) along its line.
void move_grabbed(Simulation& simulation, double distance) noexcept;

// The force where the grabbed molecule stands, and where it would stand at `distance` (Å).
LineForce force_along_line(const Simulation& simulation) noexcept;
LineForce force_along_line_at(const Simulation& simulation, double distance);

// The outermost distance (Å) at which the repulsion reaches `force` (kcal/mol/Å), to 1e-12 Å, if
// it does so between 1 Å and `outermost`, where it must be weaker.
std::optional<double> repulsion_distance(const Simulation& simulation, double force,
                                         double outermost);

// The outermost distance (Å) where repulsion turns into attraction, between 1 and 30 Å.
std::optional<double> equilibrium_distance(const Simulation& simulation);

}  // namespace palpa
