// What is worth knowing of a run, gathered tick by tick.
#pragma once
#include "haptics/servo.h"
#include "session/ripple.h"

#include <cstdint>
#include <string>
#include <vector>

namespace palpa {

struct Summary {
    std::uint64_t ticks = 0, steps = 0;
    std::uint64_t steps_not_finite = 0;
    double step_median_us = 0, step_p99_us = 0;  // wall time
    Ripple ripple;                               // of the device force along x, last 4 s
    double net_work_J = 0;                       // done on the hand; + = generated
    double largest_attraction_N = 0;             // felt, along -x
    double largest_repulsion_N = 0;              // felt, along +x
    double closest_angstrom = 0, last_angstrom = 0;
    double clamped_share = 0;  // of the time
    bool stopped = false;      // a force was not finite
    std::vector<std::string> warnings;
};

class Statistics {
public:
    // `tick_s`: of the servo; `ticks`: how many are expected, for the memory.
    Statistics(double tick_s, std::uint64_t ticks);

    void add(const ServoTick& tick);
    void add_step(double seconds, bool finite);

    Summary summary() const;

private:
    double tick_s_;
    Summary running_;
    std::uint64_t clamped_ticks_ = 0;
    std::vector<double> force_;  // along x, N
    std::vector<double> step_us_;
};

}  // namespace palpa
