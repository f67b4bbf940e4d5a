#include "session/replay.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/gzip.h"
#include "session/recording.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace palpa {
namespace {

std::vector<std::string_view> split_row(std::string_view row) {
    std::vector<std::string_view> values;
    for (std::size_t begin = 0; begin <= row.size();) {
        const std::size_t end = std::min(row.find(',', begin), row.size());
        values.push_back(row.substr(begin, end - begin));
        begin = end + 1;
    }
    return values;
}

// Columns that recordings of version 2.0 lack, by how their names begin.
bool came_later(std::string_view column) {
    constexpr std::array<std::string_view, 4> later{"cap_N_per_m", "waiting_m", "clipped_m",
                                                    "at_stop"};
    return std::ranges::any_of(
        later, [&](std::string_view beginning) { return column.starts_with(beginning); });
}

// Some values of a row; all of one that has not as many values as the header has columns.
std::string choose_values(std::string_view row, std::span<const std::size_t> numbers,
                          std::size_t columns) {
    const std::vector<std::string_view> values = split_row(row);
    if (values.size() != columns) return std::string(row);
    std::vector<std::string_view> chosen;
    for (const std::size_t number : numbers) chosen.push_back(values[number]);
    return fmt::format("{}", fmt::join(chosen, ","));
}

}  // namespace

TraceCheck::TraceCheck(const std::filesystem::path& folder, std::uint64_t ticks, std::int64_t every,
                       std::size_t hands)
    : file_(find_plain_or_packed(folder / "trace.csv").string()),
      text_(read_recorded_file(folder / "trace.csv")),
      every_(every) {
    const auto step = static_cast<std::uint64_t>(every);
    whole_ = (ticks + step - 1) / step;
    std::string_view rest = text_;
    const auto take_line = [&]() -> std::optional<std::string_view> {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        return line;
    };
    const std::optional<std::string_view> header = take_line();
    if (!header) throw LoadError({file_, 1}, "has no complete line; expected a recorded trace");
    columns_ = split_row(*header);
    recorded_columns_ = columns_.size();
    relaxes_ = *header == trace_header(hands, true);
    if (!relaxes_ && *header != trace_header(hands)) choose_columns(folder, hands);
    while (const std::optional<std::string_view> line = take_line()) rows_.push_back(*line);
}

// Those that recording and program have.
void TraceCheck::choose_columns(const std::filesystem::path& folder, std::size_t hands) {
    const TextPlace place{file_, 1};
    const std::vector<std::string_view> theirs = std::exchange(columns_, {});
    relaxes_ = std::ranges::find(theirs, "force_error_estimate_nN") != theirs.end();
    const std::string header = trace_header(hands, relaxes_);
    const std::vector<std::string_view> ours = split_row(header);
    std::vector<std::string_view> unknown, lacking;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        const auto found = std::ranges::find(ours, theirs[i]);
        if (found == ours.end()) {
            unknown.push_back(theirs[i]);
            continue;
        }
        columns_.push_back(theirs[i]);
        recorded_.push_back(i);
        played_.push_back(static_cast<std::size_t>(found - ours.begin()));
    }
    const bool is_newer = read_recording_version(folder) > recording_version;
    if (!unknown.empty() && !is_newer) {
        throw LoadError(
            place, fmt::format("has a column '{}', which no recording of format {} has; "
                               "expected a trace as palpa run --record writes it",
                               printable(unknown[0].substr(0, 80)), to_string(recording_version)));
    }
    for (const std::string_view column : ours) {
        if (std::ranges::find(theirs, column) != theirs.end()) continue;
        if (!came_later(column)) {
            throw LoadError(place, fmt::format("lacks the column '{}'; expected a trace as palpa "
                                               "run --record writes it",
                                               column));
        }
        lacking.push_back(column);
    }
    if (!unknown.empty())
        notes_.push_back(fmt::format("{}: not compared, since this program does not know them: {}",
                                     place.file,
                                     printable(fmt::format("{}", fmt::join(unknown, ", ")))));
    if (!lacking.empty())
        notes_.push_back(fmt::format("{}: not compared, since this older recording lacks them: {}",
                                     place.file, fmt::join(lacking, ", ")));
}

void TraceCheck::add(std::span<const ServoTick> ticks) {
    if (tick_++ % static_cast<std::uint64_t>(every_) != 0 || compared_ >= rows_.size()) return;
    std::string recorded(rows_[compared_++]);
    std::string played = trace_row(ticks, relaxes_);
    played.pop_back();  // its end of line
    if (!played_.empty()) {
        const auto columns = static_cast<std::size_t>(std::ranges::count(played, ',') + 1);
        recorded = choose_values(recorded, recorded_, recorded_columns_);
        played = choose_values(played, played_, columns);
    }
    // "nan" and "inf" have a letter that no finite number has.
    // Of the error estimate they say that there is none, at the end of a row.
    const auto is_finite = [&](std::string_view row) {
        while (relaxes_ && row.ends_with(",nan")) row.remove_suffix(4);
        return row.find_first_of("nN") == row.npos;
    };
    if (!is_finite(recorded) || !is_finite(played)) ++not_finite_;
    if (played != recorded) note(recorded, played);
}

void TraceCheck::note(std::string_view recorded, std::string_view played) {
    ++different_;
    const std::vector<std::string_view> was = split_row(recorded), is = split_row(played);
    if (was.size() != is.size() && !first_) {
        first_ = {compared_, std::string(was.front()), "number of columns",
                  std::to_string(was.size()), std::to_string(is.size())};
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const std::string_view before = i < was.size() ? was[i] : "",
                               now = i < is.size() ? is[i] : "";
        if (before == now) continue;
        if (!first_) {
            first_ = {compared_, std::string(was.front()), std::string(columns_[i]),
                      std::string(before), std::string(now)};
        }
        if (!columns_[i].starts_with("device_force")) continue;
        const std::optional<double> a = find_real(before), b = find_real(now);
        if (a && b) largest_newton_ = std::max(largest_newton_, std::abs(*a - *b));
    }
}

}  // namespace palpa
