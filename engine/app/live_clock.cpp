#include "app/live_clock.h"

#include "platform/thread.h"

namespace palpa {

LiveClock::Moment LiveClock::now() noexcept { return std::chrono::steady_clock::now(); }

void LiveClock::wait_for_tick(Moment moment) { wait_awake_until(moment); }

bool LiveClock::wait_for_period(Moment moment, std::unique_lock<std::mutex>& lock,
                                std::condition_variable& called,
                                const std::function<bool()>& is_called) {
    return called.wait_until(lock, moment, is_called);
}

}  // namespace palpa
