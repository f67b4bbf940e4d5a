// The size of a recording, its rate of growth, and the free space on its disk.
#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace palpa {

// A recording under way.
struct RecordingState {
    double recorded_s = 0;
    std::uint64_t bytes = 0;                    // of all its files
    std::optional<std::uint64_t> free_bytes{};  // left on the disk; nothing: not known
    double bytes_per_s = 0;                     // of the last 10 to 20 s; 0: not known yet
};

// Seconds until the disk is full at the present rate; nothing while that is not known.
std::optional<double> seconds_left(const RecordingState& state) noexcept;

// A recording that has ended: compressed, unless `problem` says why not.
struct EndedRecording {
    std::filesystem::path folder;
    std::uint64_t bytes = 0;
    std::string problem{};
};

// Bytes of all files in a folder and in those below it.
std::uint64_t measure_folder(const std::filesystem::path& folder);

// "12 MB", "4.8 GB", "48 GB", with powers of ten.
std::string describe_bytes(std::uint64_t bytes);

class RecordingMeter {
public:
    // Measures at most once a second; returns nothing in between.
    std::optional<RecordingState> measure(const std::filesystem::path& folder, double recorded_s);

private:
    std::filesystem::path folder_;
    std::chrono::steady_clock::time_point measured_{};
    RecordingState before_, from_;  // 10 s apart; the rate is that since the older one
};

}  // namespace palpa
