#include "core/interrupt.h"

#include <atomic>
#include <csignal>

namespace palpa {
namespace {

std::atomic<int> noted = 0;
static_assert(std::atomic<int>::is_always_lock_free);  // or a handler must not touch it

void note(int signal) {
    noted = signal;
    (void)std::signal(signal, SIG_DFL);
}

void take(int signal) {
    // nohup, and shells for what runs in the background, have it ignored.
    if (std::signal(signal, note) == SIG_IGN) (void)std::signal(signal, SIG_IGN);
}

}  // namespace

void note_interrupts() noexcept {
    take(SIGINT);
    take(SIGTERM);
#ifdef SIGHUP
    take(SIGHUP);
#endif
}

int noted_interrupt() noexcept { return noted; }

}  // namespace palpa
