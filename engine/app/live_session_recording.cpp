// Recordings of a live session, and the thread that writes and compresses them.
#include "app/live_session.h"
#include "core/load_error.h"

#include <fmt/format.h>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace palpa {

void LiveSession::begin_recording(const std::filesystem::path& folder, bool overwrites,
                                  const std::optional<TrajectorySettings>& trajectory) {
    const std::lock_guard lock(recorder_mutex_);
    if (plays_)
        throw LoadError({folder.string()},
                        "cannot be recorded: a trajectory moves the atoms, and a recording does "
                        "not hold its frames; expected a session without a trajectory");
    if (recorder_.is_recording())
        throw LoadError({folder.string()}, "another recording is running; end it first (F9)");
    record_what_happened();
    recording_problem_.clear();
    recorder_.begin(folder, overwrites, trajectory);
    recorded_in_ = folder;
    recorded_ = {};
    if (trajectory) trajectory_queue_.begin(trajectory->per_second);
}

void LiveSession::end_recording() {
    const std::optional<UnbindingPath> unbinding = find_unbinding();
    const std::lock_guard lock(recorder_mutex_);
    trajectory_queue_.end();
    record_what_happened();
    const bool was_recording = recorder_.is_recording();
    recorder_.end(unbinding);
    if (was_recording) to_pack_.push_back(recorded_in_);
    if (recording_problem_.empty()) return;
    throw LoadError({"recording"}, std::exchange(recording_problem_, {}));
}

void LiveSession::write_statistics(const std::filesystem::path& path, bool overwrites) {
    const std::lock_guard lock(recorder_mutex_);
    recorder_.write_statistics(path, overwrites);
}

std::optional<RecordingState> LiveSession::recording() {
    const std::lock_guard lock(recorder_mutex_);
    if (!recorder_.is_recording()) return std::nullopt;
    recorded_.recorded_s = recorder_.recorded_s();
    return recorded_;
}

std::optional<double> LiveSession::packed_share() {
    const std::lock_guard lock(recorder_mutex_);
    if (to_pack_.empty()) return std::nullopt;
    return packed_share_ / static_cast<double>(to_pack_.size());
}

std::vector<EndedRecording> LiveSession::take_ended() {
    const std::lock_guard lock(recorder_mutex_);
    return std::exchange(ended_, {});
}

void LiveSession::stop_packing() { packs_ = false; }

std::vector<std::string> LiveSession::take_recording_notes() {
    const std::lock_guard lock(recorder_mutex_);
    std::vector<std::string> notes = recorder_.take_notes();
    if (const std::size_t lost = trajectory_queue_.take_lost(); lost > 0)
        notes.push_back(fmt::format(
            "{} frames of the trajectory are missing: the disk was too slow to write them", lost));
    if (!recorder_.is_recording() && !recording_problem_.empty())
        notes.push_back(std::exchange(recording_problem_, {}));
    return notes;
}

void LiveSession::run_recorder() {
    constexpr std::chrono::milliseconds between{20}, between_pieces{5};
    for (bool is_last = false; !is_last;) {
        is_last = recorder_stopping_;
        {
            const std::lock_guard lock(recorder_mutex_);
            record_what_happened();
            if (is_last) end_at_last();
        }
        measure_recording();
        const bool packs = pack_piece();  // a session that goes on needs the cores more
        if (!is_last) std::this_thread::sleep_for(packs ? between_pieces : between);
    }
    while (pack_piece()) {
    }
}

// A recording that nobody ended, after the simulation's thread.
void LiveSession::end_at_last() {
    if (!recorder_.is_recording()) return;
    try {
        recorder_.end(simulation_.unbinding());
        to_pack_.push_back(recorded_in_);
    } catch (const LoadError& error) {
        recording_problem_ = error.what();
    }
}

// Once a second, without keeping the window waiting for the disk.
void LiveSession::measure_recording() {
    std::filesystem::path folder;
    double recorded_s = 0;
    {
        const std::lock_guard lock(recorder_mutex_);
        if (!recorder_.is_recording()) return;
        folder = recorded_in_;
        recorded_s = recorder_.recorded_s();
    }
    const std::optional<RecordingState> measured = meter_.measure(folder, recorded_s);
    if (!measured) return;
    const std::lock_guard lock(recorder_mutex_);
    if (recorded_in_ == folder) recorded_ = *measured;
}

// Returns false if nothing is left to be compressed.
bool LiveSession::pack_piece() {
    std::filesystem::path folder;
    {
        const std::lock_guard lock(recorder_mutex_);
        if (to_pack_.empty()) return false;
        folder = to_pack_.front();
    }
    std::string problem;
    bool goes_on = false;
    try {
        if (!packer_ && packs_) packer_.emplace(folder);
        goes_on = packs_ && packer_->pack_piece();
    } catch (const LoadError& error) {
        problem = error.what();
    }
    const double share = goes_on ? packer_->share() : 0;
    if (!goes_on) packer_.reset();
    const std::uint64_t bytes = goes_on ? 0 : measure_folder(folder);
    const std::lock_guard lock(recorder_mutex_);
    packed_share_ = share;
    if (goes_on) return true;
    to_pack_.pop_front();
    ended_.push_back({folder, bytes, problem});
    return true;
}

void LiveSession::record_what_happened() {
    if (journal_queue_.dropped() > 0) {
        recorder_.lose();
        if (recorder_.is_recording() && recording_problem_.empty())
            recording_problem_ =
                "servo ticks are missing: the machine was too busy to record them all, so a replay "
                "will not be exact";
    }
    recorder_.note_overruns(overruns_);
    journal_queue_.hand_to(recorder_);
    for (const TrajectoryShot& shot : trajectory_queue_.take()) recorder_.add(shot);
    if (std::string failure = recorder_.take_failure(); !failure.empty()) {
        trajectory_queue_.end();
        recording_problem_ = std::move(failure);
    }
}

}  // namespace palpa
