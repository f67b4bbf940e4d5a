#include "app/recording_meter.h"

#include <fmt/format.h>
#include <system_error>
#include <utility>

namespace palpa {

namespace fs = std::filesystem;

std::optional<double> seconds_left(const RecordingState& state) noexcept {
    if (!state.free_bytes || !(state.bytes_per_s > 0)) return std::nullopt;
    return static_cast<double>(*state.free_bytes) / state.bytes_per_s;
}

std::uint64_t measure_folder(const fs::path& folder) {
    std::uint64_t bytes = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code unread;  // a draft may be gone by now
        const std::uintmax_t size = fs::file_size(entry->path(), unread);
        if (!unread) bytes += size;
    }
    return bytes;
}

std::string describe_bytes(std::uint64_t bytes) {
    constexpr double megabyte = 1e6, gigabyte = 1e9;
    const auto amount = static_cast<double>(bytes);
    if (amount < gigabyte) return fmt::format("{:.0f} MB", amount / megabyte);
    return amount < 10 * gigabyte ? fmt::format("{:.1f} GB", amount / gigabyte)
                                  : fmt::format("{:.0f} GB", amount / gigabyte);
}

std::optional<RecordingState> RecordingMeter::measure(const fs::path& folder, double recorded_s) {
    constexpr std::chrono::seconds between{1};
    constexpr double rate_s = 10;
    const auto now = std::chrono::steady_clock::now();
    const bool is_new = folder != folder_;
    if (!is_new && now - measured_ < between) return std::nullopt;
    measured_ = now;
    RecordingState state{.recorded_s = recorded_s, .bytes = measure_folder(folder)};
    std::error_code error;
    const fs::space_info space = fs::space(folder, error);
    if (!error) state.free_bytes = space.available;
    // The journal before a recording is written at its begin, and is no part of the rate.
    if (is_new) before_ = from_ = state;
    folder_ = folder;
    if (const double passed_s = recorded_s - before_.recorded_s; passed_s > 0)
        state.bytes_per_s =
            (static_cast<double>(state.bytes) - static_cast<double>(before_.bytes)) / passed_s;
    if (recorded_s - from_.recorded_s > rate_s) before_ = std::exchange(from_, state);
    return state;
}

}  // namespace palpa
