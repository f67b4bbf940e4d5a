#include "session/session_recorder.h"

#include "core/assertion.h"
#include "core/load_error.h"
#include "haptics/device.h"
#include "session/run_headless.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

namespace palpa {
namespace {

constexpr std::size_t journal_flush_bytes = 1 << 16;

}  // namespace

SessionRecorder::SessionRecorder(const SceneDescription& scene, std::span<const HandDevice> devices)
    : scene_(scene), names_(scene), devices_(devices.begin(), devices.end()), writer_(devices) {}

void SessionRecorder::add(const PlayedEvent& event) {
    // An edit of files that cannot be read was refused, and changed nothing.
    if (!std::ranges::all_of(event.files, &std::optional<std::string>::has_value)) return;
    if (event.files.empty()) {
        writer_.add(event);
    } else {
        PlayedEvent own = event;
        EditAction& action =
            std::get<EditDescription>(std::get<CommandEvent>(own.event).command).action;
        const std::vector<std::filesystem::path*> files = list_files(action);
        PALPA_ASSERT(files.size() == event.files.size());
        for (std::size_t i = 0; i < files.size(); ++i) {
            const std::optional<std::string>& content = event.files[i];
            if (content) *files[i] = keep(*files[i], *content);
        }
        writer_.add(own);
    }
    if (const auto* const change = std::get_if<DeviceEvent>(&event.event))
        devices_[change->slot] = change->device;
    const auto* const step = std::get_if<StepEvent>(&event.event);
    if (step && statistics_file_) statistics_file_->add_step(step->took_us.value_or(0));
    if (!step || !recording_) return;
    for (Statistics& hand : statistics_) hand.add_step(1e-6 * step->took_us.value_or(0), true);
}

const std::string& SessionRecorder::keep(const std::filesystem::path& path,
                                         const std::string& content) {
    for (const KeptFile& file : files_) {
        if (file.path == path && file.content == content) return file.name;
    }
    files_.push_back({path, names_.add(path), content});
    std::size_t bytes = 0;
    for (const KeptFile& file : files_) bytes += file.content.size();
    kept_.set_beside(bytes);
    write_to_recording(
        [&](Recording& recording) { recording.add_input(files_.back().name, content); });
    return files_.back().name;
}

template <class Write>
void SessionRecorder::write_to_recording(const Write& write) {
    if (!recording_) return;
    try {
        write(*recording_);
    } catch (const LoadError& error) {
        failure_ = error.what();
        recording_.reset();
    }
}

void SessionRecorder::add(std::span<const LiveTick> ticks) {
    writer_.add(ticks);
    if (statistics_file_) {
        try {
            statistics_file_->add(ticks.front().tick, overruns_);
        } catch (const LoadError& error) {  // a full disk
            notes_.emplace_back(error.what());
            statistics_file_.reset();
        }
    }
    if (recording_) {
        std::vector<ServoTick> rows;
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            rows.push_back(ticks[i].tick);
            statistics_[i].add(ticks[i].tick);
        }
        write_to_recording([&](Recording& recording) { recording.add(rows); });
    }
    if (writer_.size() > journal_flush_bytes) flush();
}

void SessionRecorder::add(const TrajectoryShot& shot) {
    write_to_recording([&](Recording& recording) { recording.add_frame(shot); });
}

std::vector<std::string> SessionRecorder::take_notes() {
    std::vector<std::string> notes = std::exchange(notes_, {});
    if (!recording_) return notes;
    for (std::string& note : recording_->take_notes()) notes.push_back(std::move(note));
    return notes;
}

void SessionRecorder::begin(const std::filesystem::path& folder, bool overwrites,
                            const std::optional<TrajectorySettings>& trajectory) {
    flush();
    if (!is_whole_ || !kept_.is_whole()) {
        throw LoadError({folder.string()},
                        "cannot be recorded: the session is too long, or the disk was full, so "
                        "not all of it is kept; open the scene again and record from the start");
    }
    Recording& recording =
        recording_.emplace(folder, scene_, overwrites, devices_.size(), RecordedBy::Journal);
    try {
        write_beginning(recording, folder, trajectory);
    } catch (const LoadError&) {
        recording_.reset();
        throw;
    }
    statistics_.assign(devices_.size(), Statistics(servo_tick_s));
}

// The whole session so far, and the mark where this recording begins, which is its alone.
void SessionRecorder::write_beginning(Recording& recording, const std::filesystem::path& folder,
                                      const std::optional<TrajectorySettings>& trajectory) {
    for (const KeptFile& file : files_) recording.add_input(file.name, file.content);
    if (trajectory) recording.begin_trajectory(*trajectory);
    if (!kept_.hand_to([&](std::string_view text) { recording.add_journal(std::string(text)); })) {
        throw LoadError({folder.string()},
                        "cannot be recorded: the session's beginning, in a temporary file, could "
                        "not be read back");
    }
    writer_.begin_recording();
    recording.add_journal(writer_.take());
}

void SessionRecorder::end(const std::optional<UnbindingPath>& unbinding) {
    if (!recording_) return;
    flush();
    if (!recording_) throw LoadError({"recording"}, take_failure());
    Summary summary = statistics_.front().summary();
    summary.device = devices_.front().spec.name;
    summary.unbinding = unbinding;
    for (std::size_t i = 1; i < statistics_.size(); ++i) {
        summary.other_hands.push_back(statistics_[i].summary());
        summary.other_hands.back().device = devices_[i].spec.name;
    }
    warn_of_outcome(summary);
    try {
        recording_->finish(summary);
        notes_ = recording_->take_notes();
    } catch (const LoadError&) {
        recording_.reset();
        throw;
    }
    recording_.reset();
}

void SessionRecorder::write_statistics(const std::filesystem::path& path, bool overwrites) {
    statistics_file_.emplace(path, overwrites);
}

double SessionRecorder::recorded_s() const noexcept {
    return recording_ ? static_cast<double>(statistics_.front().ticks()) * servo_tick_s : 0;
}

void SessionRecorder::flush() {
    const std::string text = writer_.take();
    if (is_whole_) kept_.add(text);
    write_to_recording([&](Recording& recording) { recording.add_journal(text); });
}

}  // namespace palpa
