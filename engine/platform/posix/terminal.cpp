#include "platform/terminal.h"

#include <unistd.h>

namespace palpa {

bool is_terminal(std::FILE* stream) noexcept { return isatty(fileno(stream)) != 0; }

}  // namespace palpa
