// Converts between Windows' 16-bit texts and UTF-8.
#pragma once
#include <string>
#include <string_view>

namespace palpa {

std::wstring to_wide(std::string_view utf8);
std::string to_utf8(std::wstring_view wide);

}  // namespace palpa
