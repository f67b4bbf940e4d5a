#include "platform/thread.h"

#include <windows.h>
// After windows.h, whose words it uses.
#include <timeapi.h>
#include <ratio>
#include <thread>

namespace palpa {
namespace {

// A thread's timer of fractions of a millisecond, which Windows has since 10 (1803).
struct ExactTimer {
    static constexpr DWORD high_resolution = 2;  // CREATE_WAITABLE_TIMER_HIGH_RESOLUTION
    HANDLE handle = CreateWaitableTimerExW(nullptr, nullptr, high_resolution, TIMER_ALL_ACCESS);

    ExactTimer() {
        if (!handle) handle = CreateWaitableTimerW(nullptr, FALSE, nullptr);
    }
    ExactTimer(const ExactTimer&) = delete;
    ExactTimer& operator=(const ExactTimer&) = delete;
    ~ExactTimer() { CloseHandle(handle); }
};

}  // namespace

bool ask_for_real_time() noexcept {
    // Else a thread that sleeps for a millisecond wakes after 16.
    const bool is_woken = timeBeginPeriod(1) == TIMERR_NOERROR;
    return SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_TIME_CRITICAL) != 0 && is_woken;
}

// Windows locks single ranges, not what is to come.
bool ask_for_locked_memory() noexcept { return false; }

std::string_view real_time_remedy() noexcept { return {}; }

void lower_priority(int /*steps*/) noexcept {
    (void)SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL);
}

void sleep_exactly_until(std::chrono::steady_clock::time_point moment) {
    using Ticks = std::chrono::duration<LONGLONG, std::ratio<1, 10'000'000>>;  // of 100 ns
    const thread_local ExactTimer timer;
    while (true) {
        const auto left = std::chrono::ceil<Ticks>(moment - std::chrono::steady_clock::now());
        if (left.count() <= 0) return;
        LARGE_INTEGER due;
        due.QuadPart = -left.count();  // from now
        if (!SetWaitableTimer(timer.handle, &due, 0, nullptr, nullptr, FALSE))
            return std::this_thread::sleep_until(moment);
        WaitForSingleObject(timer.handle, INFINITE);
    }
}

// The clock's ticks are 16 ms apart where no program has asked for shorter ones.
std::chrono::milliseconds condition_lateness() noexcept { return std::chrono::milliseconds(16); }

}  // namespace palpa
