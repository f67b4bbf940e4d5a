#include "platform/terminal.h"

#include <io.h>

namespace palpa {

bool is_terminal(std::FILE* stream) noexcept { return _isatty(_fileno(stream)) != 0; }

std::optional<std::size_t> read_standard_input(std::span<char> buffer,
                                               int /*timeout_ms*/) noexcept {
    const int count = _read(0, buffer.data(), static_cast<unsigned>(buffer.size()));
    return count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace palpa
