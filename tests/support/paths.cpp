#include "tests/support/paths.h"

namespace palpa::test {

// The only file that is compiled with the project's place, so that ccache serves the others to
// every clone.
std::string in_project(std::string_view path) {
    std::string whole = PALPA_ROOT;
    if (!path.empty()) whole.append("/").append(path);
    return whole;
}

std::string test_data(std::string_view path) {
    std::string below = "tests/data";
    if (!path.empty()) below.append("/").append(path);
    return in_project(below);
}

}  // namespace palpa::test
