// The first of the scenarios that `palpa-lab scenarios` plays, and that its limits can be missed.
#include "tools/lab/experiments/scenarios.h"
#include "tests/support/paths.h"

#include <catch2/catch.hpp>

using namespace palpa;

namespace {

const std::string two_waters = test::in_project("scenes/water");

void play_random_hands(std::size_t count) {
    const std::vector<ScenarioResult> results =
        play_scenarios({.scene = two_waters, .settings = {}, .count = count}, {});

    REQUIRE(results.size() == count);
    for (std::size_t i = 0; i < results.size(); ++i) {
        const ScenarioResult& result = results[i];
        INFO("scenario " << i << ": " << result.generated_J << " J, " << result.ripple_N << " N, "
                         << result.closest_angstrom << " A");
        CHECK(result.is_calm());
        // 10 nN, 3 bodies that share it.
        CHECK(result.closest_angstrom > 2.29);
    }
}

}  // namespace

TEST_CASE("100 random hands on two waters: no energy from nothing, no vibration, none goes through",
          "[experiments][coupling]") {
    play_random_hands(100);
}

TEST_CASE("500 random hands on two waters keep the same limits", "[experiments][long]") {
    play_random_hands(500);
}

TEST_CASE("the paper's coupling misses the limits of the scenarios", "[experiments][coupling]") {
    const std::vector<ScenarioResult> results =
        play_scenarios({.scene = two_waters, .settings = {"coupling.mode=2"}, .count = 20}, {});

    std::size_t calm = 0;
    for (const ScenarioResult& result : results) calm += result.is_calm() ? 1 : 0;
    CHECK(calm < 15);
}

TEST_CASE(
    "60 disturbed hands on two waters: force stays within clamp and slew, and no stretch that "
    "nothing disturbs generates energy",
    "[experiments][coupling]") {
    const std::vector<ScenarioResult> results = play_scenarios(
        {.scene = two_waters, .settings = {}, .count = 60, .is_disturbed = true}, {});

    std::size_t faults = 0, edits = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const ScenarioResult& result = results[i];
        INFO("scenario " << i << ": " << result.generated_J << " J, " << result.ripple_N << " N, "
                         << result.most_newton << " N, " << result.most_change_newton
                         << " N a tick");
        CHECK(result.is_calm());
        faults += result.faults;
        edits += result.edits;
    }
    CHECK(faults > 15);
    CHECK(edits > 30);
}

TEST_CASE("the paper's coupling misses the limits of disturbed scenarios too",
          "[experiments][coupling]") {
    const std::vector<ScenarioResult> results = play_scenarios(
        {.scene = two_waters, .settings = {"coupling.mode=2"}, .count = 20, .is_disturbed = true},
        {});

    std::size_t calm = 0, within_slew = 0;
    for (const ScenarioResult& result : results) {
        calm += result.is_calm() ? 1 : 0;
        within_slew += result.most_change_newton <= most_slew_newton ? 1 : 0;
    }
    CHECK(calm < 15);
    CHECK(within_slew < 20);  // its force jumps once a period
}

TEST_CASE("a scenario is the same whatever is played beside it", "[experiments][coupling]") {
    const ScenarioOptions options{.scene = two_waters, .settings = {"run.seconds=2"}};

    const ScenarioResult one = play_scenario(options, 7), again = play_scenario(options, 7);

    CHECK(one.settings == again.settings);
    CHECK(one.generated_J == again.generated_J);
    CHECK(one.settings != play_scenario(options, 8).settings);
}
