#include "platform/thread.h"

#include <windows.h>
// After windows.h, whose words it uses.
#include <timeapi.h>

namespace palpa {

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

}  // namespace palpa
