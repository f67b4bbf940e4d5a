// Options whose value is one of a list of names.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace palpa {

// Which of the names it is. Throws LoadError that lists them.
std::size_t choice_called(const std::string& option, const std::string& name,
                          std::span<const std::string_view> names);

}  // namespace palpa
