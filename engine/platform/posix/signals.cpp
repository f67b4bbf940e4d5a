#include "platform/signals.h"

#include <csignal>

namespace palpa {

std::array<int, 3> ending_signals() noexcept { return {SIGINT, SIGTERM, SIGHUP}; }

}  // namespace palpa
