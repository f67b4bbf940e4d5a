// Where tests find the project's own files.
#pragma once
#include <string>
#include <string_view>

namespace palpa::test {

// `path` below the project's folder; with an empty one that folder itself.
std::string in_project(std::string_view path);

// `path` below tests/data; with an empty one that folder itself.
std::string test_data(std::string_view path);

}  // namespace palpa::test
