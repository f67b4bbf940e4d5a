// Waits in a test for another thread.
#pragma once
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

namespace palpa::test {

// Waits for `condition` however slow the machine is; throws where it does not come at all.
template <class Condition>
void wait_until(const Condition& condition, const std::string& what = "what another thread does") {
    constexpr std::chrono::minutes longest(1);
    const auto begun = std::chrono::steady_clock::now();
    while (!condition()) {
        if (std::chrono::steady_clock::now() - begun > longest) {
            throw std::runtime_error("waited for a minute in vain: " + what);
        }
        // The core is left to the other thread.
        std::this_thread::sleep_for(std::chrono::microseconds(20));
    }
}

}  // namespace palpa::test
