#include "devices/played_handle.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "devices/emulated_omni.h"
#include "formats/gzip.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

namespace palpa {
namespace {

constexpr std::array<std::string_view, 10> column_names{"time_s",
                                                        "handle_x_m",
                                                        "handle_y_m",
                                                        "handle_z_m",
                                                        "clutch",
                                                        "handle_turn_x_rad",
                                                        "handle_turn_y_rad",
                                                        "handle_turn_z_rad",
                                                        "cap_N_per_m",
                                                        "at_stop"};
constexpr std::size_t needed_columns = 4;  // the first ones
constexpr std::size_t other_column = column_names.size();

// One value of each column; those that are not there are 0.
using Values = std::array<double, column_names.size()>;

// Letters of a word, in a message.
constexpr std::size_t most_quoted = 40;

// A turn of more would be none that a wrist makes.
constexpr double most_turn_rad = 10;

// No coupling lets a hand feel more.
constexpr double most_cap_N_per_m = 1e9;

// Which value stands where in a line.
std::vector<std::size_t> find_columns(std::string_view header, const TextPlace& place,
                                      bool takes_others) {
    std::vector<std::size_t> columns;
    std::array<bool, column_names.size()> has{};
    for (std::size_t begin = 0; begin <= header.size();) {
        const std::size_t end = std::min(header.find(',', begin), header.size());
        const std::string name(trimmed(header.substr(begin, end - begin)));
        const auto* const found = std::find(column_names.begin(), column_names.end(), name);
        const auto column = static_cast<std::size_t>(found - column_names.begin());
        begin = end + 1;
        if (found == column_names.end()) {
            if (!takes_others) {
                throw LoadError(
                    place, fmt::format("unknown column '{}'; expected names from {}{}",
                                       name.substr(0, most_quoted), fmt::join(column_names, ", "),
                                       near_name_hint(name, column_names)));
            }
            columns.push_back(other_column);
            continue;
        }
        if (std::exchange(has[column], true)) {
            throw LoadError(place, fmt::format("column '{}' is repeated", name));
        }
        columns.push_back(column);
    }
    for (std::size_t i = 0; i < needed_columns; ++i) {
        if (has[i]) continue;
        throw LoadError(place, fmt::format("column '{}' is missing; expected column names in the "
                                           "first line, with {} among them",
                                           column_names[i],
                                           fmt::join(column_names.begin(),
                                                     column_names.begin() + needed_columns, ", ")));
    }
    return columns;
}

Values parse_values(std::string_view line, const TextPlace& place,
                    const std::vector<std::size_t>& columns) {
    Values values{};
    std::size_t column = 0;
    for (std::size_t begin = 0; begin <= line.size(); ++column) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        if (column < columns.size() && columns[column] != other_column) {
            const std::string_view text = line.substr(begin, end - begin);
            const std::optional<double> value = find_real(text);
            if (!value) {
                throw LoadError(place, fmt::format("'{}' is not a number; expected one for {}",
                                                   trimmed(text).substr(0, most_quoted),
                                                   column_names[columns[column]]));
            }
            values[columns[column]] = *value;
        }
        begin = end + 1;
    }
    if (column != columns.size()) {
        throw LoadError(place,
                        fmt::format("the row has {} values; expected {}, one for each column name",
                                    column, columns.size()));
    }
    return values;
}

PlayedRow row_of(const Values& values, const TextPlace& place, double reach_m) {
    const PlayedRow row{values[0],
                        {values[1], values[2], values[3]},
                        {values[5], values[6], values[7]},
                        values[4] != 0,
                        values[8],
                        values[9] != 0};
    if (row.handle_m.cwiseAbs().maxCoeff() > reach_m) {
        throw LoadError(place,
                        fmt::format("the handle is {:.6g} m from the middle; expected at most {} m",
                                    row.handle_m.cwiseAbs().maxCoeff(), reach_m));
    }
    if (row.turn_rad.cwiseAbs().maxCoeff() > most_turn_rad) {
        throw LoadError(place,
                        fmt::format("the handle is turned by {:.6g} rad; expected at most {} rad",
                                    row.turn_rad.cwiseAbs().maxCoeff(), most_turn_rad));
    }
    if (!(row.cap_N_per_m >= 0 && row.cap_N_per_m <= most_cap_N_per_m)) {
        throw LoadError(place, fmt::format("cap_N_per_m is {:.6g}; expected 0 to {}",
                                           row.cap_N_per_m, most_cap_N_per_m));
    }
    if (values[4] != 0 && values[4] != 1) {
        throw LoadError(place, fmt::format("clutch is {:.6g}; expected 0 or 1", values[4]));
    }
    if (values[9] != 0 && values[9] != 1) {
        throw LoadError(place, fmt::format("at_stop is {:.6g}; expected 0 or 1", values[9]));
    }
    return row;
}

std::vector<PlayedRow> parse_table(std::string_view text, const std::string& file,
                                   bool is_recorded) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    // Of a recording only whole lines count.
    if (is_recorded) text = text.substr(0, text.find_last_of('\n') + 1);
    std::vector<std::size_t> columns;
    std::vector<PlayedRow> rows;
    TextPlace place{file, 0};
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = trimmed(text.substr(begin, end - begin));
        begin = end + 1;
        ++place.line;
        if (line.empty() || line.starts_with('#')) continue;
        if (columns.empty()) {
            columns = find_columns(line, place, is_recorded);
            continue;
        }
        const PlayedRow row = row_of(parse_values(line, place, columns), place,
                                     is_recorded ? trace_reach_m : script_reach_m);
        if (!rows.empty() && !(row.time_s > rows.back().time_s)) {
            throw LoadError(place,
                            fmt::format("the time {} s follows {} s; expected ascending times",
                                        row.time_s, rows.back().time_s));
        }
        rows.push_back(row);
    }
    if (rows.empty()) {
        throw LoadError({file}, "has no rows; expected column names and one row for each time");
    }
    return rows;
}

}  // namespace

