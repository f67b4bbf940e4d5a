#include "session/trajectory_recorder.h"

#include "core/files.h"
#include "core/load_error.h"
#include "formats/psf.h"
#include "session/coordinates.h"

#include <fmt/format.h>
#include <cmath>
#include <string_view>
#include <utility>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view trajectory_mark = "A trajectory recorded by Palpa";

// A molecule that follows at once has no time of its own: formats that want picoseconds get one for
// each second of the session.
constexpr std::string_view trajectory_title =
    "A trajectory recorded by Palpa\n1 ps stands for 1 s of the session; nothing has a time of its "
    "own";

// Of a frame in the DCD form: three records of floats between their marks. The XTC form packs them
// into less.
std::uint64_t frame_bytes(const TrajectoryShot& shot, bool writes_xtc) {
    return (12 * shot.positions.size() + 24) * (writes_xtc ? 2 : 1);
}

}  // namespace

std::optional<TrajectoryShot> TrajectorySampler::take(const World& world, double time_s,
                                                      std::uint64_t edition) {
    if (!(per_second_ > 0) || time_s < static_cast<double>(taken_) / per_second_ - 1e-9)
        return std::nullopt;
    // One for all that were due meanwhile.
    taken_ = static_cast<std::uint64_t>(std::floor(time_s * per_second_ + 1e-6)) + 1;
    const AtomTable& atoms = world.resource<AtomTable>();
    if (!system_ || (edition != edition_ && !has_same_atoms(atoms, *system_)))
        system_ = std::make_shared<const Connectivity>(list_connectivity(world));
    edition_ = edition;
    return TrajectoryShot{time_s, atoms.positions, system_};
}

void TrajectoryQueue::begin(double per_second) {
    const std::lock_guard lock(mutex_);
    sampler_.emplace(per_second);
    shots_.clear();
    time_s_ = 0;
    lost_ = 0;
}

void TrajectoryQueue::end() {
    const std::lock_guard lock(mutex_);
    sampler_.reset();
}

void TrajectoryQueue::pass(const World& world, double seconds, std::uint64_t edition) {
    const std::lock_guard lock(mutex_);
    if (!sampler_) return;
    std::optional<TrajectoryShot> shot = sampler_->take(world, time_s_, edition);
    time_s_ += seconds;
    if (!shot) return;
    if (shots_.size() >= most_waiting) {
        ++lost_;
    } else {
        shots_.push_back(std::move(*shot));
    }
}

std::vector<TrajectoryShot> TrajectoryQueue::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(shots_, {});
}

std::size_t TrajectoryQueue::take_lost() {
    const std::lock_guard lock(mutex_);
    return std::exchange(lost_, 0);
}

TrajectoryFiles::TrajectoryFiles(fs::path folder, const TrajectorySettings& settings)
    : folder_(std::move(folder)), settings_(settings) {}

fs::path TrajectoryFiles::name(const char* stem, const char* ending) const {
    return folder_ / (number_ == 1 ? fmt::format("{}{}", stem, ending)
                                   : fmt::format("{}-{}{}", stem, number_, ending));
}

void TrajectoryFiles::begin(const TrajectoryShot& shot) {
    close();
    ++number_;
    frames_ = 0;
    system_ = shot.system;
    if (number_ > 1) {
        notes_.push_back(
            fmt::format("at {:.6g} s an edit changed the atoms; later frames are in {}, with the "
                        "atoms listed in {}",
                        shot.time_s, name("trajectory", ".dcd").filename().string(),
                        name("system", ".psf").filename().string()));
    }
    const std::string psf = format_psf(*system_, trajectory_title);
    bytes_ += psf.size();
    write_text_file(name("system", ".psf"), psf);
    const double step_s = 1 / settings_.per_second;
    dcd_.emplace(name("trajectory", ".dcd"), shot.positions.size(),
                 DcdOptions{.title = std::string(trajectory_title),
                            .first_step = static_cast<std::int32_t>(
                                std::lround(shot.time_s * settings_.per_second)),
                            .timestep_ps = step_s});
    if (settings_.writes_xtc) xtc_.emplace(name("trajectory", ".xtc"), shot.positions.size());
}

void TrajectoryFiles::add(const TrajectoryShot& shot) {
    if (is_over_ || !(settings_.per_second > 0) || shot.positions.empty()) return;
    bytes_ += frame_bytes(shot, settings_.writes_xtc);
    if (settings_.most_bytes && bytes_ > *settings_.most_bytes) {
        is_over_ = true;
        notes_.push_back(
            fmt::format("the trajectory ends at {:.6g} s because it has reached {} MiB; "
                        "--trajectory-fps N writes all of it",
                        shot.time_s, *settings_.most_bytes >> 20));
        return;
    }
    try {
        if (shot.system != system_) begin(shot);
        dcd_->add_frame(shot.positions);
        const double step = std::round(shot.time_s * settings_.per_second);
        if (xtc_) xtc_->add_frame(shot.positions, static_cast<std::int32_t>(step), shot.time_s);
        ++frames_;
    } catch (const LoadError& error) {
        is_over_ = true;
        notes_.push_back(fmt::format("the trajectory stops here: {}", error.what()));
    }
}

void TrajectoryFiles::close() {
    try {
        if (dcd_) dcd_->close();
        if (xtc_) xtc_->close();
    } catch (const LoadError& error) {
        is_over_ = true;
        notes_.push_back(fmt::format("the end of the trajectory is missing: {}", error.what()));
    }
    dcd_.reset();
    xtc_.reset();
}

std::vector<std::string> TrajectoryFiles::take_notes() { return std::exchange(notes_, {}); }

std::vector<fs::path> list_trajectory_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    const auto name = [&](const char* stem, int number, const char* ending) {
        return folder / (number == 1 ? fmt::format("{}{}", stem, ending)
                                     : fmt::format("{}-{}{}", stem, number, ending));
    };
    for (int number = 1;; ++number) {
        const fs::path dcd = name("trajectory", number, ".dcd");
        if (!has_mark(dcd, trajectory_mark)) return files;
        files.push_back(dcd);
        const fs::path psf = name("system", number, ".psf");
        if (has_mark(psf, trajectory_mark)) files.push_back(psf);
        const fs::path xtc = name("trajectory", number, ".xtc");  // which has no title
        if (fs::is_regular_file(fs::symlink_status(xtc, error))) files.push_back(xtc);
    }
}

}  // namespace palpa
