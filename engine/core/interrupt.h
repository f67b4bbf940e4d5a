// Ends the program in order after Ctrl-C or another signal, above all while motors are on.
#pragma once
#include <array>

namespace palpa {

// From now on SIGINT, SIGTERM and SIGHUP (on Windows SIGBREAK) are only noted; a second signal of
// the same kind ends the program at once. A signal that is ignored stays ignored.
void note_interrupts() noexcept;

// The newest noted signal; 0: none.
int noted_interrupt() noexcept;

// While it exists these signals are only noted, so that the program can first remove temporary
// files; afterwards a noted signal takes effect. Long work calls `noted_interrupt` meanwhile, or
// throws Interrupted.
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

// The exit code of the program: 128 + the signal that ended it, or else `code`.
inline int exit_code_after(int code) noexcept {
    return noted_interrupt() == 0 ? code : 128 + noted_interrupt();
}

}  // namespace palpa
