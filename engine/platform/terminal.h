// Terminals and standard input.
#pragma once
#include <cstddef>
#include <cstdio>
#include <optional>
#include <span>

namespace palpa {

// Whether `stream` (stdout or stderr) is a terminal.
bool is_terminal(std::FILE* stream) noexcept;

// What is next on standard input, as much as is there and has room; 0 bytes at its end. Nothing
// where none came within that time, or a signal did. Windows waits however long it takes. Not
// beside what reads stdin.
std::optional<std::size_t> read_standard_input(std::span<char> buffer, int timeout_ms) noexcept;

}  // namespace palpa
