#include "platform/thread.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>
#include <thread>

namespace palpa {

bool ask_for_real_time() noexcept {
    sched_param parameters{};
    parameters.sched_priority = 50;
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

bool ask_for_locked_memory() noexcept {
#ifdef MCL_ONFAULT
    return mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
#else
    return false;  // all memory that is reserved would be taken at once
#endif
}

std::string_view real_time_remedy() noexcept {
    return "as root write '@plugdev - rtprio 50' and '@plugdev - memlock unlimited' into "
           "/etc/security/limits.d/70-palpa.conf, be in the group plugdev, and log in again";
}

void lower_priority(int steps) noexcept { (void)!nice(steps); }

void sleep_exactly_until(std::chrono::steady_clock::time_point moment) {
    std::this_thread::sleep_until(moment);
}

std::chrono::milliseconds condition_lateness() noexcept { return std::chrono::milliseconds(0); }

}  // namespace palpa
