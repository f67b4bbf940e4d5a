#include "simulation/exactness.h"

#include "core/units.h"
#include "scene/read_scene.h"
#include "simulation/simulation.h"
#include "simulation/step.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr double pico_per_kcal = units::newton_per_kcal_per_mol_angstrom * 1e12;

// Two tetrapeptides 11 Å apart, of 32 joints.
SceneDescription scene_of_peptides(const std::vector<std::string>& settings) {
    return read_scene(test::test_data("two_peptides"), settings);
}

struct Played {
    std::vector<double> errors_pN;  // that audits found
    std::vector<Vec3> positions;
    Effort effort;
    double true_error_pN = 0;  // at the end
};

// The force on what is held once all joints have made so many steps in double, by the way that
// scenes without few active joints go.
Vec3 force_of_all(const Flexible& flexible, int steps) {
    Flexible all = build_flexible(scene_of_peptides({"statics.steps=1"}), flexible.model,
                                  flexible.grabbed, flexible.state.tether);
    all.state = flexible.state;
    start_flexible(all);
    for (int i = 0; i < steps; ++i) (void)step_flexible(all);
    return find_pull_on_held(all).tail<3>();
}

// The hand goes 2 Å towards the other molecule, and stays.
Played play(const std::vector<std::string>& settings) {
    Simulation simulation = load_simulation(scene_of_peptides(settings));
    TouchModel felt = simulation.touch.model;
    Played played;
    for (int i = 1; i <= 2000; ++i) {
        HandPose hand;
        hand.travel_m = Vec3(-0.001 * i * 0.25e9 * 1e-10, 0, 0);
        const StepReport report = step_simulation(simulation, hand, felt);
        felt = report.touch;
        REQUIRE(report.settled);
        if (const auto error_pN = report.settled->audited_pN) played.errors_pN.push_back(*error_pN);
    }
    REQUIRE(simulation.flexible);
    const Flexible& flexible = *simulation.flexible;
    REQUIRE(flexible.adaptive);
    if (flexible.adaptive->exactness) played.effort = flexible.adaptive->exactness->effort();
    played.positions = simulation.atoms.positions;
    played.true_error_pN =
        pico_per_kcal * (find_force_on_held(flexible) - force_of_all(flexible, 100)).norm();
    return played;
}

}  // namespace

TEST_CASE("too much error raises active joints by half, then steps", "[simulation][exactness]") {
    const bool has_budget = GENERATE(false, true);
    Exactness exactness(50, {10, 2}, 40, has_budget);
    const auto after = [&](double error_pN) {
        exactness.add_audit(error_pN, Vec3::Zero(), 20);
        return exactness.effort();
    };

    CHECK(exactness.effort() == Effort{10, 2});
    CHECK(after(36) == Effort{16, 2});
    CHECK(after(139) == Effort{39, 2});
    CHECK(after(36) == Effort{40, 2});
    // Where time is what there is too little of, more steps would only take it from joints.
    CHECK(after(36) == Effort{40, has_budget ? 2U : 3U});
    for (int i = 0; i < 10; ++i) (void)after(36);
    CHECK(exactness.effort() == Effort{40, has_budget ? 2U : Exactness::most_steps});
    CHECK(exactness.error() == 36.0);
}

TEST_CASE("less than half the error gives back steps, then joints, by a fifth",
          "[simulation][exactness]") {
    Exactness exactness(50, {40, 2}, 40, false);
    double told_pN = 0;
    const auto after_calm = [&](double error_pN) {
        for (int i = 0; i < 5; ++i) exactness.add_audit(error_pN, Vec3(told_pN += 20, 0, 0), 20);
        return exactness.effort();
    };
    exactness.add_audit(60, Vec3::Zero(), 20);
    REQUIRE(exactness.effort() == Effort{40, 3});

    CHECK(after_calm(17) == Effort{40, 2});
    CHECK(after_calm(17) == Effort{32, 2});
    CHECK(after_calm(17) == Effort{25, 2});
    // Between half and all of it everything stays.
    CHECK(after_calm(18) == Effort{25, 2});
    for (int i = 0; i < 40; ++i) (void)after_calm(17);
    CHECK(exactness.effort() == Effort{8, 2});
}

TEST_CASE("of many steps a fifth is given back at a time", "[simulation][exactness]") {
    Exactness exactness(50, {40, 2}, 40, false);
    for (int i = 0; i < 30; ++i) exactness.add_audit(60, Vec3::Zero(), 20);
    REQUIRE(exactness.effort() == Effort{40, Exactness::most_steps});
    static_assert(Exactness::most_steps == 20);

    std::vector<std::size_t> seen{exactness.effort().steps};
    for (int i = 0; i < 60 && seen.size() < 4; ++i) {
        exactness.add_audit(17, Vec3(20.0 * i, 0, 0), 20);
        if (exactness.effort().steps != seen.back()) seen.push_back(exactness.effort().steps);
    }

    CHECK(seen == std::vector<std::size_t>{20, 16, 12, 9});
    CHECK(exactness.effort().active == 40);
}

