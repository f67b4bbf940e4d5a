#include "statics/torsion_state.h"

#include "tests/support/torsion_case.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

using namespace palpa;
using test::TorsionShape;

namespace {

double bond_angle(const std::vector<Vec3>& x, const Angle& t) {
    return std::acos((x[t.a] - x[t.b]).normalized().dot((x[t.c] - x[t.b]).normalized()));
}

// All atoms that are bonded to `from` without the bond to `without`.
std::set<std::uint32_t> side_of(const Connectivity& connectivity, std::uint32_t from,
                                std::uint32_t without) {
    std::set<std::uint32_t> side{from};
    for (bool grows = true; grows;) {
        grows = false;
        for (const auto& [a, b] : connectivity.bonds) {
            if ((a == from && b == without) || (a == without && b == from)) continue;
            if (side.contains(a) != side.contains(b)) {
                side.insert({a, b});
                grows = true;
            }
        }
    }
    return side;
}

// O. Rodrigues' formula for the turn of a vector.
Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
    return std::cos(angle) * v + std::sin(angle) * axis.cross(v) +
           (1 - std::cos(angle)) * axis.dot(v) * axis;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double result = 0;
    for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, (a[i] - b[i]).norm());
    return result;
}

// Two tetrapeptides of which a spring holds three atoms of the second.
struct PulledPair {
    TorsionModel model;
    TorsionState state;
};

PulledPair pulled_pair(BaseFreedom first, BaseFreedom second) {
    PulledPair result{test::model_of(test::with_copy(test::tetrapeptide(), {12, 5, -2}),
                                     {first, second}, test::all_joints),
                      {}};
    result.state = test::state_after(result.model, 0.2, 3);
    result.state.springs = {{{62 + 8, 62 + 20, 62 + 47}, 15, {1, -2, 20}}};
    return result;
}

}  // namespace

TEST_CASE("bonds and angles stay as they are, whatever turned before", "[statics][state]") {
    const test::FlexibleCase c = test::with_copy(test::tetrapeptide(), {12, 5, -2});
    const TorsionModel model =
        test::model_of(c, {BaseFreedom::Free, BaseFreedom::Turning}, test::all_joints);
    std::mt19937 random(1);
    TorsionState state = build_torsion_state(model);

    for (int i = 0; i < 3000; ++i) add_move(model, test::random_move(model, 0.3, random), state);

    CHECK(farthest(state.positions, c.positions) > 3);
    double bond = 0, angle = 0, within = 0;
    for (const Bond& t : c.topology.bonds) {
        bond = std::max(bond, std::abs((state.positions[t.a] - state.positions[t.b]).norm() -
                                       (c.positions[t.a] - c.positions[t.b]).norm()));
    }
    for (const Angle& t : c.topology.angles) {
        angle =
            std::max(angle, std::abs(bond_angle(state.positions, t) - bond_angle(c.positions, t)));
    }
    const std::vector<std::uint32_t>& body_of = model.tree.bodies.body_of;
    for (std::size_t i = 0; i < body_of.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (body_of[i] != body_of[j]) continue;
            within = std::max(within, std::abs((state.positions[i] - state.positions[j]).norm() -
                                               (c.positions[i] - c.positions[j]).norm()));
        }
    }
    CHECK(bond < 1e-12);
    CHECK(angle < 1e-12);
    CHECK(within < 1e-12);
}

TEST_CASE("a joint turns its side of the bond by Rodrigues' formula", "[statics][state]") {
    const test::FlexibleCase c = test::tetrapeptide();
    const TorsionModel model = test::model_of(c, {BaseFreedom::Held}, test::all_joints);
    const std::vector<Body>& bodies = model.tree.bodies.bodies;
    const TorsionState start = test::state_after(model, 0.8, 2);

    for (std::size_t b = 0; b < bodies.size(); ++b) {
        if (model.tree.bodies.is_base(b)) continue;
        INFO("body " << b);
        const auto [j, k] = bodies[b].axis;
        const double angle = 0.3 + 0.1 * static_cast<double>(b);
        TorsionState state = start;
        add_move(model, angle * Coordinates::Unit(model.coordinates, model.coordinate_of_body[b]),
                 state);

        const std::set<std::uint32_t> side = side_of(c.connectivity, k, j);
        const Vec3 axis = (start.positions[k] - start.positions[j]).normalized();
        std::vector<Vec3> expected = start.positions;
        for (const std::uint32_t i : side) {
            expected[i] =
                start.positions[k] + turned(start.positions[i] - start.positions[k], axis, angle);
        }
        CHECK(side.size() < c.positions.size());
        CHECK(farthest(state.positions, expected) < 1e-12);
        CHECK(state.angles[b] == start.angles[b] + angle);
    }
}

