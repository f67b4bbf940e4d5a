// Compares a recorded trace with a run of the same session.
#pragma once
#include "haptics/servo.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// The first difference between two traces.
struct TraceDifference {
    std::uint64_t row = 0;  // counted from 1 after the header: line row + 1 of the file
    std::string time_s;     // recorded time
    std::string column;     // name of the column, or "number of columns"
    std::string recorded, played;
};

// Compares row by row to the last digit; equal rows have the same bits.
class TraceCheck {
public:
    // Reads trace.csv of a recording of `ticks` ticks with a row every `every` ticks. An incomplete
    // last line of an interrupted recording is ignored. Throws LoadError if the file is missing, or
    // if its columns are not those of this program.
    TraceCheck(const std::filesystem::path& folder, std::uint64_t ticks, std::int64_t every,
               std::size_t hands = 1);

    // Adds every tick of the run in order; ticks after the last recorded row are ignored.
    void add(std::span<const ServoTick> ticks);  // of all hands
    void add(const ServoTick& tick) { add({&tick, 1}); }

    std::uint64_t recorded() const noexcept { return rows_.size(); }
    std::uint64_t compared() const noexcept { return compared_; }
    std::uint64_t different() const noexcept { return different_; }
    // True if rows are missing at the end of the recording. The next function counts surplus rows.
    bool is_cut_off() const noexcept { return rows_.size() < whole_; }
    std::uint64_t surplus() const noexcept { return is_cut_off() ? 0 : rows_.size() - whole_; }
    // Number of rows with a value that is not finite, recorded or played.
    std::uint64_t not_finite() const noexcept { return not_finite_; }
    const std::optional<TraceDifference>& first() const noexcept { return first_; }
    // Largest difference between device forces, N.
    double largest_newton() const noexcept { return largest_newton_; }

private:
    void note(std::string_view recorded, std::string_view played);

    std::string text_;
    std::vector<std::string_view> rows_, columns_;  // views into `text_`
    bool relaxes_ = false;  // the trace has the columns for molecules that relax
    std::int64_t every_;
    std::uint64_t whole_;  // rows of the complete recording
    std::uint64_t tick_ = 0, compared_ = 0, different_ = 0, not_finite_ = 0;
    std::optional<TraceDifference> first_;
    double largest_newton_ = 0;
};

}  // namespace palpa
