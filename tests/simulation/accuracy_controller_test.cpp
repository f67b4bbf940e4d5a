#include "statics/accuracy_controller.h"

#include "core/units.h"
#include "loading/edit.h"
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/mechanics.h"
#include "simulation/solver.h"
#include "simulation/step.h"
#include "tests/support/paths.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr std::span<const Vec3> none;  // no hand

constexpr double pico_per_kcal = units::newton_per_kcal_per_mol_angstrom * 1e12;

// Two tetrapeptides 11 Å apart, of 32 joints.
SceneDescription scene_of_peptides(const std::vector<std::string>& settings) {
    return read_scene(test::test_data("two_peptides"), settings);
}

struct Played {
    std::vector<double> errors_pN;  // that error estimates found
    std::vector<Vec3> positions;
    WorkBudget work_budget;
    double true_error_pN = 0;  // at the end
};

// The force on the hand after complete relaxation in double, kcal/mol/Å.
Vec3 relaxed_force(const World& world) {
    const TorsionModel& model = model_of(world);
    TorsionState state = world.resource<TorsionState>();
    RelaxSettings settings;
    settings.force_tolerance = 1e-4;
    settings.steps = 20000;
    QuasiStatics statics = build_quasi_statics(model);
    (void)relax_joints(model, settings, state, statics);
    return find_force_on_held(model, state, held_in_state(world, hand_at(world, 0)));
}

// The hand goes 2 Å towards the other molecule, and stays.
Played play(const std::vector<std::string>& settings) {
    World world = load_world(scene_of_peptides(settings));
    ContactModel felt = contact_at(world, 0).model;
    Played played;
    for (int i = 1; i <= 2000; ++i) {
        HandPose hand;
        hand.travel_m = Vec3(-0.001 * i * 0.25e9 * 1e-10, 0, 0);
        const StepReport& report = step_world(world, hand, felt);
        felt = contact_at(world, 0).model;
        REQUIRE(report.relaxed);
        if (const auto error_pN = report.relaxed->estimated_error_pN)
            played.errors_pN.push_back(*error_pN);
    }
    REQUIRE(has_mobile(world));
    REQUIRE(find_solver<PaperStep>(world));
    if (find_solver<PaperStep>(world)->accuracy)
        played.work_budget = find_solver<PaperStep>(world)->accuracy->work_budget();
    played.positions = world.resource<AtomTable>().positions;
    played.true_error_pN =
        pico_per_kcal *
        (find_force_on_held(world, hand_at(world, 0)) - relaxed_force(world)).norm();
    return played;
}

}  // namespace

TEST_CASE("too much error raises active joints by half, then steps", "[simulation][accuracy]") {
    const bool has_budget = GENERATE(false, true);
    AccuracyController accuracy(50, {10, 2}, 40, has_budget);
    const auto after = [&](double error_pN) {
        accuracy.add_estimate(error_pN, none, 20);
        return accuracy.work_budget();
    };

    CHECK(accuracy.work_budget() == WorkBudget{10, 2});
    CHECK(after(36) == WorkBudget{16, 2});
    CHECK(after(139) == WorkBudget{39, 2});
    CHECK(after(36) == WorkBudget{40, 2});
    // Where time is what there is too little of, more steps would only take it from joints.
    CHECK(after(36) == WorkBudget{40, has_budget ? 2U : 3U});
    for (int i = 0; i < 10; ++i) (void)after(36);
    CHECK(accuracy.work_budget() ==
          WorkBudget{40, has_budget ? 2U : AccuracyController::most_steps});
    CHECK(accuracy.error() == 36.0);
}

TEST_CASE("less than half the error gives back steps, then joints, by a fifth",
          "[simulation][accuracy]") {
    AccuracyController accuracy(50, {40, 2}, 40, false);
    double rendered_pN = 0;
    const auto after_calm = [&](double error_pN) {
        for (int i = 0; i < 5; ++i)
            accuracy.add_estimate(error_pN, std::array{Vec3(rendered_pN += 20, 0, 0)}, 20);
        return accuracy.work_budget();
    };
    accuracy.add_estimate(60, none, 20);
    REQUIRE(accuracy.work_budget() == WorkBudget{40, 3});

    CHECK(after_calm(17) == WorkBudget{40, 2});
    CHECK(after_calm(17) == WorkBudget{32, 2});
    CHECK(after_calm(17) == WorkBudget{25, 2});
    // Between half and all of it everything stays.
    CHECK(after_calm(18) == WorkBudget{25, 2});
    for (int i = 0; i < 40; ++i) (void)after_calm(17);
    CHECK(accuracy.work_budget() == WorkBudget{8, 2});
}

TEST_CASE("of many steps a fifth is given back at a time", "[simulation][accuracy]") {
    AccuracyController accuracy(50, {40, 2}, 40, false);
    for (int i = 0; i < 30; ++i) accuracy.add_estimate(60, std::array{Vec3(0, 0, 0)}, 20);
    REQUIRE(accuracy.work_budget() == WorkBudget{40, AccuracyController::most_steps});
    static_assert(AccuracyController::most_steps == 20);

    std::vector<std::size_t> seen{accuracy.work_budget().steps};
    for (int i = 0; i < 60 && seen.size() < 4; ++i) {
        accuracy.add_estimate(17, std::array{Vec3(20.0 * i, 0, 0)}, 20);
        if (accuracy.work_budget().steps != seen.back())
            seen.push_back(accuracy.work_budget().steps);
    }

    CHECK(seen == std::vector<std::size_t>{20, 16, 12, 9});
    CHECK(accuracy.work_budget().active == 40);
}

