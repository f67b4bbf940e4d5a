// Steps through a text line by line without copying it, and cuts fields out of fixed columns.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

// Lines as split_lines gives them, one at a time.
class LineReader {
public:
    explicit LineReader(std::string_view text) noexcept;

    // Behind the last line; line() is empty there, and number() still the last line's.
    bool at_end() const noexcept { return at_end_; }
    bool at_last_line() const noexcept { return !at_end_ && rest_.empty(); }
    std::string_view line() const noexcept { return line_; }
    std::size_t number() const noexcept { return number_; }  // from 1; 0 in an empty text
    void advance() noexcept;

private:
    std::string_view rest_, line_;  // what comes behind the line, and the line
    std::size_t number_ = 0;
    bool at_end_ = false;
};

// How many lines begin with `beginning`.
std::size_t count_lines(std::string_view text, std::string_view beginning) noexcept;

// Columns count from 0, messages from 1.
struct Columns {
    std::size_t first, count;
};

// What stands in these columns, without the blanks around it; empty where the line ends before.
std::string_view find_field(std::string_view line, Columns columns) noexcept;

// Printable ASCII without blanks, and not empty: what a name in a structure file may be.
bool is_name(std::string_view text) noexcept;

// The words between commas, blanks and line ends, each with a comma behind it.
std::string chain_list(std::string_view text);

// What a message quotes of a word that may be as long as its file.
std::string_view shortened(std::string_view text) noexcept;

// A number within `farthest_coordinate`, Å, or nothing. What lies farther out is a slip
// in the file: no structure is that large.
inline constexpr double farthest_coordinate = 1e5;
std::optional<double> find_coordinate(std::string_view text);

}  // namespace palpa