TEST_CASE("bases turn about their pivots and go where they are moved", "[statics][state]") {
    using enum BaseFreedom;
    const test::FlexibleCase c = test::with_copy(test::tetrapeptide(), {12, 5, -2});
    const TorsionModel model = test::model_of(c, {Turning, Free});
    const TorsionState start = test::state_after(model, 0.4, 4);
    Vec3 centre = Vec3::Zero();
    for (std::size_t i = 62; i < 124; ++i) {
        centre += c.connectivity.mass[i] * start.positions[i];
    }
    centre /= model.molecule_masses[1];
    const Vec3 turn(0.3, -0.5, 0.7), by(1, 2, -3);
    const std::vector<Eigen::Index> at = model.coordinate_of_base;

    CHECK((start.pivots[0] - start.positions[0]).norm() == 0);
    CHECK((start.pivots[1] - centre).norm() < 1e-12);

    Coordinates move = Coordinates::Zero(model.coordinates);
    move.segment<3>(at[0]) = turn;
    move.segment<3>(at[1]) = -2 * turn;
    move.segment<3>(at[1] + 3) = by;
    TorsionState state = start;
    add_move(model, move, state);

    const Vec3 axis = turn.normalized();
    std::vector<Vec3> expected;
    for (std::size_t i = 0; i < 62; ++i) {
        expected.push_back(start.positions[0] +
                           turned(start.positions[i] - start.positions[0], axis, turn.norm()));
    }
    for (std::size_t i = 62; i < 124; ++i) {
        expected.push_back(centre + by +
                           turned(start.positions[i] - centre, axis, -2 * turn.norm()));
    }
    CHECK(farthest(state.positions, expected) < 1e-12);

    TorsionState shifted = start;
    shift_base(model, 0, by, shifted);
    for (std::size_t i = 0; i < 124; ++i) {
        const Vec3 moved = i < 62 ? by : Vec3(Vec3::Zero());
        CHECK((shifted.positions[i] - start.positions[i] - moved).norm() < 1e-13);
    }
    CHECK((shifted.pivots[0] - start.pivots[0] - by).norm() < 1e-13);
    CHECK(shifted.angles == start.angles);

    // By hand, whatever a base may do by itself.
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(turn.norm(), axis));
    TorsionState placed = start;
    turn_base(model, 0, rotation, by, placed);
    turn_base(model, 1, rotation.inverse() * rotation.inverse(), by, placed);
    for (std::size_t i = 0; i < 62; ++i) expected[i] += by;
    CHECK(farthest(placed.positions, expected) < 1e-12);
    CHECK((placed.pivots[0] - start.pivots[0] - by).norm() < 1e-13);
    CHECK((placed.pivots[1] - centre - by).norm() < 1e-12);
    CHECK(placed.angles == start.angles);
    // From the coordinates, not only in the positions.
    update_positions(model, placed);
    CHECK(farthest(placed.positions, expected) < 1e-12);
}

