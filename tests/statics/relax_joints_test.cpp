#include "statics/relax_joints.h"

#include "tests/support/shared_data.h"
#include "tests/support/torsion_case.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

using namespace palpa;

namespace {

constexpr double degree = std::numbers::pi / 180;

double energy_at(const TorsionModel& model, double phi, double psi, TorsionState& state) {
    ForceMemory memory;
    state.angles[1] = phi;
    state.angles[2] = psi;
    update_positions(model, state);
    update_forces(model, {}, memory, state);
    return state.energy();
}

struct Lowest {
    double phi = 0, psi = 0;  // of the model's joints, from the reference
    double energy = std::numeric_limits<double>::infinity();
};

Lowest scan(const TorsionModel& model, const Lowest& around, double step, int steps) {
    TorsionState state = build_torsion_state(model);
    Lowest lowest;
    for (int i = -steps; i <= steps; ++i) {
        for (int j = -steps; j <= steps; ++j) {
            Lowest here{around.phi + i * step, around.psi + j * step};
            here.energy = energy_at(model, here.phi, here.psi, state);
            if (here.energy < lowest.energy) lowest = here;
        }
    }
    return lowest;
}

// A chain of beads whose ends a bond of 2 Å closes to a ring; every bond of the chain turns.
TorsionModel open_ring() {
    constexpr std::uint32_t beads = 14;
    std::vector<Vec3> positions{{0, 0, 0}, {1.5, 0, 0}, {2.1, 1.4, 0}};
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    while (positions.size() < beads) {
        const std::size_t last = positions.size() - 1;
        const Vec3 bond = (positions[last] - positions[last - 1]).normalized();
        const Vec3 aside =
            bond.cross(Vec3(uniform(random), uniform(random), uniform(random))).normalized();
        positions.emplace_back(positions[last] + 1.5 * (0.4 * bond + std::sqrt(0.84) * aside));
    }
    TorsionBodies bodies;
    bodies.body_of = {0, 0};
    bodies.bodies.push_back({});
    for (std::uint32_t atom = 2; atom < beads; ++atom) {
        if (atom + 1 < beads) bodies.bodies.push_back({atom - 2, {atom - 1, atom}});
        bodies.body_of.push_back(static_cast<std::uint32_t>(bodies.bodies.size() - 1));
    }
    bodies.springs = {{0, beads - 1}};
    Topology topology;
    topology.charge.assign(beads, 0);
    topology.type.assign(beads, 0);
    for (std::uint32_t i = 0; i < beads; ++i) {
        topology.bonds.push_back({i, (i + 1) % beads, 173, i + 1 == beads ? 2.0 : 1.5});
    }
    topology.exclusions = build_exclusions(topology.bonds, beads);
    const std::vector<LennardJonesType> types{{0.05, 1.7}};
    topology.lennard_jones = build_lennard_jones_table(types, {});
    topology.lennard_jones14 = topology.lennard_jones;
    return build_torsion_model(bodies, std::vector<double>(beads, 14), positions, topology,
                               {MoleculeBase{BaseFreedom::Held, 0}});
}

constexpr std::array all_methods{RelaxMethod::QuasiStatic, RelaxMethod::SecondOrder};

}  // namespace

TEST_CASE("every method finds the minimum that a scan of phi and psi finds", "[statics][relax]") {
    const TorsionModel model = test::model_of(test::alanine_dipeptide(), {BaseFreedom::Free});
    REQUIRE(model.coordinates == 2 + 6);
    const Lowest coarse = scan(model, {}, 5 * degree, 36);
    const Lowest lowest = scan(model, scan(model, coarse, 0.5 * degree, 10), 0.05 * degree, 10);
    RelaxSettings settings;
    settings.force_tolerance = 1e-4;
    settings.steps = 5000;
    std::mt19937 random(17);

    for (const RelaxMethod method : all_methods) {
        for (int start = 0; start < 3; ++start) {
            INFO("method " << static_cast<int>(method) << " start " << start);
            settings.method = method;
            TorsionState state = build_torsion_state(model);
            state.angles[1] = lowest.phi;
            state.angles[2] = lowest.psi;
            update_positions(model, state);
            add_move(model, test::random_move(model, 0.25, random), state);
            QuasiStatics statics = build_quasi_statics(model);

            const JointRelaxReport report = relax_joints(model, settings, state, statics);

            CHECK(report.end == RelaxEnd::Converged);
            CHECK(report.rms_force <= settings.force_tolerance);
            CHECK(report.energy_after == state.energy());
            CHECK(report.energy_before > report.energy_after);
            // The grid misses the minimum by 0.025 degrees at most, the tolerance by less.
            CHECK(report.energy_after <= lowest.energy + 1e-9);
            CHECK(report.energy_after > lowest.energy - 1e-4);
        }
    }
}

