// A recorded session that a window plays again, from its journal: the same ticks and the same
// world, to the bit, which each row of the recorded trace is compared with.
#pragma once
#include "app/window_session.h"
#include "core/mailbox.h"
#include "core/ring.h"
#include "core/stage.h"
#include "session/journal.h"
#include "session/play_journal.h"
#include "session/replay.h"

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace palpa {

// In the place of one that moved a hand then.
class RecordedDevice final : public Device {
public:
    explicit RecordedDevice(DeviceSpec spec) : spec_(std::move(spec)) {}

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override { return {}; }
    void write(const Vec3& /*force_newton*/) noexcept override {}

private:
    DeviceSpec spec_;
};

class ReplaySession final : public WindowSession {
public:
    // Loads the scene and begins to play. Throws LoadError where the recording is not whole, or
    // not one of a window.
    ReplaySession(const std::filesystem::path& folder, const SceneDescription& scene,
                  const ViewSettings& view, const StageFunction& on_stage = {});
    ~ReplaySession() override;

    // Views, pause, single steps (a period each), ReplayOrder, and Reset, which goes back to the
    // beginning. Nothing else: what happens is what was recorded.
    void send(const Command& command) override;
    bool read_frame(LiveFrame& frame) override;
    World copy_world() override;
    bool pop_ticks(std::span<ServoTick> ticks) noexcept override;
    void change_device(Device& device, HandOrders* orders, std::size_t slot) override;
    void begin_recording(const std::filesystem::path& folder, bool overwrites,
                         const std::optional<TrajectorySettings>& trajectory) override;

private:
    void run();
    void take_commands();
    void apply(const Command& command);
    void go_to(double at_s);
    void begin_anew();
    void play(std::size_t ticks);
    void post_frame();
    std::string describe_verdict() const;
    std::size_t first_recorded() const;

    const std::filesystem::path folder_;
    const SceneDescription scene_;
    const Journal journal_;

    static constexpr std::size_t ring_size = 8192;
    using Ticks = Ring<ServoTick, ring_size>;
    const std::unique_ptr<Ticks> ticks_ = std::make_unique<Ticks>();
    Mailbox<LiveFrame> frames_;
    std::atomic<bool> frame_wanted_{true}, stopping_{false};
    std::mutex mutex_;  // of the commands
    std::condition_variable has_command_;
    std::vector<Command> commands_;
    std::mutex world_mutex_;  // of the player

    // The thread's own.
    std::optional<JournalPlayer> player_;
    std::optional<TraceCheck> check_;
    std::optional<LiveFrameBuilder> frame_builder_;
    ViewSettings view_;
    std::string problem_;         // why nothing is played any more
    double speed_ = 1, due_ = 0;  // ticks that are due, with their fraction
    bool is_paused_ = false;
    std::optional<std::size_t> target_;  // a tick to be reached as fast as can be

    std::thread thread_;
};

}  // namespace palpa
