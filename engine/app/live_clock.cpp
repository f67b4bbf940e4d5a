#include "app/live_clock.h"

#include <algorithm>

namespace palpa {

LiveClock::Moment LiveClock::now() noexcept { return std::chrono::steady_clock::now(); }

void LiveClock::wait_for_tick(Moment moment) { wait_awake_until(moment); }

bool LiveClock::wait_for_period(Moment moment, std::unique_lock<std::mutex>& lock,
                                std::condition_variable& called,
                                const std::function<bool()>& is_called) {
    if (called.wait_until(lock, moment - lateness_, is_called)) return true;
    while (now() < moment) {
        constexpr std::chrono::milliseconds between{1};
        lock.unlock();
        sleep_exactly_until(std::min(moment, now() + between));
        lock.lock();
        if (is_called()) return true;
    }
    return is_called();
}

}  // namespace palpa
