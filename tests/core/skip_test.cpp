// Cases for tests/tools/check_skips_test.py, which looks at this program's exit code; hidden, so
// that no other run has them.
#include "tests/support/skip.h"

#include <catch2/catch.hpp>

using namespace palpa;

TEST_CASE("hidden: skips", "[.skip]") { test::skip("of no use here"); }

TEST_CASE("hidden: skips and fails", "[.skip]") {
    test::skip("of no use here");
    CHECK(false);
}

TEST_CASE("hidden: says the word and passes", "[.skip]") {
    WARN("SKIPPED: not really");
    CHECK(true);
}
