// Names of files in commands that messages print.
#pragma once
#include <string>
#include <string_view>

namespace palpa {

// As it is typed in a shell: in quotes where it needs them, and "./-x" for "-x", which would be
// read as an option.
std::string shell_word(std::string_view word);

}  // namespace palpa
