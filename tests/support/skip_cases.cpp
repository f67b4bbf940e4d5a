// A test program for tests/tools/check_skips_test.py, which looks at its exit code; ctest has none
// of its cases.
#include "tests/support/skip.h"

#include <catch2/catch.hpp>

using namespace palpa;

TEST_CASE("skips") { test::skip("of no use here"); }

TEST_CASE("skips and fails") {
    test::skip("of no use here");
    CHECK(false);
}

TEST_CASE("says the word and passes") {
    WARN("SKIPPED: not really");
    CHECK(true);
}
