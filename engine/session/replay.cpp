#include "session/replay.h"

#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "session/recording.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

}  // namespace

TraceCheck::TraceCheck(const std::filesystem::path& folder, std::uint64_t ticks, std::int64_t every,
                       std::size_t hands)
    : text_(read_text_file(folder / "trace.csv")), every_(every) {
    const auto step = static_cast<std::uint64_t>(every);
    whole_ = (ticks + step - 1) / step;
    const std::string file = (folder / "trace.csv").string();
    std::string_view rest = text_;
    const auto take_line = [&]() -> std::optional<std::string_view> {
        const std::size_t end = rest.find('\n');
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(end + 1);
        return line;
    };
    const std::optional<std::string_view> header = take_line();
    if (!header) throw LoadError({file, 1}, "has no complete line; expected a recorded trace");
    relaxes_ = *header == trace_header(hands, true);
    if (!relaxes_ && *header != trace_header(hands)) {
        throw LoadError({file, 1},
                        "has different columns than this program records; expected a recording of "
                        "the same version (session.toml names its version)");
    }
    columns_ = split_row(*header);
    while (const std::optional<std::string_view> line = take_line()) rows_.push_back(*line);
}

void TraceCheck::add(std::span<const ServoTick> ticks) {
    if (tick_++ % static_cast<std::uint64_t>(every_) != 0 || compared_ >= rows_.size()) return;
    const std::string_view recorded = rows_[compared_++];
    std::string played = trace_row(ticks, relaxes_);
    played.pop_back();  // its end of line
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