TEST_CASE("an error without bounds raises everything, and ends", "[simulation][accuracy]") {
    const double error_pN =
        GENERATE(std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN());
    AccuracyController joints_and_steps(50, {8, 2}, 40, false), joints(50, {8, 2}, 40, true);

    joints_and_steps.add_estimate(error_pN, none, 20);
    joints.add_estimate(error_pN, none, 20);

    CHECK(joints_and_steps.work_budget() == WorkBudget{40, AccuracyController::most_steps});
    CHECK(joints.work_budget() == WorkBudget{40, 2});
}

TEST_CASE("while the hand rests nothing is proven", "[simulation][accuracy]") {
    AccuracyController accuracy(50, {40, 2}, 40, false);
    for (int i = 0; i < 100; ++i)
        accuracy.add_estimate(1, std::array{Vec3(i % 2 == 0 ? 0 : 49, 0, 0)}, 20);

    CHECK(accuracy.work_budget() == WorkBudget{40, 2});
    accuracy.add_estimate(1, std::array{Vec3(51, 0, 0)}, 20);
    CHECK(accuracy.work_budget() == WorkBudget{32, 2});
}

TEST_CASE(
    "error estimates are a fifth of all work at most, rarer where it is calm, at once where not",
    "[simulation][accuracy]") {
    AccuracyController accuracy(50, {8, 2}, 40, false);
    double work = 0, estimated = 0;
    const auto play = [&](double error_pN, int steps) {
        int estimates = 0;
        for (int i = 0; i < steps; ++i) {
            accuracy.add_step({8, 2});
            // No step of eight of forty joints is cheaper than by its share of them.
            work += 2 * (0.07 + 0.93 * 8 / 40);
            if (!accuracy.is_due()) continue;
            accuracy.add_estimate(error_pN, none, 12);
            estimated += 13;
            ++estimates;
        }
        return estimates;
    };

    const int calm = play(34, 10000);
    CHECK(estimated <= 0.25 * work + 13);
    CHECK(calm > 10);
    const double estimated_before = estimated, work_before = work;
    const int in_doubt = play(36, 10000);
    CHECK(in_doubt > 4 * calm);
    // What was saved up is three error estimates of 100 steps at most.
    CHECK(estimated - estimated_before <= 0.25 * (work - work_before) + 3 * 101);
    CHECK(estimated <= 0.25 * work + 13);
}

// Moves that leave errors of 10 to 2,000 pN, of the molecule or of a spring at one of its atoms.
TEST_CASE("an error estimate is the difference from complete relaxation",
          "[simulation][accuracy]") {
    const bool is_by_spring = GENERATE(false, true);
    std::size_t right = 0, states = 0;
    for (int i = 0; i < 12; ++i) {
        World few = load_world(
            scene_of_peptides({"statics.active=0", "hand.start_offset_angstrom=[-6, 0, 0]"}));
        // Within the molecule, so that it does not pull at the whole.
        RestraintEdit{{"held:1", "held:4"}, {}, 30, 3}.apply(few, 0);
        if (is_by_spring) GrabEdit{"held:2"}.apply(few, 0);
        move_held(few, (0.05 + 0.03 * i) * Vec3::Unit(i % 3));
        (void)relax_mobile(few, {}).value();
        const Vec3 felt = find_force_on_held(few, hand_at(few, 0));
        find_error(few);
        const std::optional<double> found = find_error_estimate(few, hand_at(few, 0));
        REQUIRE(found);
        const double expected = pico_per_kcal * (felt - relaxed_force(few)).norm();
        INFO(*found << " pN found, " << expected << " expected");
        if (expected < 10) continue;
        ++states;
        if (*found < 2 * expected && expected < 2 * *found) ++right;
    }
    CHECK(states >= 9);
    CHECK(6 * right >= 5 * states);
}

TEST_CASE("active joints follow the tolerance", "[simulation][accuracy]") {
    const Played as_it_is = play({"statics.active=2"});
    const Played exact = play({"statics.active=2", "coupling.feel_within_pN=50"});
    const Played rough = play({"coupling.feel_within_pN=100000"});

    INFO(as_it_is.true_error_pN << " " << exact.true_error_pN << " " << rough.true_error_pN);
    CHECK(exact.errors_pN.size() > 5);
    CHECK(as_it_is.true_error_pN > 1000);
    CHECK(exact.true_error_pN < 50);
    CHECK(exact.work_budget.active >= 8);
    // While the hand moves, the paper's steps do not hold it always.
    CHECK(std::ranges::count_if(exact.errors_pN, [](double error) { return error <= 50; }) >
          0.5 * static_cast<double>(exact.errors_pN.size()));
    CHECK(rough.true_error_pN > exact.true_error_pN);
}

TEST_CASE("runs that watch how exact they are repeat to the bit", "[simulation][accuracy]") {
    const std::vector<std::string> settings{"statics.active=4", "coupling.feel_within_pN=30",
                                            "statics.pairs=fast"};
    const Played first = play(settings), again = play(settings);

    CHECK(first.errors_pN == again.errors_pN);
    CHECK(first.positions == again.positions);
    CHECK(first.work_budget == again.work_budget);
}
