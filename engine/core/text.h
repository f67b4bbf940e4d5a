// Text functions that the readers share: words, numbers, near names.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// The text without blanks, tabs and carriage returns at both ends.
std::string_view trimmed(std::string_view text) noexcept;

// The words between blanks and tabs; views into `text`.
std::vector<std::string_view> split_words(std::string_view text);

// The lines of a text without their ends ("\n" or "\r\n"); views into `text`.
std::vector<std::string_view> split_lines(std::string_view text);

std::string upper_case(std::string_view text);

// Makes text safe for one line of a terminal: valid UTF-8 letters stay, control characters and
// other bytes become "\\x1b".
std::string printable(std::string_view text);

// A finite number that fills `text` wholly (blanks at the ends allowed), or nothing. A leading '+'
// and Fortran's exponent letter D are accepted.
std::optional<double> find_real(std::string_view text);
std::optional<std::int64_t> find_integer(std::string_view text);

// The shortest text that reads back as the same number, with a point or exponent so that it is not
// a whole number.
std::string format_real(double value);

// The name of `names` that differs from `name` by the fewest edits (a letter more, fewer or
// another, two neighbours swapped; case ignored), if that is one or at most a third of its length;
// empty otherwise. For "did you mean".
std::string_view find_near_name(std::string_view name, std::span<const std::string_view> names);

// "; did you mean 'near'?" or nothing.
std::string near_name_hint(std::string_view name, std::span<const std::string_view> names);

// 64-bit FNV-1a: distinguishes two texts, is no protection against anyone.
std::uint64_t content_hash(std::string_view text, std::uint64_t seed = 0xcbf29ce484222325) noexcept;

}  // namespace palpa
