#include "simulation/probe.h"

#include "core/assertion.h"
#include "simulation/components.h"

#include <cstddef>

namespace palpa {
namespace {

constexpr double innermost = 1.0, scan_step = 0.005;  // Å
// Forces weaker than this (kcal/mol/Å, 0.07 pN) far outside are no attraction.
constexpr double negligible = 1e-3;

// The distance between `inside` (force above `level`) and `outside` (below) where it passes.
double bisect(const Simulation& simulation, double level, double inside, double outside) {
    while (outside - inside > 1e-12) {
        const double middle = 0.5 * (inside + outside);
        const bool above = force_along_line_at(simulation, middle).force > level;
        (above ? inside : outside) = middle;
    }
    return 0.5 * (inside + outside);
}

}  // namespace

Vec3 grabbed_place(const Simulation& simulation) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Molecule* const grabbed = simulation.world.find<Molecule>(grab->molecule);
    return simulation.atoms.positions[grabbed->reference_atom];
}

void move_grabbed(Simulation& simulation, double distance) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Molecule* const origin = simulation.world.find<Molecule>(grab->measured_from);
    const Molecule* const grabbed = simulation.world.find<Molecule>(grab->molecule);
    LineGuide* const guide = simulation.world.find<LineGuide>(grab->molecule);
    guide->distance = distance;
    const Vec3 place = simulation.atoms.positions[origin->reference_atom] + distance * guide->axis;
    for (std::size_t i = 0; i < simulation.grabbed_shape.size(); ++i) {
        simulation.atoms.positions[grabbed->atoms.first + i] = place + simulation.grabbed_shape[i];
    }
}

LineForce force_along_line(const Simulation& simulation) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Vec3& axis = simulation.world.find<LineGuide>(grab->molecule)->axis;
    const FieldSum field = evaluate_pair_field(
        grabbed_points(simulation), environment_points(simulation), simulation.coulomb_constant);
    return {field.energy(), field.force.dot(axis), axis.dot(field.stiffness * axis)};
}

LineForce force_along_line_at(const Simulation& simulation, double distance) {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Molecule* const origin = simulation.world.find<Molecule>(grab->measured_from);
    const Vec3& axis = simulation.world.find<LineGuide>(grab->molecule)->axis;
    const Vec3 place = simulation.atoms.positions[origin->reference_atom] + distance * axis;
    std::vector<Vec3> positions;
    for (const Vec3& offset : simulation.grabbed_shape) positions.push_back(place + offset);
    FieldPoints moved = grabbed_points(simulation);
    moved.positions = positions;
    const FieldSum field =
        evaluate_pair_field(moved, environment_points(simulation), simulation.coulomb_constant);
    return {field.energy(), field.force.dot(axis), axis.dot(field.stiffness * axis)};
}

std::optional<double> repulsion_distance(const Simulation& simulation, double force,
                                         double outermost) {
    if (force_along_line_at(simulation, outermost).force > force) return std::nullopt;
    for (double distance = outermost; distance > innermost; distance -= scan_step) {
        if (force_along_line_at(simulation, distance).force > force) {
            return bisect(simulation, force, distance, distance + scan_step);
        }
    }
    return std::nullopt;
}

std::optional<double> equilibrium_distance(const Simulation& simulation) {
    bool attracted = false;
    for (double distance = 30; distance > innermost; distance -= scan_step) {
        const double force = force_along_line_at(simulation, distance).force;
        if (force < -negligible) attracted = true;
        if (attracted && force > 0) return bisect(simulation, 0, distance, distance + scan_step);
    }
    return std::nullopt;
}

}  // namespace palpa