TEST_CASE("a move there and back ends where it began", "[statics][state]") {
    using enum BaseFreedom;
    const TorsionModel model = test::model_of(test::with_copy(test::tetrapeptide(), {12, 5, -2}),
                                              {Turning, Free}, test::all_joints);
    const TorsionState start = test::state_after(model, 0.4, 4);
    std::mt19937 random(8);
    const Coordinates move = test::random_move(model, 1, random);
    const Eigen::Index joints = model.coordinate_of_base[0];

    // A free base turns about where the centre of mass is, which joints move: each kind by itself.
    struct Part {
        const char* name;
        Eigen::Index first, count;
    };
    const auto part =
        GENERATE_COPY(values<Part>({{"joints", 0, joints},
                                    {"turns", joints, 6},
                                    {"shifts", joints + 6, model.coordinates - joints - 6}}));
    INFO(part.name);
    Coordinates some = Coordinates::Zero(model.coordinates);
    some.segment(part.first, part.count) = move.segment(part.first, part.count);
    TorsionState state = start;

    add_move(model, some, state);
    CHECK(farthest(state.positions, start.positions) > 0.1);
    add_move(model, -some, state);
    CHECK(farthest(state.positions, start.positions) < 1e-12);
}

TEST_CASE("forces along the coordinates are the slopes of the energy", "[statics][state]") {
    using enum BaseFreedom;
    const auto freedoms =
        GENERATE(std::array{Held, Free}, std::array{Turning, Turning}, std::array{Free, Turning});
    auto [model, state] = pulled_pair(freedoms[0], freedoms[1]);
    ForceSettings settings;
    if (freedoms[0] == Free) {  // with a list of pairs
        settings.nonbonded.electrostatics = ElectrostaticCutoff::ForceSwitch;
        settings.nonbonded.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
    }
    ForceMemory memory;

    update_forces(model, settings, memory, state);
    update_coordinate_forces(model, state);

    REQUIRE(state.coordinate_forces.size() == model.coordinates);
    // Forces on single atoms are the terms that cancel.
    const double largest = test::stacked(state.forces).cwiseAbs().maxCoeff();
    for (Eigen::Index c = 0; c < model.coordinates; ++c) {
        INFO("coordinate " << c << " of " << model.coordinates);
        const auto energy_at = [&](double by) {
            TorsionState there = state;
            add_move(model, by * Coordinates::Unit(model.coordinates, c), there);
            update_forces(model, settings, memory, there);
            return there.energy();
        };
        constexpr double h = 2e-4;  // an error of h^4 E'''''/30
        const double slope =
            (8 * (energy_at(h) - energy_at(-h)) - (energy_at(2 * h) - energy_at(-2 * h))) /
            (12 * h);
        CHECK(std::abs(state.coordinate_forces[c] + slope) < 1e-7 * (1 + largest));
    }
}

TEST_CASE("forces on atoms become forces along coordinates as the atoms move", "[statics][state]") {
    const auto shape = GENERATE(TorsionShape::Tree, TorsionShape::Chain, TorsionShape::Star);
    const auto freedom = GENERATE(BaseFreedom::Free, BaseFreedom::Turning, BaseFreedom::Held);
    const test::TorsionCase c = test::torsion_case(31, 20, shape);
    const TorsionModel model = test::forceless_model(c, freedom);
    TorsionState state = test::state_after(model, 1, 6);
    state.forces = c.forces;

    update_coordinate_forces(model, state);

    const Coordinates expected =
        test::find_jacobian(model, state).transpose() * test::stacked(c.forces);
    CHECK((state.coordinate_forces - expected).norm() < 1e-9 * expected.norm());
}

TEST_CASE("a state takes over another's place, and with it what was computed there",
          "[statics][state]") {
    auto [model, there] = pulled_pair(BaseFreedom::Free, BaseFreedom::Free);
    ForceMemory memory;
    update_forces(model, {}, memory, there);
    update_coordinate_forces(model, there);
    const TorsionState expected = there;
    TorsionState coordinates = build_torsion_state(model), all = build_torsion_state(model);

    copy_coordinates(there, coordinates);
    CHECK(coordinates.angles == expected.angles);
    CHECK(coordinates.positions == expected.positions);
    CHECK(coordinates.pivots == expected.pivots);
    CHECK(coordinates.springs.size() == 1);
    CHECK(coordinates.energy() == 0);
    CHECK(coordinates.coordinate_forces.norm() == 0);
    // Coordinates and not only positions: it goes on from there.
    update_positions(model, coordinates);
    CHECK(farthest(coordinates.positions, expected.positions) == 0);

    take_over(there, all);
    CHECK(all.positions == expected.positions);
    CHECK(all.energy() == expected.energy());
    CHECK(all.forces == expected.forces);
    CHECK(all.coordinate_forces == expected.coordinate_forces);
}

