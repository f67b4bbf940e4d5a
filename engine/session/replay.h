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
    // Reads trace.csv (or trace.csv.gz) of a recording of so many ticks whose trace keeps one row
    // of `every`. What is behind the last whole line of one that was cut off does not count.
    // Columns are found by name: of version 1 those that came later may lack. Throws LoadError if
    // there is no trace, if it lacks another column, or has one that this program does not know and
    // the recording is not of a newer minor version.
    TraceCheck(const std::filesystem::path& folder, std::uint64_t ticks, std::int64_t every,
               std::size_t hands = 1);

    // Adds every tick of the run in order; ticks after the last recorded row are ignored.
    void add(std::span<const ServoTick> ticks);  // of all hands
    void add(const ServoTick& tick) { add({&tick, 1}); }

    const std::string& file() const noexcept { return file_; }  // the trace
    std::uint64_t recorded() const noexcept { return rows_.size(); }
    std::uint64_t compared() const noexcept { return compared_; }
    std::uint64_t different() const noexcept { return different_; }
    // True if rows are missing at the end of the recording. The next function counts surplus rows.
    bool is_cut_off() const noexcept { return rows_.size() < whole_; }
    std::uint64_t surplus() const noexcept { return is_cut_off() ? 0 : rows_.size() - whole_; }
    // Number of rows with a value that is not finite, recorded or played.
    std::uint64_t not_finite() const noexcept { return not_finite_; }
    // What a user should know of the columns, a sentence each.
    const std::vector<std::string>& notes() const noexcept { return notes_; }
    const std::optional<TraceDifference>& first() const noexcept { return first_; }
    // Largest difference between device forces, N.
    double largest_newton() const noexcept { return largest_newton_; }

private:
    void choose_columns(const std::filesystem::path& folder, std::size_t hands);
    void note(std::string_view recorded, std::string_view played);

    std::string file_, text_;
    std::vector<std::string_view> rows_, columns_;  // of `text_`; the columns that are compared
    // Their numbers in rows as recorded and as played; empty where all are compared.
    std::vector<std::size_t> recorded_, played_;
    std::size_t recorded_columns_ = 0;
    std::vector<std::string> notes_;
    bool relaxes_ = false;  // it has the columns of molecules that relax
    std::int64_t every_;
    std::uint64_t whole_;  // rows of the complete recording
    std::uint64_t tick_ = 0, compared_ = 0, different_ = 0, not_finite_ = 0;
    std::optional<TraceDifference> first_;
    double largest_newton_ = 0;
};

}  // namespace palpa
