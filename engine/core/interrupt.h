// That somebody wants the program to end, by Ctrl-C or another signal: what has to end in order,
// above all with motors on, looks here.
#pragma once
#include <array>

namespace palpa {

// From now on SIGINT, SIGTERM and SIGHUP (on Windows SIGBREAK) are noted; the next of the same kind
// ends the program at once, as it always did. One that is ignored stays so.
void note_interrupts() noexcept;

// The newest of them; 0: none came.
int noted_interrupt() noexcept;

// While it lives these signals are only noted, so that the program can first remove what it must
// not leave behind; then a noted signal acts as it would have. Long work checks `noted_interrupt`
// meanwhile, or throws Interrupted.
class HeldInterrupts {
public:
    HeldInterrupts() noexcept;
    HeldInterrupts(const HeldInterrupts&) = delete;
    HeldInterrupts& operator=(const HeldInterrupts&) = delete;
    ~HeldInterrupts();

private:
    std::array<void (*)(int), 3> before_{};  // handlers
    bool holds_ = false;
};

struct Interrupted {};

// What a shell learns of a program that a signal ended, or else `code`.
inline int exit_code_after(int code) noexcept {
    return noted_interrupt() == 0 ? code : 128 + noted_interrupt();
}

}  // namespace palpa
