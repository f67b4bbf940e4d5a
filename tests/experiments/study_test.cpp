#include "experiments/study.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

using namespace palpa;

namespace {

constexpr std::array modes{CouplingMode::NoForce, CouplingMode::Guarded,
                           CouplingMode::VariableForceConstantDisplacement,
                           CouplingMode::ConstantForceConstantDisplacement};

}  // namespace

TEST_CASE("every round has every mode once, in an order of its own", "[experiments][study]") {
    std::set<std::vector<CouplingMode>> orders;
    std::array<int, modes.size()> first{};
    constexpr std::size_t participants = 400, rounds = 3;
    for (std::size_t who = 1; who <= participants; ++who) {
        const std::vector<StudyTrial> trials = plan_study(who, rounds, modes, 7);
        REQUIRE(trials.size() == rounds * modes.size());
        for (std::size_t round = 0; round < rounds; ++round) {
            std::vector<CouplingMode> order;
            for (std::size_t i = 0; i < modes.size(); ++i) {
                const StudyTrial& trial = trials[round * modes.size() + i];
                CHECK(trial.participant == who);
                CHECK(trial.round == round + 1);
                CHECK(trial.place == i + 1);
                order.push_back(trial.mode);
            }
            orders.insert(order);
            ++first[static_cast<std::size_t>(std::ranges::find(modes, order[0]) - modes.begin())];
            CHECK(std::ranges::is_permutation(order, modes));
        }
    }

    CHECK(orders.size() == 24);
    // Each first in a quarter of 1200 rounds: 300, four standard deviations of 15.
    for (const int count : first) CHECK(std::abs(count - 300) < 60);
    CHECK(plan_study(3, 2, modes, 7) == plan_study(3, 2, modes, 7));
    CHECK(plan_study(3, 9, modes, 7) != plan_study(3, 9, modes, 8));
}

TEST_CASE("a spread is mean, median and sample deviation", "[experiments][study]") {
    const std::array odd{9.0, 1.0, 2.0};

    const Spread spread = find_spread(odd);

    CHECK(spread.mean == Approx(4));
    CHECK(spread.median == 2);
    CHECK(spread.deviation.value() == Approx(std::sqrt((25.0 + 9 + 4) / 2)));
    CHECK(find_spread({}).mean == 0);
}

TEST_CASE("no two trials share their draws", "[experiments][study]") {
    std::set<std::uint64_t> numbers;
    std::size_t count = 0;
    for (std::size_t who = 1; who <= 20; ++who) {
        CHECK(numbers.insert(participant_number(who)).second);
        for (const StudyTrial& trial : plan_study(who, 5, modes, 1)) {
            CHECK(numbers.insert(trial_number(trial)).second);
            ++count;
        }
    }
    CHECK(count == std::size_t{20} * 5 * modes.size());
}

TEST_CASE("a mode's row has means and sample deviations, and the table says so",
          "[experiments][study]") {
    std::vector<StudyResult> results;
    const auto add = [&](CouplingMode mode, double off, double seconds, bool finished) {
        StudyResult result;
        result.trial.mode = mode;
        result.off_angstrom = off;
        result.seconds = seconds;
        result.is_finished = finished;
        results.push_back(result);
    };
    add(CouplingMode::Guarded, -0.1, 4, true);
    add(CouplingMode::NoForce, 1, 3, true);
    add(CouplingMode::Guarded, 0.3, 10, false);
    results.back().went_through = true;

    const std::vector<StudyRow> rows = summarise_study(modes, results);

    REQUIRE(rows.size() == 2);
    CHECK(rows[0].mode == CouplingMode::NoForce);
    CHECK(!rows[0].distance_angstrom.deviation);
    CHECK(rows[1].trials == 2);
    CHECK(rows[1].distance_angstrom.mean == Approx(0.2));
    CHECK(rows[1].off_angstrom.mean == Approx(0.1));
    CHECK(rows[1].off_angstrom.median == Approx(0.1));
    CHECK(rows[1].off_angstrom.deviation.value() == Approx(0.4 / std::sqrt(2)));
    CHECK(rows[1].time_s.mean == Approx(7));
    CHECK(rows[1].finished_share == 0.5);
    CHECK(rows[1].through_share == 0.5);
    CHECK(
        format_study_table(rows).find(
            "| guarded | 2 | 0.2000 ± 0.1414 | 0.2000 | 0.1000 ± 0.2828 | 7.0 ± 4.2 | 50 | 50 |") !=
        std::string::npos);
    CHECK(format_trials(results).find("\n1,1,1,5,0.0000,0.00000,1.00000,1.00000,3.000,1,0\n") !=
          std::string::npos);
}
