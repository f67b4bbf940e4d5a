#include "simulation/probe.h"

#include "simulation/grip_queries.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace palpa {
namespace {

// The first, where none is named.
Entity named(const World& world, Entity hand) noexcept {
    return hand == Entity{} ? hand_at(world, 0) : hand;
}

const Grip& named_grip(const World& world, Entity hand) noexcept {
    return grip_of(world, named(world, hand));
}

Vec3 place_on_line(const World& world, double distance, Entity hand) noexcept {
    return named_grip(world, hand).line_origin + distance * Vec3::UnitX();
}

// From where the grabbed molecule is.
Vec3 shift_to(const World& world, double distance, Entity hand) noexcept {
    return named_grip(world, hand).anchor + place_on_line(world, distance, hand) -
           grabbed_place(world, hand);
}

LineForce along_line(const FieldSum& field) noexcept {
    return {field.energy(), field.force.x(), field.stiffness(0, 0)};
}

// How far in a scan goes and how finely (Å). In space walls are of many atoms, and every look at
// them costs a thousand times more.
struct Scan {
    double innermost, step;
};

Scan scan_of(const World& world, Entity hand) {
    return named_grip(world, hand).freedom == 1 ? Scan{1, 0.005} : Scan{-60, 0.05};
}

// Forces weaker than this (kcal/mol/Å, 0.07 pN) far outside are no attraction.
constexpr double negligible = 1e-3;

// The distance between `inside` (force above `level`) and `outside` (below) where it passes.
double bisect(const World& world, double level, double inside, double outside, Entity hand) {
    while (outside - inside > 1e-12) {
        const double middle = 0.5 * (inside + outside);
        const bool above = force_along_line_at(world, middle, hand).force > level;
        (above ? inside : outside) = middle;
    }
    return 0.5 * (inside + outside);
}

// The shortest distance between an atom in the hand and one of the others.
double distance_at(const World& world, double distance, Entity hand) {
    const Vec3 by = shift_to(world, distance, hand);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3& a : held_points(world, named(world, hand)).positions) {
        for (const AtomRange& range : environment_of(world, named(world, hand))) {
            for (const Vec3& b : points_of(world.resource<AtomTable>(), range).positions)
                nearest = std::min(nearest, (a + by - b).squaredNorm());
        }
    }
    return std::sqrt(nearest);
}

}  // namespace

bool moves_in_space(const World& world, Entity hand) noexcept {
    return named_grip(world, hand).freedom != 1;
}

Vec3 grabbed_place(const World& world, Entity hand) noexcept {
    return held_place(world, named(world, hand));
}

void place_grabbed(World& world, const MoleculePose& pose, Entity hand) noexcept {
    place_held(world, named(world, hand), pose);
}

void place_grabbed(World& world, const Vec3& place, Entity hand) noexcept {
    place_grabbed(world, MoleculePose{place, named_grip(world, hand).pose.orientation}, hand);
}

void move_grabbed(World& world, double distance, Entity hand) noexcept {
    place_grabbed(world, place_on_line(world, distance, hand), hand);
}

double grabbed_distance(const World& world, Entity hand) noexcept {
    const Grip& grip = named_grip(world, hand);
    return grip.pose.place_angstrom.x() - grip.line_origin.x();
}

FieldSum field_on_grabbed(const World& world, Entity hand) {
    return field_on_held(world, named(world, hand));
}

FieldSum field_on_grabbed_at(const World& world, double distance, Entity hand) {
    const Vec3 by = shift_to(world, distance, hand);
    FieldPoints moved = held_points(world, named(world, hand));
    std::vector<Vec3> positions(moved.positions.begin(), moved.positions.end());
    for (Vec3& position : positions) position += by;
    moved.positions = positions;
    return field_on(world, named(world, hand), moved);
}

LineForce force_along_line(const World& world, Entity hand) {
    return along_line(field_on_grabbed(world, hand));
}

LineForce force_along_line_at(const World& world, double distance, Entity hand) {
    return along_line(field_on_grabbed_at(world, distance, hand));
}

std::optional<double> repulsion_distance(const World& world, double force, double outermost,
                                         Entity hand) {
    if (force_along_line_at(world, outermost, hand).force > force) return std::nullopt;
    const Scan scan = scan_of(world, hand);
    // At least, in Å, from one molecule to the other where the hand is at `outermost`.
    const double apart = distance_at(world, outermost, hand);
    double step = scan.step;
    for (double distance = outermost; distance > scan.innermost; distance -= step) {
        if (force_along_line_at(world, distance, hand).force > force) {
            return bisect(world, force, distance, distance + step, hand);
        }
        // Where nothing is near, the force changes slowly with the way that is left.
        constexpr double near = 30, share = 0.05;
        step = std::max(scan.step, share * (apart - (outermost - distance) - near));
    }
    return std::nullopt;
}

std::optional<double> equilibrium_distance(const World& world, Entity hand) {
    const Scan scan = scan_of(world, hand);
    bool attracted = false;
    for (double distance = 30; distance > scan.innermost; distance -= scan.step) {
        const double force = force_along_line_at(world, distance, hand).force;
        if (force < -negligible) attracted = true;
        if (attracted && force > 0) return bisect(world, 0, distance, distance + scan.step, hand);
    }
    return std::nullopt;
}

}  // namespace palpa
