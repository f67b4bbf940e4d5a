// A row a second of how a run fares, readable while it lasts: what must not grow or drift over
// hours.
#pragma once
#include "core/files.h"
#include "haptics/servo.h"
#include "session/statistics.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace palpa {

// The first line, without its end. tools/recordings.md explains the columns.
inline constexpr std::string_view statistics_header =
    "wall_s,servo_s,steps,step_median_us,step_p99_us,step_most_us,overruns,held_back_share,"
    "largest_felt_N,hand_energy_J,potential_kcal_per_mol";

class StatisticsFile {
public:
    // Throws LoadError where the file is there, unless it has this header and `overwrites`.
    explicit StatisticsFile(const std::filesystem::path& path, bool overwrites = false);

    void add_step(double took_us);
    // Of the first hand. `overruns`: of the servo, so far. Every 1000th writes a row; throws
    // LoadError where that cannot be written.
    void add(const ServoTick& tick, std::uint64_t overruns = 0);

private:
    using Clock = std::chrono::steady_clock;

    NewFile file_;
    Clock::time_point start_ = Clock::now();
    std::uint64_t ticks_ = 0;          // so far
    Statistics second_{servo_tick_s};  // of the row that is being gathered, as all that follows
    double most_us_ = 0;
    std::uint64_t overruns_before_ = 0;
};

}  // namespace palpa
