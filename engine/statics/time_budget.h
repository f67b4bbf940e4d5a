// Limits the number of active degrees of freedom so that steps keep within a time.
#pragma once
#include <cstddef>
#include <vector>

namespace palpa {

// Measures the time of steps and returns the number of degrees of freedom for the next selection.
// The cost of a step depends on its pairs, and these on the selection, so it is measured and not
// predicted.
class TimeBudget {
public:
    explicit TimeBudget(double budget_us) noexcept : budget_us_(budget_us) {}

    // Records a step without selection or renewal, and one with a selection.
    void add_step(double took_us);
    void add_choice(double took_us) noexcept;

    // Called before a selection: uses the time that nine of ten steps since the last selection did
    // not exceed.
    std::size_t find_freedom(std::size_t most);

    // Steps between two selections, `usual` if possible. If a selection takes longer than the
    // budget, the interval is long enough that 99 % of all steps keep within it.
    std::size_t find_interval(std::size_t usual) const noexcept;

private:
    double budget_us_;
    std::vector<double> steps_us_;  // since the last selection
    double choice_us_ = 0;          // time of the last selection
    // Fewer degrees of freedom save hardly any time, and what cannot relax is soon pushed into
    // other atoms.
    static constexpr double least_freedom = 8;
    double freedom_ = least_freedom;
};

}  // namespace palpa
