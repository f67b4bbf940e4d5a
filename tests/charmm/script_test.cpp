#include "charmm/script.h"

#include "tests/support/force_field_of.h"
#include "tests/support/load_error_of.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <string>
#include <string_view>

using namespace palpa;
using Catch::Contains;
using Catch::StartsWith;
using test::load_error_of;

namespace {

// "read rtf" with one atom type, as a part of its own.
std::string part(std::string_view type) {
    return fmt::format("read rtf card @app\nMASS -1 {} 12.0 C\nEND\n", type);
}

// The types that a stream file with this script has, joined by blanks.
std::string types_of(std::string_view text) {
    std::string names;
    for (const auto& [name, type] : test::force_field_of(text, "a.str").types) {
        names += (names.empty() ? "" : " ") + name;
    }
    return names;
}

std::string error_of(std::string_view text) {
    return load_error_of([&] { test::force_field_of(text, "a.str"); });
}

}  // namespace

TEST_CASE("a block is read where its condition holds", "[charmm][script]") {
    struct Row {
        const char* condition;
        bool holds;
    };
    const auto row = GENERATE(values<Row>({
        {"model eq 1", true},
        {"@model eq 1", true},
        {"@{model} eq 1", true},
        {"model eq 1.0", true},
        {"model ne 1", false},
        {"model eq 2", false},
        {"model gt 0", true},
        {"model gt 1", false},
        {"model ge 1", true},
        {"model lt 1", false},
        {"model le 1", true},
        {"\"@MODEL\" eq \"1\"", true},
        {"word eq Some", true},
        {"word ne some", false},
        {"word eq other", false},
        {"1 eq @model", true},
        {"copy eq 1", true},
    }));
    INFO(row.condition);
    const std::string text =
        fmt::format("set model 1\nset word some\nset copy = @model\nif {} then\n{}endif\n{}",
                    row.condition, part("A"), part("B"));

    CHECK(types_of(text) == (row.holds ? "A B" : "B"));
}

TEST_CASE("of IF and ELSE one block is read, whatever stands in the other", "[charmm][script]") {
    const std::string blocks = "if m eq 1 then\n" + part("A") + "else\n" + part("B") + "endif\n";

    CHECK(types_of("set m 1\n" + blocks + part("C")) == "A C");
    CHECK(types_of("set m 2\n" + blocks + part("C")) == "B C");
    // A block within a block that is not read.
    CHECK(types_of("set m 1\nif m eq 2 then\nif m eq 1 then\nnonsense\nendif\n" + part("A") +
                   "endif\n" + part("B")) == "B");
}

TEST_CASE("cholesterol's file gives the model that it sets, and nothing behind RETURN",
          "[charmm][script]") {
    const auto file = [](int model) {
        return fmt::format(
            "set chol_model {}\nset nat ?NATC\nset app\n"
            "if \"@NAT\" ne \"?NATC\" if @nat ne 0 set app append\n"
            "if chol_model eq 1 then\n{}return\nendif\n{}return\nnonsense\n",
            model, part("A"), part("B"));
    };

    CHECK(types_of(file(1)) == "A");
    CHECK(types_of(file(2)) == "B");
}

TEST_CASE("a condition that CHARMM alone knows is not true on one line, and no block's",
          "[charmm][script]") {
    CHECK(types_of("if ?NUMNODE gt 1 return\n" + part("A")) == "A");
    CHECK(types_of("set n ?NATC\nif n eq 0 return\n" + part("A")) == "A");
    CHECK(types_of("set n 0\nif n eq 0 return\n" + part("A")).empty());
    CHECK_THAT(error_of("if ?NUMNODE gt 1 then\n" + part("A") + "endif\n"),
               StartsWith("a.str:1: the variable of '?NUMNODE GT 1' has no value"));
    CHECK_THAT(error_of("if other eq 1 then\nendif\n"),
               StartsWith("a.str:1: the variable of 'OTHER EQ 1' has no value"));
}

TEST_CASE("GOTO goes on behind its label, which comes later", "[charmm][script]") {
    CHECK(types_of("goto last\n" + part("A") + "label first\n" + part("B") + "label last\n" +
                   part("C")) == "C");
    CHECK(types_of("set m 1\nif m eq 1 then\ngoto out\nendif\n" + part("A") + "label out\n" +
                   part("B")) == "B");
    CHECK(error_of("label first\n" + part("A") + "goto first\n") ==
          "a.str:5: there is no label 'FIRST' after this line; jumps backwards are not supported");
}

TEST_CASE("other files are noted and not read", "[charmm][script]") {
    const ForceField field =
        test::force_field_of("stream other.str\nread rtf card name top.rtf\n" + part("A"), "a.str");

    CHECK(field.types.size() == 1);
    REQUIRE(field.notes.size() == 2);
    CHECK(describe_note(field.notes[0]) == "a.str:1: 'STREAM OTHER.STR' is not followed");
    CHECK(field.notes[1].kind == ForceFieldNote::Kind::OtherFile);
}

TEST_CASE("a block without its end is refused as cut, an end without its block as wrong",
          "[charmm][script]") {
    CHECK(error_of("set m 1\nif m eq 1 then\n" + part("A")) ==
          "a.str:5: the file ends inside the IF of line 2, so it may be cut off; expected ENDIF");
    CHECK_THAT(error_of("set m 1\nif m eq 2 then\n" + part("A")),
               Contains("inside the IF of line 2"));
    CHECK_THAT(error_of("endif\n"), StartsWith("a.str:1: 'ENDIF' without an IF"));
    CHECK_THAT(error_of("else\n"), StartsWith("a.str:1: 'ELSE' without an IF"));
    CHECK_THAT(error_of("set m 1\nif m is 1 then\nendif\n"),
               StartsWith("a.str:2: the condition 'IF M IS 1 THEN' is not supported"));
    CHECK_THAT(error_of("set m 1\nif m eq 1 energy\n"),
               StartsWith("a.str:2: the statement 'ENERGY' is not supported after IF"));
}