TEST_CASE("an error without bounds raises everything, and ends", "[simulation][exactness]") {
    const double error_pN =
        GENERATE(std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN());
    Exactness joints_and_steps(50, {8, 2}, 40, false), joints(50, {8, 2}, 40, true);

    joints_and_steps.add_audit(error_pN, Vec3::Zero(), 20);
    joints.add_audit(error_pN, Vec3::Zero(), 20);

    CHECK(joints_and_steps.effort() == Effort{40, Exactness::most_steps});
    CHECK(joints.effort() == Effort{40, 2});
}

TEST_CASE("while the hand rests nothing is proven", "[simulation][exactness]") {
    Exactness exactness(50, {40, 2}, 40, false);
    for (int i = 0; i < 100; ++i) exactness.add_audit(1, Vec3(i % 2 == 0 ? 0 : 49, 0, 0), 20);

    CHECK(exactness.effort() == Effort{40, 2});
    exactness.add_audit(1, Vec3(51, 0, 0), 20);
    CHECK(exactness.effort() == Effort{32, 2});
}

TEST_CASE("audits are a fifth of all work at most, rarer where it is calm, at once where not",
          "[simulation][exactness]") {
    Exactness exactness(50, {8, 2}, 40, false);
    double work = 0, audited = 0;
    const auto play = [&](double error_pN, int steps) {
        int audits = 0;
        for (int i = 0; i < steps; ++i) {
            exactness.add_step({8, 2});
            // No step of eight of forty joints is cheaper than by its share of them.
            work += 2 * (0.07 + 0.93 * 8 / 40);
            if (!exactness.is_due()) continue;
            exactness.add_audit(error_pN, Vec3::Zero(), 12);
            audited += 13;
            ++audits;
        }
        return audits;
    };

    const int calm = play(34, 10000);
    CHECK(audited <= 0.25 * work + 13);
    CHECK(calm > 10);
    const double audited_before = audited, work_before = work;
    const int in_doubt = play(36, 10000);
    CHECK(in_doubt > 4 * calm);
    // What was saved up is three audits of 100 steps at most.
    CHECK(audited - audited_before <= 0.25 * (work - work_before) + 3 * 101);
    CHECK(audited <= 0.25 * work + 13);
}

TEST_CASE("an audit goes the way that all joints go", "[simulation][exactness]") {
    const Simulation simulation = load_simulation(
        scene_of_peptides({"statics.active=2", "hand.start_offset_angstrom=[-6, 0, 0]"}));
    REQUIRE(simulation.flexible);
    const Flexible& few = *simulation.flexible;
    Audit audit;
    start_audit(few.model, few.settings.step, few.state, 0, Vec3(1, 2, 3), few.grabbed, audit);
    REQUIRE(audit.is_under_way);
    for (int steps = 0; steps < 17; ++steps) {
        const Vec3 expected = force_of_all(few, steps);
        REQUIRE((audit.found - expected).norm() < 1e-9 * (1 + expected.norm()));
        step_audit(few.model, few.settings.step, few.grabbed, {0, 17}, audit);
    }

    CHECK_FALSE(audit.is_under_way);
    CHECK(audit.told == Vec3(1, 2, 3));
    CHECK(audit.is_finite);
}

TEST_CASE("an audit ends where the force hardly changes", "[simulation][exactness]") {
    const Simulation simulation = load_simulation(scene_of_peptides({"statics.active=2"}));
    REQUIRE(simulation.flexible);
    const Flexible& few = *simulation.flexible;
    Audit audit;
    start_audit(few.model, few.settings.step, few.state, 0, find_force_on_held(few), few.grabbed,
                audit);
    while (audit.is_under_way)
        step_audit(few.model, few.settings.step, few.grabbed, {10 / pico_per_kcal, 20}, audit);

    // Everything is at rest on loading.
    CHECK(audit.steps < 20);
    CHECK((audit.told - audit.found).norm() * pico_per_kcal < 30);
}

TEST_CASE("active joints follow the tolerance", "[simulation][exactness]") {
    const Played as_it_is = play({"statics.active=2"});
    const Played exact = play({"statics.active=2", "coupling.feel_within_pN=50"});
    const Played rough = play({"coupling.feel_within_pN=3000"});

    INFO(as_it_is.true_error_pN << " " << exact.true_error_pN << " " << rough.true_error_pN);
    CHECK(exact.errors_pN.size() > 5);
    CHECK(as_it_is.errors_pN.empty());
    CHECK(exact.effort.active >= 8);
    CHECK(std::ranges::count_if(exact.errors_pN, [](double error) { return error <= 50; }) >
          0.75 * static_cast<double>(exact.errors_pN.size()));
    CHECK(rough.effort.active < 32);
    CHECK(as_it_is.true_error_pN > 1000);
    CHECK(exact.true_error_pN < 100);
}

TEST_CASE("runs that watch how exact they are repeat to the bit", "[simulation][exactness]") {
    const std::vector<std::string> settings{"statics.active=4", "coupling.feel_within_pN=30",
                                            "statics.pairs=fast"};
    const Played first = play(settings), again = play(settings);

    CHECK(first.errors_pN == again.errors_pN);
    CHECK(first.positions == again.positions);
    CHECK(first.effort == again.effort);
}
