// Runs a scene in real time: a thread with the 1 kHz servos of all hands, a thread with the
// simulation at its declared period, a thread that writes the journal, and the interface for the
// window's thread.
#pragma once
#include "app/live_clock.h"
#include "app/live_frame.h"
#include "app/recording_meter.h"
#include "app/window_session.h"
#include "core/ring.h"
#include "core/stage.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "scene/description.h"
#include "session/commands.h"
#include "session/frame_server.h"
#include "session/journal_queue.h"
#include "session/live_simulation.h"
#include "session/pack_recording.h"
#include "session/servo_bank.h"
#include "session/session_recorder.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace palpa {

// The device of one hand. `orders`: of an emulated device's hand; null if it cannot be stopped.
struct LiveDevice {
    Device* device = nullptr;
    HandOrders* orders = nullptr;
};

// The devices must outlive the session, and belong to its servo thread meanwhile.
class LiveSession final : public WindowSession {
public:
    // Loads the scene and starts all threads. `devices`: in the order of the scene's hands; hands
    // without one stand still. `clock`: null for the machine's clock. `server`: serves the session
    // on the simulation's thread; may be null. `on_stage` receives the progress of loading. Throws
    // LoadError, also if a device must not be run with the scene's period (check_period).
    LiveSession(const SceneDescription& scene, const ViewSettings& view,
                std::span<const LiveDevice> devices, LiveClock* clock = nullptr,
                FrameServer* server = nullptr, const std::optional<PlaybackChoice>& playback = {},
                const StageFunction& on_stage = {});
    // With one device.
    LiveSession(const SceneDescription& scene, const ViewSettings& view, Device& device,
                HandOrders* orders, LiveClock* clock = nullptr);
    LiveSession(const LiveSession&) = delete;
    LiveSession& operator=(const LiveSession&) = delete;
    ~LiveSession() override;

    void send(const Command& command) override;

    // The new device takes hold of the molecule where it is: no force, then quiet cycles and ramp.
    // Waits for the step that is under way.
    void change_device(Device& device, HandOrders* orders, std::size_t slot = 0) override;
    void move_hand(const Vec3& target_m, std::size_t slot = 0, bool is_clutched = false) override;
    std::optional<UnbindingPath> find_unbinding() override;
    bool read_frame(LiveFrame& frame) override;
    World copy_world() override;
    bool pop_ticks(std::span<ServoTick> ticks) noexcept override;
    std::size_t hands() const noexcept { return devices_.size(); }

    ServoHealth servo_health() const noexcept override;

    std::vector<std::string> take_server_notes() override;

    // With the journal since the session began. Throws LoadError where a trajectory is played,
    // which no journal has.
    void begin_recording(const std::filesystem::path& folder, bool overwrites = false,
                         const std::optional<TrajectorySettings>& trajectory = {}) override;
    void end_recording() override;
    // A row a second into this file (session/statistics_file.h). Throws LoadError.
    void write_statistics(const std::filesystem::path& path, bool overwrites = false);
    std::optional<RecordingState> recording() override;
    std::optional<double> packed_share() override;
    std::vector<EndedRecording> take_ended() override;
    void stop_packing() override;
    std::vector<std::string> take_recording_notes() override;

private:
    class Line;

    void start_servo();
    void stop_servo();
    void run_servo();
    void run_simulation();
    void run_recorder();
    void play(const LiveEvent& event);
    void apply(const Command& command);
    void make(const EditDescription& edit);
    void adopt_edit();
    // Calls a function on the simulation's thread between two steps, and waits for it.
    void ask(const std::function<void()>& question);
    void answer();
    void serve_clients(bool is_before_step);
    void change_device(const DeviceEvent& change, const LiveDevice& device);
    void post_frame_if_wanted();
    void record_what_happened();
    void end_at_last();
    void measure_recording();
    bool pack_piece();

    static constexpr std::size_t ring_size = 8192;  // 4 s or more of ticks
    using Ticks = Ring<ServoTick, ring_size>;

    LiveClock machine_clock_;
    LiveClock& clock_;
    std::vector<LiveDevice> devices_;
    std::vector<HandOrder> orders_;  // orders posted last
    ServoBank servos_;
    std::unique_ptr<Line> line_;
    LiveSimulation simulation_;
    FrameServer* server_;
    std::unique_ptr<Ticks> ticks_;
    JournalQueue journal_queue_;
    TrajectoryQueue trajectory_queue_;
    Mailbox<LiveFrame> frames_;
    std::atomic<bool> frame_wanted_{true};
    std::atomic<std::uint64_t> overruns_{0};
    std::atomic<bool> real_time_{false}, locked_{false};

    std::mutex mutex_;  // guards the commands
    std::condition_variable has_command_;
    std::vector<Command> commands_;
    std::vector<std::string> server_notes_;
    struct DeviceChange {
        DeviceEvent event;
        LiveDevice device;
    };
    std::optional<DeviceChange> device_change_;  // pending change of a device
    std::condition_variable device_changed_;
    const std::function<void()>* question_ = nullptr;  // of a thread that waits for the answer
    std::condition_variable answered_;
    const bool plays_;  // whether it plays a trajectory
    std::atomic<bool> stopping_{false}, servo_stopping_{false}, recorder_stopping_{false};

    // The simulation's thread's own.
    LiveFrameBuilder frame_builder_;
    std::vector<HandPose> poses_;
    bool step_once_ = false;
    LiveClock::Moment settled_{};  // after a reset, until the hand rests
    std::future<void> building_;   // of a long edit
    std::deque<EditDescription> waiting_edits_;

    std::mutex recorder_mutex_;
    SessionRecorder recorder_;
    std::string recording_problem_;      // since the last call of end_recording()
    std::filesystem::path recorded_in_;  // the newest recording
    RecordingState recorded_;
    std::deque<std::filesystem::path> to_pack_;  // the first is under way
    double packed_share_ = 0;                    // of the first
    std::vector<EndedRecording> ended_;
    std::atomic<bool> packs_{true};

    // The recorder's thread's own.
    std::optional<RecordingPacker> packer_;
    RecordingMeter meter_;

    std::thread simulation_thread_, servo_thread_, recorder_thread_;
};

}  // namespace palpa
