// Whether a person reads what is written.
#pragma once
#include <cstdio>

namespace palpa {

// `stream` is stdout or stderr.
bool is_terminal(std::FILE* stream) noexcept;

}  // namespace palpa
