#include "core/shell_word.h"

#include <catch2/catch.hpp>

using palpa::shell_word;

TEST_CASE("names of files are quoted where a shell would split or change them", "[core][text]") {
    CHECK(shell_word("runs/water-1/run.sh") == "runs/water-1/run.sh");
    CHECK(shell_word("my run/run.sh") == "\"my run/run.sh\"");
    CHECK(shell_word("it's") == "\"it's\"");
    CHECK(shell_word("-o") == "./-o");
    CHECK(shell_word("- o") == "\"./- o\"");
    CHECK(shell_word("a$b c") == "'a$b c'");
    CHECK(shell_word("a$b's") == "'a$b'\\''s'");
    CHECK(shell_word("") == "\"\"");
}
