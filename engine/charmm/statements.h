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

    // Goes to the next statement; false at the end of the file.
    bool next();

    std::size_t line_count() const noexcept { return lines_.size(); }

    // All functions below refer to the present statement. Views are valid until the next one.
    const std::vector<std::string_view>& words() const noexcept { return words_; }
    std::string_view text() const noexcept { return statement_; }
    // The significant letters.
    std::string_view keyword() const noexcept { return words_[0].substr(0, 4); }
    TextPlace place() const { return {file_, line_, 0}; }  // of the first line of the statement
    [[noreturn]] void fail(const std::string& what) const;

    // The word `at`, counted from 0. Throws LoadError if it is missing or cannot be parsed; `what`
    // names it in the message.
    std::string name(std::size_t at, const char* what) const;
    double real(std::size_t at, const char* what) const;
    std::int64_t whole_number(std::size_t at, const char* what) const;

    // Throws LoadError unless there are as many words as in the form, "type1 type2 k r0"; those in
    // brackets may be left out, each pair of brackets as a whole.
    void expect_form(std::string_view form) const;

private:
    std::vector<std::string_view> lines_;
    std::size_t at_ = 0;  // next line to read
    const std::string& file_;
    std::string statement_;
    std::vector<std::string_view> words_;
    std::size_t line_ = 0;
};

}  // namespace palpa
