// What a reader throws when its input cannot be used: where, what was read, what would be right.
#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>

namespace palpa {

// A place in a text file. Lines and columns count from 1; 0 means "no particular one".
struct TextPlace {
    std::string file;
    std::size_t line = 0;
    std::size_t column = 0;
};

// "file:line:column", leaving out what is 0.
std::string to_string(const TextPlace& place);

// The message is one sentence in lower case without a full stop; what() puts the place before it,
// and shows bytes that cannot be printed as "\x1b".
class LoadError : public std::runtime_error {
public:
    LoadError(const TextPlace& place, const std::string& message);
};

}  // namespace palpa
