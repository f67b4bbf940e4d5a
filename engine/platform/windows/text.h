// Windows' texts of 16 bits, and ours.
#pragma once
#include <string>
#include <string_view>

namespace palpa {

std::wstring to_wide(std::string_view utf8);
std::string to_utf8(std::wstring_view wide);

}  // namespace palpa
