// Steps through a text line by line without copying it, and cuts fields out of fixed columns.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace palpa {

// The lines of split_lines, one at a time.
class LineReader {
public:
    explicit LineReader(std::string_view text) noexcept;

    // True after the last line; line() is empty then, and number() is that of the last line.
    bool at_end() const noexcept { return at_end_; }
    bool at_last_line() const noexcept { return !at_end_ && rest_.empty(); }
    std::string_view line() const noexcept { return line_; }
    std::size_t number() const noexcept { return number_; }  // from 1; 0 in an empty text
    void advance() noexcept;

private:
    std::string_view rest_, line_;  // the rest of the text, and the present line
    std::size_t number_ = 0;
    bool at_end_ = false;
};

// Number of lines that begin with `beginning`.
std::size_t count_lines(std::string_view text, std::string_view beginning) noexcept;

// Columns count from 0, messages from 1.
struct Columns {
    std::size_t first, count;
};

// The text in these columns without surrounding blanks; empty if the line is shorter.
std::string_view find_field(std::string_view line, Columns columns) noexcept;

// Whether the text can be a name in a structure file: printable ASCII without blanks, not empty.
bool is_name(std::string_view text) noexcept;

// The words between commas, blanks and line ends, each followed by a comma.
std::string chain_list(std::string_view text);

// The beginning of a long word, for messages.
std::string_view shortened(std::string_view text) noexcept;

// A number within `farthest_coordinate` (Å), or nothing. Larger values are errors of the file.
inline constexpr double farthest_coordinate = 1e5;
std::optional<double> find_coordinate(std::string_view text);

}  // namespace palpa