TEST_CASE("the energy never rises on the way to rest", "[statics][relax]") {
    using enum BaseFreedom;
    const TorsionModel model = test::model_of(test::with_copy(test::tetrapeptide(), {12, 5, -2}),
                                              {Turning, Free}, test::all_joints);
    RelaxSettings settings;
    settings.method = GENERATE(from_range(all_methods.begin(), all_methods.end()));
    settings.steps = 150;
    TorsionState state = test::state_after(model, 0.2, 4);
    const TorsionState start = state;
    QuasiStatics statics = build_quasi_statics(model);
    std::vector<RelaxProgress> way;

    const JointRelaxReport report =
        relax_joints(model, settings, state, statics, [&](const RelaxProgress& progress) {
            way.push_back(progress);
            return true;
        });

    REQUIRE(way.size() > 50);
    CHECK(way.front().step == 0);
    CHECK(way.front().energy == report.energy_before);
    for (std::size_t i = 1; i < way.size(); ++i) {
        CHECK(way[i].energy <= way[i - 1].energy);
        CHECK(way[i].step - way[i - 1].step <= 1);
    }
    CHECK(report.energy_after < report.energy_before - 50);
    CHECK(report.evaluations == statics.memory.evaluations);
    CHECK(report.evaluations > report.steps);
    CHECK(report.largest_move == find_largest_move(start.positions, state.positions));
    CHECK((state.positions[0] - start.positions[0]).norm() < 1e-11);

    // What the state says is true of where it is.
    TorsionState again = state;
    update_forces(model, settings.step.forces, statics.memory, again);
    update_coordinate_forces(model, again);
    CHECK(again.energy() == Approx(report.energy_after).epsilon(1e-12));
    CHECK((again.coordinate_forces - state.coordinate_forces).norm() <
          1e-9 * (1 + state.coordinate_forces.norm()));
    CHECK(report.rms_force == Approx(again.coordinate_forces.norm() /
                                     std::sqrt(static_cast<double>(model.coordinates))));
}

TEST_CASE("a way to rest ends where it has to, and says why", "[statics][relax]") {
    const TorsionModel model =
        test::model_of(test::tetrapeptide(), {BaseFreedom::Free}, test::all_joints);
    RelaxSettings settings;
    settings.method = GENERATE(from_range(all_methods.begin(), all_methods.end()));
    QuasiStatics statics = build_quasi_statics(model);
    TorsionState state = build_torsion_state(model);

    SECTION("after so many steps") {
        settings.steps = 3;
        const JointRelaxReport report = relax_joints(model, settings, state, statics);
        CHECK(report.end == RelaxEnd::Steps);
        CHECK(report.steps == 3);
    }
    SECTION("without any") {
        settings.steps = 0;
        const JointRelaxReport report = relax_joints(model, settings, state, statics);
        CHECK(report.end == RelaxEnd::Steps);
        CHECK(report.steps == 0);
        CHECK(report.energy_before == report.energy_after);
        CHECK(report.largest_move == 0);
        CHECK(state.positions == model.reference);
    }
    SECTION("when it is told to") {
        const JointRelaxReport report =
            relax_joints(model, settings, state, statics,
                         [](const RelaxProgress& progress) { return progress.step < 2; });
        CHECK(report.end == RelaxEnd::Steps);
        CHECK(report.steps == 2);
    }
    SECTION("at once, where it rests") {
        settings.force_tolerance = 1e9;
        const JointRelaxReport report = relax_joints(model, settings, state, statics);
        CHECK(report.end == RelaxEnd::Converged);
        CHECK(report.steps == 0);
        CHECK(report.evaluations == 1);
    }
    SECTION("where the start is no number") {
        state.shifts[0].x() = std::numeric_limits<double>::quiet_NaN();
        update_positions(model, state);
        const JointRelaxReport report = relax_joints(model, settings, state, statics);
        CHECK(report.end == RelaxEnd::NotFinite);
        CHECK(report.steps == 0);
    }
}

TEST_CASE("where rounding hides what is lower smaller forces decide, until a minimiser is stuck",
          "[statics][relax]") {
    const TorsionModel model =
        test::model_of(test::tetrapeptide(), {BaseFreedom::Held}, test::all_joints);
    RelaxSettings settings;
    settings.force_tolerance = 0;
    settings.steps = 20000;

    std::vector<double> ends;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        TorsionState state = test::state_after(model, 0.05, seed);
        QuasiStatics statics = build_quasi_statics(model);
        const JointRelaxReport report = relax_joints(model, settings, state, statics);
        CHECK(report.end == RelaxEnd::Stuck);
        CHECK(report.rms_force < 1e-5);
        CHECK(report.rms_force > 0);
        ends.push_back(report.rms_force);
    }

    std::ranges::sort(ends);
    CAPTURE(ends);
    CHECK(ends[2] < 1e-6);  // where values alone decide it is above
}

