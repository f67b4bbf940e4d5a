#include "formats/lines.h"

#include "core/text.h"

#include <algorithm>
#include <cmath>

namespace palpa {

LineReader::LineReader(std::string_view text) noexcept : rest_(text) { advance(); }

void LineReader::advance() noexcept {
    line_ = {};
    at_end_ = rest_.empty();
    if (at_end_) return;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
}

std::size_t count_lines(std::string_view text, std::string_view beginning) noexcept {
    std::size_t count = 0;
    for (LineReader lines(text); !lines.at_end(); lines.advance()) {
        if (lines.line().starts_with(beginning)) ++count;
    }
    return count;
}

std::string_view find_field(std::string_view line, Columns columns) noexcept {
    if (line.size() <= columns.first) return {};
    return trimmed(line.substr(columns.first, columns.count));
}

bool is_name(std::string_view text) noexcept {
    return !text.empty() &&
           std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

std::string chain_list(std::string_view text) {
    std::string list;
    for (const char c : text) {
        const bool separates = c == ',' || c <= ' ';
        if (!separates) {
            list += c;
        } else if (!list.empty() && list.back() != ',') {
            list += ',';
        }
    }
    if (!list.empty() && list.back() != ',') list += ',';
    return list;
}

std::string_view shortened(std::string_view text) noexcept { return text.substr(0, 80); }

std::optional<double> find_coordinate(std::string_view text) {
    const std::optional<double> value = find_real(text);
    if (!value || std::abs(*value) > farthest_coordinate) return std::nullopt;
    return value;
}

}  // namespace palpa
