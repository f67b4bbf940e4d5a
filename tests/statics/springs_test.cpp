#include "statics/springs.h"

#include "statics/adaptive_step.h"
#include "tests/support/torsion_case.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

using namespace palpa;
using test::TorsionShape;

namespace {

using enum BaseFreedom;

constexpr std::uint32_t second = 62;  // the first atom of the second peptide

// To a place and between atoms, of one molecule and of two, with a length and without.
std::vector<ModelSpring> springs_of_all_kinds() {
    return {{{8, 20, 47}, 15, {1, -2, 20}},
            {{50}, 20, {3, 5, 1}, {}, 4},
            {{5, 6}, 12, Vec3::Zero(), {second + 30}},
            {{second + 8, second + 20}, 9, Vec3::Zero(), {30, 31, 32}, 25},
            {{second + 3}, 30, Vec3::Zero(), {second + 55, second + 56}, 6}};
}

// What a change of the energy by five points is, of fourth order.
template <class EnergyAt>
double find_slope(double h, const EnergyAt& energy_at) {
    return (8 * (energy_at(h) - energy_at(-h)) - (energy_at(2 * h) - energy_at(-2 * h))) / (12 * h);
}

// The distance between weighted means, by hand.
double distance_of(const TorsionModel& model, const ModelSpring& spring,
                   const std::vector<Vec3>& positions) {
    const auto mean = [&](const std::vector<std::uint32_t>& atoms) {
        Vec3 moment = Vec3::Zero();
        double mass = 0;
        for (const std::uint32_t i : atoms) {
            moment += model.masses[i] * positions[i];
            mass += model.masses[i];
        }
        return Vec3(moment / mass);
    };
    const Vec3 other = spring.other_atoms.empty() ? spring.place : mean(spring.other_atoms);
    return (mean(spring.atoms) - other).norm();
}

}  // namespace

TEST_CASE("the stiffness of a spring is how its force falls with its other end",
          "[statics][springs]") {
    test::TorsionCase c = test::torsion_case(7, 4, TorsionShape::Chain);
    const TorsionModel model = test::forceless_model(c, Free);
    const TorsionState state = build_torsion_state(model);
    const Vec3 from = find_centre_of_mass(model, std::vector<std::uint32_t>{1, 3}, state.positions);
    const double length = GENERATE(0.0, 2.0, 7.0);
    ModelSpring spring{{1, 3}, 15, from + Vec3(3, -2, 1.5), {}, length};
    const auto force_at = [&](const Vec3& by) {
        ModelSpring moved = spring;
        moved.place += by;
        return find_spring_force(model, moved, state.positions);
    };

    const Mat3 stiffness = find_spring_stiffness(model, spring, state.positions);

    constexpr double h = 1e-4;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = h * Vec3::Unit(axis);
        const Vec3 slope = (force_at(step) - force_at(-step)) / (2 * h);
        CHECK((stiffness.col(axis) + slope).norm() < 1e-6 * spring.k);
    }
    spring.place = from;
    CHECK(find_spring_stiffness(model, spring, state.positions).allFinite());
}

TEST_CASE("a spring pulls at the centre of mass of its atoms", "[statics][springs]") {
    test::TorsionCase c = test::torsion_case(7, 4, TorsionShape::Chain);
    c.masses[1] = 2;
    c.masses[3] = 6;
    const TorsionModel model = test::forceless_model(c, Free);
    TorsionState state = build_torsion_state(model);
    ForceMemory memory;
    const Vec3 place(1, 2, 3);
    state.springs = {{{1, 3}, 10, place}};

    update_forces(model, {}, memory, state);

    const ModelSpring& spring = state.springs.front();
    const Vec3 centre = 0.25 * c.positions[1] + 0.75 * c.positions[3];
    CHECK((find_centre_of_mass(model, spring.atoms, state.positions) - centre).norm() < 1e-14);
    CHECK(state.spring_energy == Approx(5 * (centre - place).squaredNorm()));
    CHECK(state.energy() == state.spring_energy);
    CHECK((state.forces[1] - 2.5 * (place - centre)).norm() < 1e-12);
    CHECK((state.forces[3] - 7.5 * (place - centre)).norm() < 1e-12);
    CHECK((find_spring_force(model, spring, state.positions) - 10 * (centre - place)).norm() <
          1e-12);
    CHECK(state.forces[0].norm() == 0);
    CHECK(memory.evaluations == 1);

    state.springs.clear();
    update_forces(model, {}, memory, state);
    CHECK(state.energy() == 0);
    CHECK(state.forces[1].norm() == 0);
}