TEST_CASE("nothing that moves is at rest", "[statics][relax]") {
    const TorsionModel model =
        test::model_of(test::alanine_dipeptide(), {BaseFreedom::Held},
                       {.overrides = {{{6, 8}, BondMotion::Rigid}, {{8, 14}, BondMotion::Rigid}}});
    REQUIRE(model.coordinates == 0);
    TorsionState state = build_torsion_state(model);
    QuasiStatics statics = build_quasi_statics(model);

    const JointRelaxReport report = relax_joints(model, {}, state, statics);

    CHECK(report.end == RelaxEnd::Converged);
    CHECK(report.rms_force == 0);
}

TEST_CASE("fast pairs lead to the same minimum", "[statics][relax]") {
    const TorsionModel model = test::model_of(test::with_copy(test::tetrapeptide(), {12, 5, -2}),
                                              {BaseFreedom::Held, BaseFreedom::Free});
    RelaxSettings settings;
    settings.steps = 5000;
    settings.force_tolerance = 3e-3;
    TorsionState exact = build_torsion_state(model);
    QuasiStatics statics = build_quasi_statics(model);
    REQUIRE(relax_joints(model, settings, exact, statics).end == RelaxEnd::Converged);
    std::mt19937 random(2);
    TorsionState fast = exact;
    add_move(model, test::random_move(model, 0.01, random), fast);
    settings.step.forces.fast = true;
    settings.method = GENERATE(from_range(all_methods.begin(), all_methods.end()));

    const JointRelaxReport report = relax_joints(model, settings, fast, statics);

    CHECK(report.end == RelaxEnd::Converged);
    CHECK(report.energy_before > report.energy_after + 1e-3);
    // In double, where it ended.
    update_forces(model, {}, statics.memory, fast);
    CHECK(std::abs(fast.energy() - exact.energy()) < 1e-3);
}

TEST_CASE("a spring closes a ring and keeps it closed", "[statics][relax]") {
    const TorsionModel model = open_ring();
    RelaxSettings settings;
    settings.method = GENERATE(from_range(all_methods.begin(), all_methods.end()));
    settings.steps = 20000;
    // Steps of the masses take long along what is soft beside so stiff a bond.
    settings.force_tolerance = settings.method == RelaxMethod::QuasiStatic ? 0.5 : 0.01;
    TorsionState state = build_torsion_state(model);
    QuasiStatics statics = build_quasi_statics(model);
    const auto gap = [&] { return (state.positions.front() - state.positions.back()).norm(); };
    REQUIRE(model.topology.bonds.size() == 1);
    REQUIRE(gap() > 4);

    const JointRelaxReport report = relax_joints(model, settings, state, statics);

    CHECK(report.end == RelaxEnd::Converged);
    CHECK(gap() == Approx(2).margin(0.05));
    for (std::size_t i = 1; i < state.positions.size(); ++i) {
        CHECK((state.positions[i] - state.positions[i - 1]).norm() ==
              Approx((model.reference[i] - model.reference[i - 1]).norm()).epsilon(1e-12));
    }
}

TEST_CASE("crambin at rest keeps its disulphides", "[statics][relax]") {
    const auto folder = test::find_shared_data("reference");
    if (!folder) return;
    const test::FlexibleCase c =
        test::read_flexible_case(*folder, "crambin_c36m", "minimised_noise0.003nm_3");
    const TorsionModel model = test::model_of(c, {BaseFreedom::Held});
    const auto& springs = model.tree.bodies.springs;
    REQUIRE(springs.size() == 3);
    RelaxSettings settings;
    settings.force_tolerance = 0.1;
    settings.step.forces.fast = true;
    TorsionState state = build_torsion_state(model);
    QuasiStatics statics = build_quasi_statics(model);

    const JointRelaxReport report = relax_joints(model, settings, state, statics);

    CHECK(report.end == RelaxEnd::Converged);
    for (const auto& [a, b] : springs) {
        const auto bond = std::ranges::find_if(c.topology.bonds, [&](const Bond& t) {
            return std::min(t.a, t.b) == std::min(a, b) && std::max(t.a, t.b) == std::max(a, b);
        });
        REQUIRE(bond != c.topology.bonds.end());
        CHECK((state.positions[a] - state.positions[b]).norm() == Approx(bond->r0).margin(0.15));
    }
}
