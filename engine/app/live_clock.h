// The time that the threads of a live session run by. Tests put a clock in its place that does not
// depend on the machine.
#pragma once
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>

namespace palpa {

class LiveClock {
public:
    using Moment = std::chrono::steady_clock::time_point;

    LiveClock() = default;
    LiveClock(const LiveClock&) = delete;
    LiveClock& operator=(const LiveClock&) = delete;
    virtual ~LiveClock() = default;

    virtual Moment now() noexcept;

    // The servo's thread, until its next tick.
    virtual void wait_for_tick(Moment moment);

    // The simulation's thread, until its next period or until `is_called`, which `called`
    // announces. Returns is_called().
    virtual bool wait_for_period(Moment moment, std::unique_lock<std::mutex>& lock,
                                 std::condition_variable& called,
                                 const std::function<bool()>& is_called);
};

}  // namespace palpa
