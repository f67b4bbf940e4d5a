// The clock of the threads of a live session. Tests replace it by one that does not depend on the
// machine.
#pragma once
#include "platform/thread.h"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>

namespace palpa {

class LiveClock {
public:
    using Moment = std::chrono::steady_clock::time_point;

    // `lateness`: how much later than asked a condition variable may end a wait.
    explicit LiveClock(std::chrono::milliseconds lateness = condition_lateness())
        : lateness_(lateness) {}
    LiveClock(const LiveClock&) = delete;
    LiveClock& operator=(const LiveClock&) = delete;
    virtual ~LiveClock() = default;

    virtual Moment now() noexcept;

    // Called by the servo's thread: waits until its next tick.
    virtual void wait_for_tick(Moment moment);

    // Called by the simulation's thread: waits until its next period or until `is_called`, which
    // `called` announces. Returns is_called().
    virtual bool wait_for_period(Moment moment, std::unique_lock<std::mutex>& lock,
                                 std::condition_variable& called,
                                 const std::function<bool()>& is_called);

private:
    std::chrono::milliseconds lateness_;
};

}  // namespace palpa
