#include "core/load_error.h"
#include "molecule/select.h"
#include "tests/support/load_error_of.h"

#include <catch2/catch.hpp>
#include <string>

using namespace palpa;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

std::string parse_error(const std::string& text) {
    return test::load_error_of([&] { (void)parse_selection(text); });
}

std::string repeated(const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
}

}  // namespace

TEST_CASE("an error says the column and what would be right", "[molecule][selection]") {
    const auto [text, start, part] = GENERATE(table<std::string, std::string, std::string>({
        {"", "selection, column 1: the expression ends here, expected an expression such as", ""},
        {"  \t ", "selection, column 5: the expression ends here", ""},
        {"protien", "selection, column 1: 'protien', expected", "did you mean 'protein'?"},
        {"water and protien", "selection, column 11: 'protien'", "did you mean 'protein'?"},
        {"water adn protein", "selection, column 7: 'adn', expected 'and' or 'or'",
         "did you mean 'and'?"},
        {"water protein", "selection, column 7: 'protein', expected 'and' or 'or'", ""},
        {"water and", "selection, column 10: the expression ends here", ""},
        {"and water", "selection, column 1: 'and', expected an expression before it", ""},
        {"water or or ion", "selection, column 10: 'or'", ""},
        {"(water",
         "selection, column 7: the expression ends here, expected ')' for the '(' of column 1", ""},
        {"(water ion)", "selection, column 8: 'ion', expected 'and', 'or', or ')'", ""},
        {"water)", "selection, column 6: ')' has no '(' before it", ""},
        {"()", "selection, column 2: ')', expected an expression", ""},
        {"name", "selection, column 5: the expression ends here, expected a name after 'name'", ""},
        {"name and water", "selection, column 6: 'and', expected a name after 'name'", ""},
        {"name CA,", "selection, column 9: the expression ends here, expected a name", ""},
        {"name , CA", "selection, column 6: ',', expected a name", ""},
        {"name CA chain A", "selection, column 9: 'chain', expected 'and' or 'or' before it", ""},
        {"name \"CA", "selection, column 6: the quotation mark has no end", ""},
        {"element C Qq", "selection, column 11: 'Qq', expected the symbol of an element", ""},
        {"resid", "selection, column 6: the expression ends here, expected numbers", ""},
        {"resid ALA", "selection, column 7: 'ALA', expected numbers after 'resid'", ""},
        {"resid 5:", "selection, column 7: '5:'", "60:62"},
        {"resid 5:x", "selection, column 7: '5:x'", ""},
        {"resid 5:6:7", "selection, column 7: '5:6:7'", ""},
        {"resid 5 to", "selection, column 11: the expression ends here", ""},
        {"resid 5:6 to 8", "selection, column 7: two ranges in one", ""},
        {"resid 8:5", "selection, column 7: 8 is larger than 5", ""},
        {"resid 99999999999999999999", "selection, column 7: '9999", ""},
        {"resid 5 6 water", "selection, column 11: 'water', expected 'and' or 'or' before it", ""},
        {"index 5A", "selection, column 7: '5A', expected numbers after 'index'", ""},
        {"charge 0.3", "selection, column 8: '0.3', expected a comparison, as in charge > 0.3", ""},
        {"charge >", "selection, column 9: the expression ends here, expected a number after '>'",
         ""},
        {"charge > nan", "selection, column 10: 'nan', expected a number", ""},
        {"charge ! 3", "selection, column 8: '!', expected <, <=", ""},
        {"within of water", "selection, column 8: 'of', expected a distance in Å after 'within'",
         ""},
        {"within -1 of water", "selection, column 8: '-1', expected a distance", ""},
        {"within 1e9 of water", "selection, column 8: '1e9', expected a distance", ""},
        {"within 5 water", "selection, column 10: 'water', expected 'of'", ""},
        {"within 5 of", "selection, column 12: the expression ends here", ""},
        {"same water as ion", "selection, column 6: 'water', expected residue, chain", ""},
        {"same residue", "selection, column 13: the expression ends here, expected 'as'", ""},
        {"polar water", "selection, column 7: 'water', expected 'hydrogen' after 'polar'", ""},
        {"5", "selection, column 1: '5', expected an expression", ""},
        {"\"water\"", "selection, column 1: 'water', expected an expression", ""},
        // Letters are counted, not bytes.
        {"name Å and Å", "selection, column 12: 'Å', expected an expression", ""},
    }));
    CAPTURE(text);
    const std::string message = parse_error(text);

    CHECK_THAT(message, StartsWith(start));
    CHECK_THAT(message, Contains(part));
    CHECK(message.find('\n') == std::string::npos);
}

TEST_CASE("an error says where the expression is from", "[molecule][selection]") {
    const std::string message =
        test::load_error_of([] { (void)parse_selection("watr", "scene.toml:7: selection"); });

    CHECK_THAT(message, StartsWith("scene.toml:7: selection, column 1: 'watr'"));
    CHECK_THAT(message, Contains("did you mean 'water'?"));
}

TEST_CASE("expressions may be long but not deep", "[molecule][selection]") {
    CHECK(parse_error(repeated("water or ", 5000) + "ion") == "no error");
    CHECK(parse_error(repeated("(", 90) + "water" + repeated(")", 90)) == "no error");
    CHECK(parse_error(repeated("not ", 99) + "water") == "no error");
    CHECK_THAT(parse_error(repeated("not ", 100) + "water"),
               StartsWith("selection, column 401: expressions are nested more than 100 deep"));
    CHECK_THAT(parse_error(repeated("(", 100'000)), Contains("more than 100 deep"));
    CHECK_THAT(parse_error(repeated("byres within 5 of ", 50'000)), Contains("more than 100 deep"));
}
