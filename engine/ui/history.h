// The last seconds of a session, thinned, for the plots.
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

    // Every tick in its order; one of ten is kept. Where the clock goes back, of another device, it
    // begins anew.
    void add(const Reading& reading);

    // Those of the last seconds, in the order of time.
    std::span<const Reading> samples() const noexcept;

private:
    std::vector<Reading> samples_;
    int ticks_ = 0;
};

}  // namespace palpa
