#include "charmm/statements.h"

#include "core/text.h"

#include <fmt/format.h>
#include <optional>

namespace palpa {

Statements::Statements(std::string_view text, const std::string& file)
    : lines_(split_lines(text)), file_(file) {}

bool Statements::next() {
    statement_.clear();
    for (bool continued = true; continued && at_ < lines_.size();) {
        const std::string_view raw = lines_[at_];
        std::string_view line = trimmed(raw.substr(0, raw.find('!')));
        ++at_;
        const bool ends_open = line.ends_with('-');
        if (ends_open) line = trimmed(line.substr(0, line.size() - 1));
        if (statement_.empty() && (line.empty() || line.starts_with('*'))) continue;
        if (statement_.empty()) line_ = at_;
        continued = ends_open;
        if (!statement_.empty()) statement_ += ' ';
        statement_ += upper_case(line);
    }
    words_ = split_words(statement_);
    for (const std::string_view word : words_) {
        constexpr std::size_t most = 100, shown = 20;  // no name or number is that long
        if (word.size() <= most) continue;
        fail(fmt::format("the word '{}...' has {} letters; expected at most {}",
                         word.substr(0, shown), word.size(), most));
    }
    return !words_.empty();
}

void Statements::fail(const std::string& what) const { throw LoadError(place(), what); }

std::string Statements::name(std::size_t at, const char* what) const {
    if (at >= words_.size()) fail(fmt::format("the {} is missing", what));
    return std::string(words_[at]);
}

double Statements::real(std::size_t at, const char* what) const {
    if (at >= words_.size()) fail(fmt::format("the {} is missing", what));
    const std::optional<double> value = find_real(words_[at]);
    if (!value) fail(fmt::format("'{}' is not a number; expected the {}", words_[at], what));
    return *value;
}

std::int64_t Statements::whole_number(std::size_t at, const char* what) const {
    if (at >= words_.size()) fail(fmt::format("the {} is missing", what));
    const std::optional<std::int64_t> value = find_integer(words_[at]);
    if (!value) fail(fmt::format("'{}' is not a whole number; expected the {}", words_[at], what));
    return *value;
}

void Statements::expect_form(std::string_view form) const {
    const std::vector<std::string_view> parts = split_words(form);
    const std::size_t count = words_.size();
    if (count < parts.size() && !parts[count].starts_with('[')) {
        const std::string_view lacking = parts[count].substr(0, parts[count].find(']'));
        fail(fmt::format("the {} is missing; expected: {}", lacking, form));
    }
    if (count > parts.size()) {
        fail(fmt::format("extra word '{}'; expected: {} (a comment begins with '!')",
                         words_[parts.size()], form));
    }
}

}  // namespace palpa
