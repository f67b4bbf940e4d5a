#include "molecule/selection_match.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace palpa {
namespace {

// With * for any letters, and ? for one.
bool fits_pattern(std::string_view pattern, std::string_view text) noexcept {
    std::size_t p = 0, t = 0, star = std::string_view::npos, taken = 0;
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            taken = t;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
            ++p, ++t;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            t = ++taken;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', std::min(p, pattern.size())) == std::string_view::npos;
}

}  // namespace

bool fits(const NamePattern& name, std::string_view text) noexcept {
    return name.is_pattern ? fits_pattern(name.text, text) : name.text == text;
}

bool fits_any(std::span<const NamePattern> names, std::string_view text) noexcept {
    return std::ranges::any_of(names, [&](const NamePattern& name) { return fits(name, text); });
}

bool is_in(const NumberSpan& span, const ResidueNumber& value) noexcept {
    const auto& [first, last] = span;
    if (value.number < first.number || value.number > last.number) return false;
    if (first.number == last.number && first.code == last.code) return value.code == first.code;
    if (value.number == first.number && value.code < first.code) return false;
    return value.number < last.number || last.code == ' ' || value.code <= last.code;
}

bool holds(Comparison comparison, double a, double b) noexcept {
    switch (comparison) {
        case Comparison::Less:
            return a < b;
        case Comparison::LessEqual:
            return a <= b;
        case Comparison::Greater:
            return a > b;
        case Comparison::GreaterEqual:
            return a >= b;
        case Comparison::Equal:
            return a == b;
        case Comparison::NotEqual:
            return a != b;
    }
    return false;
}

std::string_view chain_in(std::string_view segment) noexcept {
    constexpr auto kinds =
        std::to_array<std::string_view>({"PRO", "DNA", "RNA", "CAR", "HET", "ION", "WAT"});
    const bool has_kind =
        segment.size() == 4 && std::ranges::find(kinds, segment.substr(0, 3)) != kinds.end();
    return has_kind ? segment.substr(3) : segment;
}

}  // namespace palpa
