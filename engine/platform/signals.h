// Signals by which a person or the system ends a program.
#pragma once
#include <array>

namespace palpa {

// Ctrl+C, a request to end, and a terminal that closes.
std::array<int, 3> ending_signals() noexcept;

}  // namespace palpa
