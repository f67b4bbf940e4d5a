#include "simulation/probe.h"

#include "simulation/components.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace palpa {
namespace {

const Guide& grabbed_guide(const Simulation& simulation) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    return *simulation.world.find<Guide>(grab->molecule);
}

Vec3 place_on_line(const Simulation& simulation, double distance) noexcept {
    return grabbed_guide(simulation).line_origin + distance * Vec3::UnitX();
}

LineForce along_line(const FieldSum& field) noexcept {
    return {field.energy(), field.force.x(), field.stiffness(0, 0)};
}

// How far in a scan goes and how finely (Å). In space walls are of many atoms, and every look at
// them costs a thousand times more.
struct Scan {
    double innermost, step;
};

Scan scan_of(const Simulation& simulation) {
    return grabbed_guide(simulation).freedom == 1 ? Scan{1, 0.005} : Scan{-60, 0.05};
}

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

// The shortest distance between an atom in the hand and one of the others.
double distance_at(const Simulation& simulation, double distance) {
    const Vec3 by =
        simulation.anchor + place_on_line(simulation, distance) - grabbed_place(simulation);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& a : grabbed_points(simulation).positions) {
        for (const Vec3& b : environment_points(simulation).positions) {
            nearest = std::min(nearest, (a + by - b).squaredNorm());
        }
    }
    return std::sqrt(nearest);
}

}  // namespace

bool moves_in_space(const Simulation& simulation) noexcept {
    return grabbed_guide(simulation).freedom != 1;
}

Vec3 grabbed_place(const Simulation& simulation) noexcept {
    if (simulation.flexible) return find_held(*simulation.flexible);
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Molecule* const grabbed = simulation.world.find<Molecule>(grab->molecule);
    return simulation.atoms.positions[grabbed->reference_atom];
}

void place_grabbed(Simulation& simulation, const MoleculePose& pose) noexcept {
    const Grab* const grab = simulation.world.find<Grab>(simulation.hand);
    const Molecule* const grabbed = simulation.world.find<Molecule>(grab->molecule);
    Guide* const guide = simulation.world.find<Guide>(grab->molecule);
    guide->place = pose.place_angstrom;
    guide->orientation = pose.orientation;
    const Vec3 reference = simulation.anchor + pose.place_angstrom;
    if (simulation.flexible) {
        move_held(*simulation.flexible, reference - find_held(*simulation.flexible));
        copy_positions(*simulation.flexible, simulation.atoms.positions);
        return;
    }
    const Mat3 turn = pose.orientation.toRotationMatrix();
    for (std::size_t i = 0; i < simulation.grabbed_shape.size(); ++i) {
        simulation.atoms.positions[grabbed->atoms.first + i] =
            reference + turn * simulation.grabbed_shape[i];
    }
}

void place_grabbed(Simulation& simulation, const Vec3& place) noexcept {
    place_grabbed(simulation, MoleculePose{place, grabbed_guide(simulation).orientation});
}

void move_grabbed(Simulation& simulation, double distance) noexcept {
    place_grabbed(simulation, place_on_line(simulation, distance));
}

double grabbed_distance(const Simulation& simulation) noexcept {
    const Guide& guide = grabbed_guide(simulation);
    return guide.place.x() - guide.line_origin.x();
}

FieldSum field_on_grabbed(const Simulation& simulation) noexcept {
    return evaluate_pair_field(grabbed_points(simulation), environment_points(simulation),
                               pair_rule(simulation));
}

FieldSum field_on_grabbed_at(const Simulation& simulation, double distance) {
    const Vec3 by =
        simulation.anchor + place_on_line(simulation, distance) - grabbed_place(simulation);
    FieldPoints moved = grabbed_points(simulation);
    std::vector<Vec3> positions(moved.positions.begin(), moved.positions.end());
    for (Vec3& position : positions) position += by;
    moved.positions = positions;
    return evaluate_pair_field(moved, environment_points(simulation), pair_rule(simulation));
}

LineForce force_along_line(const Simulation& simulation) noexcept {
    return along_line(field_on_grabbed(simulation));
}

LineForce force_along_line_at(const Simulation& simulation, double distance) {
    return along_line(field_on_grabbed_at(simulation, distance));
}

std::optional<double> repulsion_distance(const Simulation& simulation, double force,
                                         double outermost) {
    if (force_along_line_at(simulation, outermost).force > force) return std::nullopt;
    const Scan scan = scan_of(simulation);
    // At least, in Å, from one molecule to the other where the hand is at `outermost`.
    const double apart = distance_at(simulation, outermost);
    double step = scan.step;
    for (double distance = outermost; distance > scan.innermost; distance -= step) {
        if (force_along_line_at(simulation, distance).force > force) {
            return bisect(simulation, force, distance, distance + step);
        }
        // Where nothing is near, the force changes slowly with the way that is left.
        constexpr double near = 30, share = 0.05;
        step = std::max(scan.step, share * (apart - (outermost - distance) - near));
    }
    return std::nullopt;
}

std::optional<double> equilibrium_distance(const Simulation& simulation) {
    const Scan scan = scan_of(simulation);
    bool attracted = false;
    for (double distance = 30; distance > scan.innermost; distance -= scan.step) {
        const double force = force_along_line_at(simulation, distance).force;
        if (force < -negligible) attracted = true;
        if (attracted && force > 0) return bisect(simulation, 0, distance, distance + scan.step);
    }
    return std::nullopt;
}

}  // namespace palpa
