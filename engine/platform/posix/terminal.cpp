#include "platform/terminal.h"

#include <poll.h>
#include <unistd.h>
#include <cerrno>

namespace palpa {

bool is_terminal(std::FILE* stream) noexcept { return isatty(fileno(stream)) != 0; }

std::optional<std::size_t> read_standard_input(std::span<char> buffer, int timeout_ms) noexcept {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, timeout_ms) <= 0) return std::nullopt;
    const ssize_t count = read(STDIN_FILENO, buffer.data(), buffer.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return std::nullopt;
    return count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace palpa
