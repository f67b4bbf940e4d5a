// Priorities of threads, and memory that is never paged out.
#pragma once
#include <chrono>
#include <string_view>
#include <thread>

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

// Until that moment: asleep, and awake for the last 80 us, since a system wakes threads late.
inline void wait_awake_until(std::chrono::steady_clock::time_point moment) {
    constexpr std::chrono::microseconds awake{80};
    std::this_thread::sleep_until(moment - awake);
    while (std::chrono::steady_clock::now() < moment) {
    }
}

}  // namespace palpa
