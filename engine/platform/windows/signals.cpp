#include "platform/signals.h"

#include <csignal>

namespace palpa {

// SIGBREAK is Ctrl+Break, and a console whose window is closed.
std::array<int, 3> ending_signals() noexcept { return {SIGINT, SIGTERM, SIGBREAK}; }

}  // namespace palpa