std::vector<PlayedRow> parse_script(std::string_view text, const std::string& file) {
    return parse_table(text, file, false);
}

std::vector<PlayedRow> parse_trace(std::string_view text, const std::string& file) {
    return parse_table(text, file, true);
}

std::vector<PlayedRow> read_script(const std::filesystem::path& file) {
    return parse_script(read_text_file(file), file.string());
}

std::vector<PlayedRow> read_trace(const std::filesystem::path& recording) {
    std::error_code error;
    const bool is_folder = std::filesystem::is_directory(recording, error);
    const std::filesystem::path file =
        is_folder ? find_plain_or_packed(recording / "trace.csv") : recording;
    return parse_trace(read_recorded_file(file), file.string());
}

PlayedHandle::PlayedHandle(PlayedHandleSettings settings)
    : settings_(std::move(settings)), time_(settings_.orders) {
    spec_.name = settings_.name;
    spec_.is_real = false;
    spec_.viscosity_N_s_per_m = settings_.viscosity_N_s_per_m;
    if (!settings_.rows.empty()) spec_.cap_N_per_m = settings_.rows.front().cap_N_per_m;
    // The Omni's, as most recordings are of one; more where the table needs it.
    spec_.half_workspace_m = omni_half_workspace_m;
    for (const PlayedRow& row : settings_.rows) {
        spec_.half_workspace_m = spec_.half_workspace_m.cwiseMax(row.handle_m.cwiseAbs());
    }
}

DeviceReading PlayedHandle::read() noexcept {
    const PlayedRow row = row_now();
    const auto buttons = row.clutch ? static_cast<std::uint32_t>(Button::Clutch) : 0U;
    return {.time_s = static_cast<double>(tick_) / servo_rate_hz,
            .position_m = row.handle_m,
            .buttons = buttons,
            .valid = true,
            .orientation = turn_of(row.turn_rad),
            .at_stop = row.at_stop};
}

void PlayedHandle::write(const Vec3& /*force_newton*/) noexcept {
    const bool goes_on = time_.step();
    if (time_.was_restarted()) {
        start_tick_ = tick_;
        next_ = 0;
    }
    if (goes_on) ++tick_;
    const double now_s = static_cast<double>(tick_ - start_tick_) / servo_rate_hz;
    while (next_ < settings_.rows.size() && settings_.rows[next_].time_s <= now_s) ++next_;
}

PlayedRow PlayedHandle::row_now() const noexcept {
    const std::vector<PlayedRow>& rows = settings_.rows;
    if (rows.empty()) return {};
    if (next_ == 0) return rows.front();
    const PlayedRow& before = rows[next_ - 1];
    const double now_s = static_cast<double>(tick_ - start_tick_) / servo_rate_hz;
    if (next_ == rows.size() || before.time_s == now_s) return before;
    const PlayedRow& after = rows[next_];
    const double share = (now_s - before.time_s) / (after.time_s - before.time_s);
    PlayedRow row = before;
    row.handle_m += share * (after.handle_m - before.handle_m);
    row.turn_rad =
        rotation_vector_of(turn_between(turn_of(before.turn_rad), turn_of(after.turn_rad), share));
    return row;
}

}  // namespace palpa
