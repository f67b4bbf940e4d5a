// A thinned record of the last seconds of a session, for the plots.
#pragma once
#include "session/reading.h"

#include <cstddef>
#include <span>
#include <vector>

namespace palpa {

class History {
public:
    static constexpr double seconds = 10;
    static constexpr int ticks_per_sample = 10;

    // Call for every tick in order; one of ten is stored. If the clock goes back (another device),
    // the record restarts.
    void add(const Reading& reading);

    // The stored readings in the order of time.
    std::span<const Reading> samples() const noexcept;

private:
    std::vector<Reading> samples_;
    int ticks_ = 0;
};

}  // namespace palpa
