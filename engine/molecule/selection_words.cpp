#include "molecule/selection_words.h"

#include "core/load_error.h"

#include <fmt/format.h>
#include <algorithm>

namespace palpa {
namespace {

constexpr std::string_view selection_blanks = " \t\r\n";
constexpr std::string_view word_ends = " \t\r\n(),<>=!";
constexpr std::size_t longest_shown = 40;

}  // namespace

void refuse_selection(std::string_view source, std::size_t column, const std::string& message) {
    throw LoadError({fmt::format("{}, column {}", source, column)}, message);
}

SelectionWords::SelectionWords(std::string_view text, std::string_view source)
    : text_(text), source_(source) {
    advance();
}

void SelectionWords::refuse(std::size_t column, const std::string& message) const {
    refuse_selection(source_, column, message);
}

void SelectionWords::refuse_now(const std::string& expected) const {
    if (now_.kind == SelectionToken::Kind::End)
        refuse(now_.column, fmt::format("the expression ends here, expected {}", expected));
    const std::string_view shown = now_.text.substr(0, longest_shown);
    refuse(now_.column, fmt::format("'{}', expected {}", shown, expected));
}

// Letters of UTF-8 may have several bytes; only the first of them is counted.
std::size_t SelectionWords::column_of(std::size_t byte) noexcept {
    const auto is_first = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; };
    const std::string_view passed = text_.substr(counted_byte_, byte - counted_byte_);
    counted_column_ += static_cast<std::size_t>(std::ranges::count_if(passed, is_first));
    counted_byte_ = byte;
    return counted_column_;
}

SelectionToken SelectionWords::read_quoted() {
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    const std::size_t column = column_of(at_);
    if (end == std::string_view::npos)
        refuse(column, fmt::format("the quotation mark has no end, expected {} after the name",
                                   text_[at_] == '"' ? "\"" : "'"));
    const SelectionToken token{SelectionToken::Kind::Quoted, text_.substr(at_ + 1, end - at_ - 1),
                               column};
    at_ = end + 1;
    return token;
}

void SelectionWords::advance() {
    using enum SelectionToken::Kind;
    at_ = std::min(text_.find_first_not_of(selection_blanks, at_), text_.size());
    if (at_ == text_.size()) {
        now_ = {End, {}, column_of(at_)};
        return;
    }
    const char first = text_[at_];
    if (first == '"' || first == '\'') {
        now_ = read_quoted();
        return;
    }
    std::size_t end = at_ + 1;
    SelectionToken::Kind kind = Word;
    if (first == '(' || first == ')' || first == ',') {
        kind = first == '(' ? Open : first == ')' ? Close : Comma;
    } else if (word_ends.find(first) != std::string_view::npos) {
        kind = Compare;
        if (end < text_.size() && text_[end] == '=') ++end;
    } else {
        end = std::min(text_.find_first_of(word_ends, at_), text_.size());
    }
    now_ = {kind, text_.substr(at_, end - at_), column_of(at_)};
    at_ = end;
}

}  // namespace palpa
