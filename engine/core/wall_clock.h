// Wall time, for connections and whoever waits for them.
#pragma once
#include <chrono>

namespace palpa {

// Seconds since some moment; never goes back.
inline double wall_clock_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace palpa
