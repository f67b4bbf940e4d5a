// Splits an expression into words with their positions.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace palpa {

struct SelectionToken {
    enum class Kind { Word, Quoted, Open, Close, Comma, Compare, End };
    Kind kind = Kind::End;
    std::string_view text;   // view into the expression, without quotes
    std::size_t column = 0;  // in letters, from 1
};

// Reads one after the other. Blanks, parentheses, commas and the signs < > = ! end a word; a quote
// inside of a word, as in C1', is part of it.
class SelectionWords {
public:
    // Both must outlive it. Throws LoadError, as parse_selection says, for a quote without an end.
    SelectionWords(std::string_view text, std::string_view source);

    const SelectionToken& now() const noexcept { return now_; }
    void advance();

    [[noreturn]] void refuse(std::size_t column, const std::string& message) const;
    // "'x', expected ..." of the present token, or "it ends here, expected ...".
    [[noreturn]] void refuse_now(const std::string& expected) const;

private:
    std::size_t column_of(std::size_t byte) noexcept;
    SelectionToken read_quoted();

    std::string_view text_, source_;
    std::size_t at_ = 0;
    // Columns are counted on from the last token.
    std::size_t counted_byte_ = 0, counted_column_ = 1;
    SelectionToken now_;
};

// The LoadError at a column of an expression.
[[noreturn]] void refuse_selection(std::string_view source, std::size_t column,
                                   const std::string& message);

}  // namespace palpa
