// CHARMM's topology, parameter and stream files as statements: what stands on a line, without
// comment, with the lines that continue it.
#pragma once
#include "core/load_error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Goes through a text statement by statement. Blank lines, comments from '!' on and title lines
// ('*') are passed over; a '-' at the end of a line continues it on the next; all is upper case.
class Statements {
public:
    Statements(std::string_view text, const std::string& file);

    // To the next statement; false at the end of the file.
    bool next();

    std::size_t line_count() const noexcept { return lines_.size(); }

    // All of the rest is about the present statement. Views hold until the next one.
    const std::vector<std::string_view>& words() const noexcept { return words_; }
    std::string_view text() const noexcept { return statement_; }
    std::string_view keyword() const noexcept { return words_[0].substr(0, 4); }  // all that counts
    TextPlace place() const { return {file_, line_, 0}; }  // of its first line
    [[noreturn]] void fail(const std::string& what) const;

    // The word `at`, counted from 0; throws LoadError if there is none or it does not parse. `what`
    // says in the message what was expected.
    std::string name(std::size_t at, const char* what) const;
    double real(std::size_t at, const char* what) const;
    std::int64_t whole_number(std::size_t at, const char* what) const;

    // Throws LoadError unless there are as many words as in the form, "type1 type2 k r0"; those in
    // brackets may be left out, each pair of brackets as a whole.
    void expect_form(std::string_view form) const;

private:
    std::vector<std::string_view> lines_;
    std::size_t at_ = 0;  // the line to be read next
    const std::string& file_;
    std::string statement_;
    std::vector<std::string_view> words_;
    std::size_t line_ = 0;
};

}  // namespace palpa
