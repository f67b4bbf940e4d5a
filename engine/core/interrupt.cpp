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

}  // namespace

void note_interrupts() noexcept {
    (void)std::signal(SIGINT, note);
    (void)std::signal(SIGTERM, note);
#ifdef SIGHUP
    (void)std::signal(SIGHUP, note);
#endif
}

int noted_interrupt() noexcept { return noted; }

}  // namespace palpa
