// The exception for unusable input: where, what was read, and what would be right.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace palpa {

// A place in a text file. Lines and columns count from 1; 0 means "no particular one".
struct TextPlace {
    std::string file;
    std::size_t line = 0;
    std::size_t column = 0;
};

// "file:line:column", without the parts that are 0.
std::string to_string(const TextPlace& place);

// The message is one sentence in lower case without a full stop; what() puts the place before it,
// and shows bytes that cannot be printed as "\x1b".
class LoadError : public std::runtime_error {
public:
    LoadError(const TextPlace& place, const std::string& message);

    // For many problems: the message names the first ones and counts the others, which `further`
    // contains.
    LoadError(const TextPlace& place, const std::string& message, std::vector<std::string> further);
    const std::vector<std::string>& further() const noexcept { return *further_; }

private:
    std::shared_ptr<const std::vector<std::string>> further_;  // shared: copies must not throw
};

// One error of several problems, in this order; `place` is that of the first, the others state
// theirs. The message names the first `most_named_problems` and counts the others, which further()
// holds; `advice` stands at its end. There must be a problem.
constexpr std::size_t most_named_problems = 8;
LoadError join_problems(const TextPlace& place, const std::vector<std::string>& problems,
                        std::span<const std::string> advice = {});

}  // namespace palpa