TEST_CASE("lists of pairs give the sum over all pairs wherever atoms go", "[statics][state]") {
    const TorsionModel model = test::model_of(test::with_copy(test::tetrapeptide(), {12, 5, -2}),
                                              {BaseFreedom::Free, BaseFreedom::Free});
    const bool is_fast = GENERATE(false, true);
    ForceSettings settings;
    settings.fast = is_fast;
    settings.nonbonded.electrostatics = ElectrostaticCutoff::ForceSwitch;
    settings.nonbonded.van_der_waals = VanDerWaalsCutoff::ForceSwitch;
    ForceMemory memory;
    std::mt19937 random(12);
    TorsionState state = build_torsion_state(model);

    for (int i = 0; i < 30; ++i) {
        update_forces(model, settings, memory, state);

        std::vector<Vec3> forces(state.forces.size(), Vec3::Zero());
        const double energy =
            add_forces(model.topology, settings.nonbonded, state.positions, forces).total();
        // Single precision by fast_nonbonded.h, else the order of the sum.
        const double tolerance = is_fast ? 1e-5 : 1e-11;
        const double size = test::stacked(forces).norm();
        CHECK(std::abs(state.energy() - energy) < tolerance * (std::abs(energy) + size));
        CHECK((test::stacked(state.forces) - test::stacked(forces)).norm() < tolerance * size);
        add_move(model, test::random_move(model, 0.15, random), state);
    }
    CHECK(memory.evaluations == 30);
}

TEST_CASE("solvated peptides have finite energies however they are twisted",
          "[statics][state][solvation]") {
    const TorsionModel model =
        test::model_of(test::with_copy(test::solvated(test::tetrapeptide()), {6, 2, -1}),
                       {BaseFreedom::Free, BaseFreedom::Turning}, test::all_joints);
    const ForceSettings settings{.nonbonded = eef1_settings()};
    TorsionState state = build_torsion_state(model);
    ForceMemory memory;
    std::mt19937 random(6);
    for (int i = 0; i < 1000; ++i) {
        add_move(model, test::random_move(model, 3, random), state);
        update_forces(model, settings, memory, state);
        update_coordinate_forces(model, state);
        CHECK(std::isfinite(state.energy()));
        CHECK(state.terms.solvation != 0);
        CHECK(state.coordinate_forces.allFinite());
    }
}

TEST_CASE("coordinate forces with solvation are the derivative of the energy",
          "[statics][state][solvation]") {
    const TorsionModel model =
        test::model_of(test::with_copy(test::solvated(test::tetrapeptide()), {9, 4, -2}),
                       {BaseFreedom::Free, BaseFreedom::Turning}, test::all_joints);
    const ForceSettings settings{.nonbonded = eef1_settings()};
    ForceMemory memory;
    const TorsionState start = test::state_after(model, 0.1, 3);
    const auto forces_at = [&](const Coordinates& move) {
        TorsionState state = start;
        add_move(model, move, state);
        update_forces(model, settings, memory, state);
        update_coordinate_forces(model, state);
        return state;
    };
    const Coordinates there = forces_at(Coordinates::Zero(model.coordinates)).coordinate_forces;
    constexpr double h = 1e-4;
    for (Eigen::Index k = 0; k < model.coordinates; ++k) {
        const auto at = [&](double by) {
            return forces_at(by * Coordinates::Unit(model.coordinates, k)).energy();
        };
        const double slope =
            (45 * (at(h) - at(-h)) - 9 * (at(2 * h) - at(-2 * h)) + at(3 * h) - at(-3 * h)) /
            (60 * h);
        CHECK(std::abs(there[k] + slope) < 1e-8 * there.cwiseAbs().maxCoeff());
    }
}
