// Priorities of threads, and memory that is never paged out.
#pragma once
#include <chrono>
#include <string_view>

namespace palpa {

// Requests real-time priority for the calling thread, for wake-ups on the millisecond; false if the
// system refuses.
bool ask_for_real_time() noexcept;

// Locks the memory of the program, also later pages, in RAM; false if the system refuses.
bool ask_for_locked_memory() noexcept;

// What a user does for both to be granted; empty where nothing can be done.
std::string_view real_time_remedy() noexcept;

// The calling thread, and on POSIX those that it starts, after other threads, by so many steps of
// nice; drawing by 5.
void lower_priority(int steps = 5) noexcept;

// Sleeps until that moment as exactly as the system can; never shorter.
void sleep_exactly_until(std::chrono::steady_clock::time_point moment);

// How late a condition variable may end a wait for a time. Callers that must not be late stop
// waiting this much earlier, and sleep.
std::chrono::milliseconds condition_lateness() noexcept;

// Until that moment: asleep, and awake for the last 80 us, since a system wakes threads late.
inline void wait_awake_until(std::chrono::steady_clock::time_point moment) {
    constexpr std::chrono::microseconds awake{80};
    sleep_exactly_until(moment - awake);
    while (std::chrono::steady_clock::now() < moment) {
    }
}

}  // namespace palpa
