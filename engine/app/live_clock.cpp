#include "app/live_clock.h"

#include <thread>

namespace palpa {

LiveClock::Moment LiveClock::now() noexcept { return std::chrono::steady_clock::now(); }

// Asleep, and awake for the last bit, since the system wakes us late.
void LiveClock::wait_for_tick(Moment moment) {
    constexpr std::chrono::microseconds awake{80};
    std::this_thread::sleep_until(moment - awake);
    while (now() < moment) {
    }
}

bool LiveClock::wait_for_period(Moment moment, std::unique_lock<std::mutex>& lock,
                                std::condition_variable& called,
                                const std::function<bool()>& is_called) {
    return called.wait_until(lock, moment, is_called);
}

}  // namespace palpa
