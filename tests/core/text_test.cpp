#include "core/text.h"

#include <fmt/format.h>
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace palpa;

using Views = std::vector<std::string_view>;

TEST_CASE("trimming takes blanks, tabs and carriage returns from the ends only", "[core][text]") {
    CHECK(trimmed(" \t a b\t c \r").compare("a b\t c") == 0);
    CHECK(trimmed("word") == "word");
    CHECK(trimmed("").empty());
    CHECK(trimmed(" \t\r ").empty());
}

TEST_CASE("words stand between blanks and tabs", "[core][text]") {
    CHECK(split_words("  ATOM OH2\tOT   -0.834 ") == Views{"ATOM", "OH2", "OT", "-0.834"});
    CHECK(split_words("one") == Views{"one"});
    CHECK(split_words("").empty());
    CHECK(split_words(" \t ").empty());
}

TEST_CASE("lines lose either kind of end, and empty lines count", "[core][text]") {
    CHECK(split_lines("a\nb\n") == Views{"a", "b"});
    CHECK(split_lines("a\r\n\r\nb") == Views{"a", "", "b"});
    CHECK(split_lines("a\rb\n") == Views{"a\rb"});
    CHECK(split_lines("\n\n") == Views{"", ""});
    CHECK(split_lines("").empty());
}

TEST_CASE("upper case changes the letters a to z and nothing else", "[core][text]") {
    CHECK(upper_case("tip3 Å'az{`@Z") == "TIP3 Å'AZ{`@Z");
}

TEST_CASE("what cannot be printed is written in hexadecimal digits", "[core][text]") {
    CHECK(printable("plain 'text' \\ ~") == "plain 'text' \\ ~");
    CHECK(printable("Å, 水, \U0001f4a7") == "Å, 水, \U0001f4a7");
    CHECK(printable(std::string("a\0\t\n\x1b[31m\x7f", 10)) == "a\\x00\\x09\\x0a\\x1b[31m\\x7f");
    // After RFC 3629: a letter cut off, a lone follower, overlong forms, a surrogate, beyond the
    // last.
    CHECK(printable("\xc3") == "\\xc3");
    // What turns the direction of a text: letters would be shown in another order.
    CHECK(printable("a\u202eb") == "a\\xe2\\x80\\xaeb");
    CHECK(printable("\u2066") == "\\xe2\\x81\\xa6");
    CHECK(printable("\u2022 \u2065") == "\u2022 \u2065");
    CHECK(printable("\x85x") == "\\x85x");
    CHECK(printable("\xc0\x80") == "\\xc0\\x80");
    CHECK(printable("\xe0\x9f\xbf") == "\\xe0\\x9f\\xbf");
    CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");
    CHECK(printable("\xf0\x8f\xbf\xbf") == "\\xf0\\x8f\\xbf\\xbf");
    CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");
    // Controls beyond ASCII: a terminal may take 0x9b for the start of a command.
    CHECK(printable("\xc2\x9b") == "\\xc2\\x9b");
}

TEST_CASE("real numbers are read as people and Fortran write them", "[core][text]") {
    struct Row {
        const char* text;
        double value;
    };
    const auto row =
        GENERATE(values<Row>({{"0", 0.0},
                              {"-0.834", -0.834},
                              {"+.5", 0.5},
                              {"5.", 5.0},
                              {"  104.52 \t", 104.52},
                              {"1e3", 1000.0},
                              {"1.5D+02", 150.0},
                              {"1.5d-2", 0.015},
                              {"-1E0", -1.0},
                              {"1.7976931348623157e308", std::numeric_limits<double>::max()}}));
    INFO("'" << row.text << "'");

    REQUIRE(find_real(row.text).has_value());

    CHECK(*find_real(row.text) == row.value);
}

TEST_CASE("what is no finite number is not read as one", "[core][text]") {
    const std::string text = GENERATE(
        values<std::string>({"",     " ",    "+",    "-",        ".",     "e5",   "abc", "1,5",
                             "1.0x", "1 2",  "--1",  "+-1",      "++1",   "+ 1",  "nan", "NaN",
                             "inf",  "-inf", "+INF", "infinity", "1e999", "0x10", "1e",  "1.2.3"}));
    INFO("'" << text << "'");

    CHECK_FALSE(find_real(text).has_value());
}

