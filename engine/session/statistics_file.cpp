#include "session/statistics_file.h"

#include "core/load_error.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr auto ticks_per_row = static_cast<std::uint64_t>(servo_rate_hz);

// What may be replaced goes first.
const fs::path& make_room(const fs::path& path, bool overwrites) {
    if (check_output(path, statistics_header, overwrites) == Existing::Refuse) return path;
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return path;  // a device or a pipe
    fs::remove(path, error);
    if (error) throw LoadError({path.string()}, "cannot be replaced: " + error.message());
    return path;
}

}  // namespace

StatisticsFile::StatisticsFile(const fs::path& path, bool overwrites)
    : file_(make_room(path, overwrites)) {
    file_.write(fmt::format("{}\n", statistics_header));
}

void StatisticsFile::add_step(double took_us) {
    second_.add_step(1e-6 * took_us, true);
    most_us_ = std::max(most_us_, took_us);
}

void StatisticsFile::add(const ServoTick& tick, std::uint64_t overruns) {
    second_.add(tick);
    if (++ticks_ % ticks_per_row != 0) return;
    const Summary s = second_.summary();
    const std::chrono::duration<double> wall = Clock::now() - start_;
    file_.write(fmt::format("{:.3f},{:.3f},{},{:.4g},{:.4g},{:.4g},{},{:.4g},{:.4g},{},{}\n",
                            wall.count(), static_cast<double>(ticks_) * servo_tick_s, s.steps,
                            s.step_median_us, s.step_p99_us, most_us_, overruns - overruns_before_,
                            s.safety_share, s.largest_felt_N, s.net_work_J,
                            tick.contact.potential_kcal_per_mol));
    second_ = Statistics(servo_tick_s);
    most_us_ = 0;
    overruns_before_ = overruns;
}

}  // namespace palpa
