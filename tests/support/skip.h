// A test that cannot run here says so with skip() and returns. Catch2 2.13 knows no skipping: the
// program then ends with exit code 77, which ctest counts as skipped, unless a case failed.
#pragma once
#include <string_view>

namespace palpa::test {

// Prints "SKIPPED: why".
void skip(std::string_view why);

}  // namespace palpa::test