TEST_CASE("a spring between atoms pulls both ends, to its length", "[statics][springs]") {
    const test::TorsionCase c = test::torsion_case(7, 4, TorsionShape::Chain);
    const TorsionModel model = test::forceless_model(c, Free);
    const TorsionState start = build_torsion_state(model);
    const Vec3 apart = c.positions[1] - c.positions[4];
    const double distance = apart.norm();
    // Shorter and longer than it is, and as long.
    const double length = GENERATE_COPY(0.5 * distance, 2 * distance, distance);
    TorsionState state = start;
    state.springs = {{{1}, 8, Vec3(100, 0, 0), {4}, length}};
    ForceMemory memory;

    update_forces(model, {}, memory, state);

    const Vec3 expected = 8 * (distance - length) * apart / distance;  // on the other end
    CHECK(state.energy() == Approx(4 * std::pow(distance - length, 2)).margin(1e-12));
    CHECK((state.forces[4] - expected).norm() < 1e-12);
    CHECK((state.forces[1] + expected).norm() < 1e-12);
    CHECK((find_spring_force(model, state.springs[0], state.positions) - expected).norm() < 1e-12);

    // Both ends at one place: an energy, and no direction.
    state.springs = {{{1}, 8, Vec3::Zero(), {1}, 3}};
    update_forces(model, {}, memory, state);
    CHECK(state.energy() == 36);
    CHECK(state.forces[1].norm() == 0);
}

TEST_CASE("forces of springs are the slopes of their energies", "[statics][springs]") {
    auto [model, state] = test::peptide_pair({Turning, Free});
    const std::size_t kind = GENERATE(range<std::size_t>(0, 5));
    const ModelSpring spring = springs_of_all_kinds()[kind];
    INFO("spring " << kind);
    std::vector<Vec3> forces(state.positions.size(), Vec3::Zero());
    std::vector<Vec3> positions = state.positions;

    const double energy = add_spring_forces(model, spring, positions, forces);

    const double stretch = distance_of(model, spring, positions) - spring.length;
    CHECK(energy == Approx(0.5 * spring.k * stretch * stretch));
    CHECK(find_spring_force(model, spring, positions).norm() ==
          Approx(spring.k * std::abs(stretch)));
    const double largest = test::stacked(forces).cwiseAbs().maxCoeff();
    CHECK(largest > 1);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            const double slope = find_slope(1e-3, [&](double by) {
                std::vector<Vec3> there = positions, ignored = positions;
                there[i][axis] += by;
                return add_spring_forces(model, spring, there, ignored);
            });
            CHECK(std::abs(forces[i][axis] + slope) < 1e-8 * largest);
        }
    }
    // The force on the other end, as that moves.
    if (!spring.other_atoms.empty()) return;
    const Vec3 pull = find_spring_force(model, spring, positions);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double slope = find_slope(1e-3, [&](double by) {
            ModelSpring there = spring;
            there.place[axis] += by;
            return find_spring_pull(model, there, positions).energy;
        });
        CHECK(std::abs(pull[axis] + slope) < 1e-8 * largest);
    }
}

TEST_CASE("springs pull along the coordinates by the slopes of their energies",
          "[statics][springs]") {
    const auto bases = GENERATE(std::array{Turning, Free}, std::array{Free, Held});
    auto [model, state] = test::peptide_pair(bases);
    const std::vector<ModelSpring> springs = springs_of_all_kinds();
    const std::size_t kind = GENERATE(range<std::size_t>(0, 6));
    INFO("spring " << kind << ", or all");
    const auto energy_of = [&](const TorsionState& there) {
        double energy = 0;
        for (std::size_t s = 0; s < springs.size(); ++s) {
            if (kind != s && kind != springs.size()) continue;
            const double stretch =
                distance_of(model, springs[s], there.positions) - springs[s].length;
            energy += 0.5 * springs[s].k * stretch * stretch;
        }
        return energy;
    };
    // The force field's part of everything by a state that has no springs.
    TorsionState without = state;
    ForceMemory memory;
    update_forces(model, {}, memory, without);
    update_coordinate_forces(model, without);
    state.springs =
        kind < springs.size() ? std::vector<ModelSpring>{springs[kind]} : springs_of_all_kinds();

    update_forces(model, {}, memory, state);
    update_coordinate_forces(model, state);

    CHECK(state.spring_energy == Approx(energy_of(state)));
    CHECK(state.energy() == Approx(without.energy() + energy_of(state)));
    const Coordinates pull = state.coordinate_forces - without.coordinate_forces;
    for (Eigen::Index c = 0; c < model.coordinates; ++c) {
        const double slope = find_slope(1e-3, [&](double by) {
            TorsionState there = state;
            add_move(model, by * Coordinates::Unit(model.coordinates, c), there);
            return energy_of(there);
        });
        // What the force field has, which cancels, rounds.
        CHECK(std::abs(pull[c] + slope) <
              1e-7 * (1 + pull.cwiseAbs().maxCoeff()) + 1e-12 * without.coordinate_forces.norm());
    }
}