TEST_CASE("any finite number survives being written and read, to the last bit", "[core][text]") {
    std::mt19937_64 random(11);

    for (int i = 0; i < 20000; ++i) {
        const auto value = std::bit_cast<double>(random());
        // Numbers below the normal ones are not asked for.
        if (!std::isfinite(value) || !std::isnormal(value)) continue;
        const std::string text = fmt::format("{}", value);
        INFO(text);
        REQUIRE(find_real(text) == value);
    }
}

TEST_CASE("whole numbers are read over their whole range and not beyond", "[core][text]") {
    CHECK(find_integer("9223372036854775807") == std::numeric_limits<std::int64_t>::max());
    CHECK(find_integer("-9223372036854775808") == std::numeric_limits<std::int64_t>::min());
    CHECK(find_integer(" +42 ") == 42);
    CHECK(find_integer("007") == 7);
    const std::string wrong =
        GENERATE(values<std::string>({"9223372036854775808", "-9223372036854775809", "1.0", "1e3",
                                      "", "+", "-", "0x1", "1 2", "+-1", "six"}));
    INFO("'" << wrong << "'");
    CHECK_FALSE(find_integer(wrong).has_value());
}

TEST_CASE("a near name is one edit away, or a third of the letters", "[core][text]") {
    const std::array names =
        std::to_array<std::string_view>({"viscosity", "friction", "mode", "OT"});

    CHECK(find_near_name("viscosity", names) == "viscosity");
    CHECK(find_near_name("VISCOSITY", names) == "viscosity");
    // Nine letters: three replacements are near, four are not.
    CHECK(find_near_name("visxxxity", names) == "viscosity");
    CHECK(find_near_name("visxxxxty", names).empty());
    // Six letters: two edits, here a letter too few at each end.
    CHECK(find_near_name("rictio", names) == "friction");
    CHECK(find_near_name("rictiox", names) == "friction");
    CHECK(find_near_name("ricti", names).empty());
    // Short names: one edit.
    CHECK(find_near_name("mde", names) == "mode");
    CHECK(find_near_name("mide", names) == "mode");
    CHECK(find_near_name("me", names).empty());
    CHECK(find_near_name("mdoe", names) == "mode");  // two neighbours swapped are one
    CHECK(find_near_name("TO", names) == "OT");
    CHECK(find_near_name("mdeo", names).empty());
    CHECK(find_near_name("OX", names) == "OT");
    CHECK(find_near_name("anything", {}).empty());
    // Nothing is near to no name, though "x" is one edit away.
    CHECK(find_near_name("", std::to_array<std::string_view>({"x"})).empty());
}

TEST_CASE("of two near names the nearer one is told, of equals the first", "[core][text]") {
    const std::array names = std::to_array<std::string_view>({"A_f_max", "A_d_max", "A_d_min"});

    CHECK(find_near_name("A_d_mix", names) == "A_d_max");
    CHECK(find_near_name("A_d_minn", names) == "A_d_min");
    CHECK(find_near_name("A_x_max", names) == "A_f_max");
}

TEST_CASE("the hint is ready to stand behind a message", "[core][text]") {
    const std::array names = std::to_array<std::string_view>({"mode"});

    CHECK(near_name_hint("moad", names).empty());
    CHECK(near_name_hint("mod", names) == "; did you mean 'mode'?");
}

TEST_CASE("the hash is FNV-1a and goes on where it stopped", "[core][text]") {
    // Values from the authors' test suite (Noll, draft-eastlake-fnv).
    CHECK(content_hash("") == 0xcbf29ce484222325);
    CHECK(content_hash("a") == 0xaf63dc4c8601ec8c);
    CHECK(content_hash("foobar") == 0x85944171f73967e8);
    CHECK(content_hash("bar", content_hash("foo")) == content_hash("foobar"));
}

TEST_CASE("a real number is written as one, and reads back the same", "[core][text]") {
    CHECK(format_real(2) == "2.0");
    CHECK(format_real(-0.0) == "-0.0");
    CHECK(format_real(0.055) == "0.055");
    CHECK(format_real(1e300).find('e') != std::string::npos);
    for (const double value : {1.0 / 3, 5.1e9, -1e-300, 640000000.0}) {
        CHECK(find_real(format_real(value)) == value);
    }
}
