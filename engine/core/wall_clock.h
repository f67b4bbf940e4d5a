// Wall time, for connections and timeouts.
#pragma once
#include <chrono>

namespace palpa {

// Monotonic time in seconds from an arbitrary origin.
inline double wall_clock_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

}  // namespace palpa