TEST_CASE("adaptive steps know springs as steps of everything do", "[statics][springs]") {
    const auto bases = GENERATE(std::array{Held, Free}, std::array{Turning, Free});
    const std::size_t active = GENERATE(std::size_t{4}, std::size_t{15}, std::size_t{1000});
    auto [model, state] = test::peptide_pair(bases);
    AdaptiveSettings settings;
    settings.limits.degrees_of_freedom = active;
    settings.choose_every = 5;
    state.springs = springs_of_all_kinds();
    AdaptiveStatics statics = build_adaptive_statics(model);
    statics.is_guided = {1, 1};  // so that all that acts between the two is known
    ForceMemory memory;

    const auto compare = [&] {
        TorsionState full = state;
        update_forces(model, {}, memory, full);
        REQUIRE(state.energy() == Approx(full.energy()).epsilon(1e-10));
        REQUIRE(state.spring_energy == Approx(full.spring_energy).epsilon(1e-12));
        const AdaptiveDeviation deviation = find_deviation(model, settings, state, statics);
        CHECK(deviation.position < 1e-9);
        CHECK(deviation.force < 1e-9);
        for (std::size_t m = 0; m < 2; ++m) {
            Vec6 wrench = Vec6::Zero();
            for (std::size_t i = m * second; i < (m + 1) * second; ++i) {
                wrench.head<3>() += full.positions[i].cross(full.forces[i]);
                wrench.tail<3>() += full.forces[i];
            }
            CHECK((find_wrench_on(statics, m) - wrench).norm() < 1e-7 * (1 + wrench.norm()));
        }
    };
    for (int i = 0; i < 40; ++i) {
        // Two hands, and restraints that come, change and go.
        state.springs[0].place += Vec3(0.03, 0, -0.02);
        state.springs[1].place += Vec3(0, -0.05, 0);
        if (i == 10) state.springs[3].length = 18;
        if (i == 20) state.springs.pop_back();
        if (i == 30) state.springs.push_back({{40}, 5, {2, 2, 2}, {}, 1});
        REQUIRE(update_adaptive_forces(model, settings, state, statics));
        compare();
        const double before = state.energy();
        REQUIRE(step_adaptive(model, settings, state, statics).step.is_finite);
        CHECK(state.energy() <= before + 1e-9);
        compare();
    }
}

TEST_CASE("two hands pull a molecule to where both springs are as long as they want to be",
          "[statics][springs]") {
    // A peptide that nothing else holds: it follows as a body, and is stretched no more than it
    // has to be.
    const bool is_adaptive = GENERATE(false, true);
    const TorsionModel model = test::model_of(test::tetrapeptide(), {Free});
    TorsionState state = build_torsion_state(model);
    const Vec3 shift(3, -2, 1);
    state.springs = {{{0}, 50, state.positions[0] + shift},
                     {{40}, 50, state.positions[40] + shift}};
    AdaptiveSettings settings;
    settings.limits.degrees_of_freedom = 6 + (is_adaptive ? 12 : 1000);
    AdaptiveStatics adaptive = build_adaptive_statics(model);
    QuasiStatics plain = build_quasi_statics(model);
    if (!is_adaptive) update_forces(model, settings.step.forces, plain.memory, state);

    for (int i = 0; i < 600; ++i) {
        if (is_adaptive) {
            REQUIRE(step_adaptive(model, settings, state, adaptive).step.is_finite);
        } else {
            REQUIRE(step_quasi_static(model, settings.step, state, plain).is_finite);
        }
    }

    for (const ModelSpring& spring : state.springs) {
        CHECK(distance_of(model, spring, state.positions) < 0.3);
    }
}
