// Quotes file names in commands that messages print.
#pragma once
#include <string>
#include <string_view>

namespace palpa {

// The word as typed in a shell: in quotes if necessary, and "./-x" for "-x", which would be read as
// an option.
std::string shell_word(std::string_view word);

}  // namespace palpa
