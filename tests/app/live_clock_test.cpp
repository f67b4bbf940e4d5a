#include "app/live_clock.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

using namespace palpa;

TEST_CASE("a wait for a period ends at its moment or when it is called", "[app]") {
    // Where condition variables are late it polls: for a part of the wait, or for all of it.
    const auto lateness = GENERATE(std::chrono::milliseconds(0), std::chrono::milliseconds(16),
                                   std::chrono::milliseconds(std::chrono::hours(2)));
    LiveClock clock(lateness);
    std::mutex mutex;
    std::condition_variable called;
    std::atomic<bool> is_called{false};
    const auto ask = [&] { return is_called.load(); };
    std::unique_lock<std::mutex> lock(mutex);

    const LiveClock::Moment moment = clock.now() + std::chrono::milliseconds(30);
    CHECK_FALSE(clock.wait_for_period(moment, lock, called, ask));
    CHECK(clock.now() >= moment);
    CHECK(lock.owns_lock());

    std::thread caller([&] {
        {
            const std::lock_guard held(mutex);
            is_called = true;
        }
        called.notify_one();
    });
    CHECK(clock.wait_for_period(clock.now() + std::chrono::hours(1), lock, called, ask));
    CHECK(lock.owns_lock());
    lock.unlock();
    caller.join();
}
