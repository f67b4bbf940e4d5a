// That somebody wants the program to end, by Ctrl-C or another signal: what has to end in order,
// above all with motors on, looks here.
#pragma once

namespace palpa {

// From now on SIGINT, SIGTERM and SIGHUP are noted; the next of the same kind ends the program at
// once, as it always did. One that is ignored stays so.
void note_interrupts() noexcept;

// The newest of them; 0: none came.
int noted_interrupt() noexcept;

// What a shell is told of a program that a signal ended, or else `code`.
inline int exit_code_after(int code) noexcept {
    return noted_interrupt() == 0 ? code : 128 + noted_interrupt();
}

}  // namespace palpa
