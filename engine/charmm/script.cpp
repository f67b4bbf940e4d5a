#include "charmm/script.h"

#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <utility>

namespace palpa {
namespace {

// How much CHARMM prints, and at which faults it stops.
constexpr std::array script_passed_over =
    std::to_array<std::string_view>({"BOML", "WRNL", "PRNL", "IOFO", "ECHO", "LABE"});
constexpr std::array script_followed =
    std::to_array<std::string_view>({"SET", "IF", "ELSE", "ENDI", "GOTO", "RETU", "STRE"});

template <class Words>
bool is_one_of(const Words& words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::string_view without_quotes(std::string_view word) {
    const bool is_quoted = word.size() >= 2 && word.front() == '"' && word.back() == '"';
    return is_quoted ? word.substr(1, word.size() - 2) : word;
}

std::optional<bool> compare(const std::string& a, std::string_view by, const std::string& b) {
    const std::optional<double> x = find_real(a), y = find_real(b);
    const bool are_numbers = x && y;
    if (by == "EQ" || by == "==") return are_numbers ? *x == *y : a == b;
    if (by == "NE" || by == "!=") return are_numbers ? *x != *y : a != b;
    if (!are_numbers) return std::nullopt;
    if (by == "GT" || by == ">") return *x > *y;
    if (by == "GE" || by == ">=") return *x >= *y;
    if (by == "LT" || by == "<") return *x < *y;
    return *x <= *y;
}

constexpr std::array comparisons = std::to_array<std::string_view>(
    {"EQ", "NE", "GT", "GE", "LT", "LE", "==", "!=", ">", ">=", "<", "<="});

}  // namespace

bool Script::is_script(std::string_view keyword) {
    return is_one_of(script_passed_over, keyword) || is_one_of(script_followed, keyword);
}

bool Script::follow() { return follow(statements_.words()); }

bool Script::follow(Words words) {
    const std::string_view keyword = words[0].substr(0, 4);
    if (keyword == "RETU") return false;
    if (keyword == "SET") {
        set(words);
    } else if (keyword == "IF") {
        return follow_if(words);
    } else if (keyword == "ELSE" || keyword == "ENDI") {
        if (open_blocks_.empty()) {
            statements_.fail(fmt::format("'{}' without an IF before it", words[0]));
        }
        open_blocks_.pop_back();
        if (keyword == "ELSE") skip_block(false);  // behind the block that was taken
    } else if (keyword == "GOTO") {
        if (words.size() < 2) statements_.fail("the label is missing; expected: GOTO label");
        go_to(std::string(words[1]));
    } else if (keyword == "STRE") {
        note_other_file();
    }
    return true;  // `words` may be gone: jumps move on
}

// IF a EQ b THEN ... [ELSE ...] ENDIF, or IF a EQ b statement.
bool Script::follow_if(Words words) {
    if (words.size() < 5 || !is_one_of(comparisons, words[2])) {
        statements_.fail(
            fmt::format("the condition '{}' is not supported; expected: IF variable EQ value THEN, "
                        "or a statement in place of THEN (or NE, GT, GE, LT, LE)",
                        fmt::join(words, " ")));
    }
    const std::optional<bool> truth = find_truth(words);
    const bool is_block = words[4] == "THEN";
    if (is_block && !truth) {
        statements_.fail(
            fmt::format("the variable of '{} {} {}' has no value; expected a variable that this "
                        "file SETs before",
                        words[1], words[2], words[3]));
    }
    if (is_block) {
        if (*truth) {
            open_blocks_.push_back(statements_.place().line);
        } else {
            skip_block(true);
        }
        return true;
    }
    if (!truth || !*truth) return true;
    const Words rest = words.subspan(4);
    if (!is_script(rest[0].substr(0, 4))) {
        statements_.fail(fmt::format(
            "the statement '{}' is not supported after IF; expected SET, GOTO, RETURN or the like",
            rest[0]));
    }
    return follow(rest);
}

// SET name [=] [value]
void Script::set(Words words) {
    if (words.size() < 2) statements_.fail("the variable is missing; expected: SET variable value");
    const std::size_t at = words.size() > 2 && words[2] == "=" ? 3 : 2;
    variables_.insert_or_assign(std::string(words[1]), words.size() > at
                                                           ? find_value(words[at])
                                                           : std::optional<std::string>(""));
}

// To behind the ENDIF, or the ELSE if that is the other way, of the block that begins here.
void Script::skip_block(bool stops_at_else) {
    const std::size_t line = statements_.place().line;
    open_blocks_.push_back(line);
    std::size_t depth = 1;
    while (statements_.next()) {
        const std::vector<std::string_view>& words = statements_.words();
        const std::string_view keyword = statements_.keyword();
        if (keyword == "IF" && words.back() == "THEN") ++depth;
        if (stops_at_else && keyword == "ELSE" && depth == 1) return;
        if (words[0] == "ENDIF" && --depth == 0) return open_blocks_.pop_back();
    }
}

void Script::go_to(std::string label) {
    const TextPlace place = statements_.place();
    while (statements_.next()) {
        const std::vector<std::string_view>& words = statements_.words();
        if (statements_.keyword() == "LABE" && words.size() > 1 && words[1] == label) {
            return;
        }
        if (statements_.keyword() == "IF" && words.back() == "THEN") {
            open_blocks_.push_back(statements_.place().line);
        } else if (words[0] == "ENDIF" && !open_blocks_.empty()) {
            open_blocks_.pop_back();
        }
    }
    throw LoadError(
        place,
        fmt::format("there is no label '{}' after this line; jumps backwards are not supported",
                    label));
}

void Script::note_other_file() {
    into_.notes.push_back({ForceFieldNote::Kind::OtherFile,
                           statements_.place(),
                           fmt::format("'{}'", statements_.text()),
                           {}});
}

void Script::check_closed() const {
    if (open_blocks_.empty()) return;
    throw LoadError(
        {statements_.place().file, statements_.line_count(), 0},
        fmt::format("the file ends inside the IF of line {}, so it may be cut off; expected ENDIF",
                    open_blocks_.back()));
}

std::optional<std::string> Script::find_value(std::string_view word) const {
    word = without_quotes(word);
    if (word.find('?') != std::string_view::npos) return std::nullopt;
    if (!word.starts_with('@')) return std::string(word);
    const bool is_braced = word.size() > 3 && word[1] == '{' && word.back() == '}';
    const auto found =
        variables_.find(is_braced ? word.substr(2, word.size() - 3) : word.substr(1));
    return found == variables_.end() ? std::nullopt : found->second;
}

// Left stands a variable, with or without its '@'.
std::optional<bool> Script::find_truth(Words words) const {
    const auto named = variables_.find(words[1]);
    const std::optional<std::string> left =
        named != variables_.end() ? named->second : find_value(words[1]);
    const std::optional<std::string> right = find_value(words[3]);
    if (!left || !right) return std::nullopt;
    const bool is_literal = named == variables_.end() && words[1].find('@') == words[1].npos;
    if (is_literal && !find_real(*left)) return std::nullopt;
    return compare(*left, words[2], *right);
}

}  // namespace palpa
