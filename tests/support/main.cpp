// The main function of every test program: Catch's, with an exit code for what was skipped.
#define CATCH_CONFIG_RUNNER
#include "tests/support/skip.h"

#include <catch2/catch.hpp>
#include <iostream>

namespace {

constexpr int skipped_code = 77;  // SKIP_RETURN_CODE in tests/CMakeLists.txt
bool has_skipped = false;

}  // namespace

void palpa::test::skip(std::string_view why) {
    std::cout << "SKIPPED: " << why << "\n";
    has_skipped = true;
}

int main(int argc, char** argv) {
    // How many assertions failed, or how many tests were listed.
    const int result = Catch::Session().run(argc, argv);
    if (result == 0 && has_skipped) return skipped_code;
    return result == skipped_code ? skipped_code + 1 : result;
}
