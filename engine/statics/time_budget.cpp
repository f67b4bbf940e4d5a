#include "statics/time_budget.h"

#include <algorithm>

namespace palpa {

void TimeBudget::add_step(double took_us) { steps_us_.push_back(took_us); }

void TimeBudget::add_choice(double took_us) noexcept { choice_us_ = took_us; }

std::size_t TimeBudget::find_freedom(std::size_t most) {
    double slow_us = 0;
    if (!steps_us_.empty()) {
        const auto rank =
            steps_us_.begin() + static_cast<std::ptrdiff_t>(steps_us_.size() * 9 / 10);
        std::nth_element(steps_us_.begin(), rank, steps_us_.end());
        slow_us = *rank;
    }
    // Between the two nothing changes, so that joints do not come and go.
    constexpr double too_slow = 0.85, fast = 0.6, wanted = 0.7, most_growth = 1.25;
    const double share = slow_us / budget_us_;
    if (share > too_slow) {
        freedom_ = std::max(least_freedom, freedom_ * std::max(0.25, wanted / share));
    } else if (slow_us > 0 && share < fast) {
        freedom_ = std::max(least_freedom, freedom_ * std::min(most_growth, wanted / share));
    }
    freedom_ = std::min(freedom_, static_cast<double>(most));
    steps_us_.clear();
    return static_cast<std::size_t>(freedom_);
}

std::size_t TimeBudget::find_interval(std::size_t usual) const noexcept {
    constexpr std::size_t rare = 150;
    return choice_us_ > budget_us_ ? std::max(usual, rare) : usual;
}

}  // namespace palpa
