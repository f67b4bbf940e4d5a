#include "statics/time_budget.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <random>

using namespace palpa;

TEST_CASE("steps keep within their time whatever a degree of freedom costs",
          "[statics][adaptive]") {
    const double budget_us = GENERATE(300.0, 2000.0), each_us = GENERATE(1.0, 5.0, 20.0);
    TimeBudget budget(budget_us);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> noise(0.9, 1.1);
    std::size_t freedom = 0, slow = 0, most = 0;

    // Fixed costs of 100 us; a choice costs 1 ms.
    for (int choice = 0; choice < 200; ++choice) {
        freedom = budget.find_freedom(800);
        budget.add_choice(1000);
        const std::size_t steps = budget.find_interval(10);
        for (std::size_t i = 1; i < steps; ++i) {
            const double took = (100 + each_us * static_cast<double>(freedom)) * noise(random);
            budget.add_step(took);
            if (choice > 30 && took > budget_us) ++slow;
        }
        most = std::max(most, freedom);
    }

    CHECK(slow == 0);
    // More than half of the time is used, if there are as many.
    const double used = 100 + each_us * static_cast<double>(freedom);
    if (freedom < 800) CHECK(used > 0.4 * budget_us);
    CHECK(most <= 800);
    CHECK(budget.find_interval(10) == (budget_us < 1000 ? 150 : 10));
}

TEST_CASE("where there is no time at all a few stay active", "[statics][adaptive]") {
    TimeBudget budget(1);
    for (int choice = 0; choice < 10; ++choice) {
        CHECK(budget.find_freedom(800) == 8);
        budget.add_step(50);
    }
    CHECK(TimeBudget(1).find_freedom(3) == 3);
}
