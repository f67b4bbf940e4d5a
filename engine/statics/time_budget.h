// How many degrees of freedom may be active so that steps keep within a time.
#pragma once
#include <cstddef>
#include <vector>

namespace palpa {

// Watches how long steps take and says how many degrees of freedom the next choice may have. What a
// step costs goes by pairs, which go by what was chosen; so it is measured, not foretold.
class TimeBudget {
public:
    explicit TimeBudget(double budget_us) noexcept : budget_us_(budget_us) {}

    // A step in which nothing was chosen or renewed, and one in which joints were.
    void add_step(double took_us);
    void add_choice(double took_us) noexcept;

    // Before a choice: from how long nine of ten steps since the last one took at most.
    std::size_t find_freedom(std::size_t most);

    // Steps between two choices, of which `usual` are wanted. Where a choice takes longer than the
    // budget there is one in so many that 99 % of all keep within it.
    std::size_t find_interval(std::size_t usual) const noexcept;

private:
    double budget_us_;
    std::vector<double> steps_us_;  // since the last choice
    double choice_us_ = 0;          // the last
    // Fewer hardly cost less, and what cannot relax is soon pushed into others.
    static constexpr double least_freedom = 8;
    double freedom_ = least_freedom;
};

}  // namespace palpa
