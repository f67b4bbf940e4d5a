#include "platform/terminal.h"

#include <io.h>

namespace palpa {

bool is_terminal(std::FILE* stream) noexcept { return _isatty(_fileno(stream)) != 0; }

}  // namespace palpa
