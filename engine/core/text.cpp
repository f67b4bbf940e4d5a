#include "core/text.h"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace palpa {
namespace {

constexpr std::string_view blanks = " \t\r";

char upper(char letter) noexcept {
    return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

// How many bytes of UTF-8 the first letter has; 0 if it is a control character, turns the direction
// of the text, or is none at all (RFC 3629, section 4).
std::size_t letter_size(std::string_view text) noexcept {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
    };
    const auto follows = [&](std::size_t i) { return (byte(i) & 0xc0U) == 0x80; };
    const unsigned first = byte(0), second = byte(1);
    if (first < 0x80) return first >= ' ' && first != 0x7f ? 1 : 0;
    if (!follows(1)) return 0;
    if (first == 0xc2 && second < 0xa0) return 0;  // control characters beyond ASCII
    if (first >= 0xc2 && first < 0xe0) return 2;
    if (!follows(2)) return 0;
    const bool overlong = first == 0xe0 && second < 0xa0;
    const bool surrogate = first == 0xed && second >= 0xa0;
    // Marks that turn the direction of what follows: U+202A to U+202E, U+2066 to U+2069.
    const unsigned third = byte(2);
    const bool turns = first == 0xe2 && ((second == 0x80 && third >= 0xaa && third <= 0xae) ||
                                         (second == 0x81 && third >= 0xa6 && third <= 0xa9));
    if (first >= 0xe0 && first < 0xf0) return overlong || surrogate || turns ? 0 : 3;
    if (!follows(3)) return 0;
    const unsigned head = first << 8U | second;
    return head >= 0xf090 && head < 0xf490 ? 4 : 0;
}

// Levenshtein distance, case ignored.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<std::size_t> before(width), last(width), row(width);  // rows i - 1, i, i + 1
    std::iota(last.begin(), last.end(), std::size_t{0});
    const auto same = [&](std::size_t i, std::size_t j) { return upper(a[i]) == upper(b[j]); };
    for (std::size_t i = 0; i < a.size(); ++i) {
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            row[j + 1] = std::min({row[j] + 1, last[j + 1] + 1, last[j] + (same(i, j) ? 0 : 1)});
            const bool are_swapped = i > 0 && j > 0 && same(i, j - 1) && same(i - 1, j);
            if (are_swapped) row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
        }
        before.swap(last);
        last.swap(row);
    }
    return last.back();
}

// from_chars wants neither blanks nor a plus sign.
std::string_view bare_number(std::string_view text) noexcept {
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    return text;
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> split_words(std::string_view text) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; (at = text.find_first_not_of(blanks, at)) != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end;
    }
    return words;
}

std::vector<std::string_view> split_lines(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        lines.push_back(line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

std::string upper_case(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), upper);
    return result;
}

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const std::size_t size = letter_size(text);
        if (size > 0) {
            result += text.substr(0, size);
        } else {
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
        }
        text.remove_prefix(std::max<std::size_t>(size, 1));
    }
    return result;
}

std::optional<double> find_real(std::string_view text) {
    std::string digits(bare_number(text));
    std::replace_if(digits.begin(), digits.end(), [](char c) { return c == 'D' || c == 'd'; }, 'e');
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    if (!std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<std::int64_t> find_integer(std::string_view text) {
    text = bare_number(text);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string format_real(double value) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
    return text;
}

std::string_view find_near_name(std::string_view name, std::span<const std::string_view> names) {
    if (name.empty()) return {};
    std::string_view best;
    // A third of the letters, at least one, but never all of them.
    std::size_t fewest = std::min(std::max<std::size_t>(1, name.size() / 3), name.size() - 1) + 1;
    for (const std::string_view candidate : names) {
        const std::size_t edits = edit_distance(name, candidate);
        if (edits < fewest) {
            fewest = edits;
            best = candidate;
        }
    }
    return best;
}

std::string near_name_hint(std::string_view name, std::span<const std::string_view> names) {
    const std::string_view near = find_near_name(name, names);
    return near.empty() ? std::string() : "; did you mean '" + std::string(near) + "'?";
}

std::uint64_t content_hash(std::string_view text, std::uint64_t seed) noexcept {
    for (const char letter : text) {
        seed = (seed ^ static_cast<unsigned char>(letter)) * 0x100000001b3;
    }
    return seed;
}

}  // namespace palpa
