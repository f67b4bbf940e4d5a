#include "core/interrupt.h"

#include "platform/signals.h"

#include <atomic>
#include <csignal>
#include <cstddef>

namespace palpa {
namespace {

std::atomic<int> noted = 0;
static_assert(std::atomic<int>::is_always_lock_free);  // or a handler must not touch it

using Handler = void (*)(int);

void note(int signal) {
    noted = signal;
    (void)std::signal(signal, SIG_DFL);
}

// The handler before.
Handler take(int signal) noexcept {
    const Handler before = std::signal(signal, note);
    // nohup, and shells for what runs in the background, have it ignored.
    if (before == SIG_IGN) (void)std::signal(signal, SIG_IGN);
    return before;
}

}  // namespace

void note_interrupts() noexcept {
    for (const int signal : ending_signals()) (void)take(signal);
}

int noted_interrupt() noexcept { return noted; }

HeldInterrupts::HeldInterrupts() noexcept {
    if (noted != 0) return;  // the next of them ends the program at once, and still does
    const std::array interrupts = ending_signals();
    for (std::size_t i = 0; i < interrupts.size(); ++i) before_[i] = take(interrupts[i]);
    holds_ = true;
}

HeldInterrupts::~HeldInterrupts() {
    if (!holds_) return;
    const std::array interrupts = ending_signals();
    for (std::size_t i = 0; i < interrupts.size(); ++i) {
        if (before_[i] != SIG_ERR) (void)std::signal(interrupts[i], before_[i]);
    }
    if (noted != 0) (void)std::raise(noted);
}

}  // namespace palpa
