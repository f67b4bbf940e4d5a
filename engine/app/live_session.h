// Runs a scene in real time: a thread with the 1 kHz servos of all hands, a thread with the
// simulation at its declared period, a thread that writes the journal, and the interface for the
// window's thread.
#pragma once
#include "app/live_clock.h"
#include "core/ring.h"
#include "core/stage.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "render/frame_scene.h"
#include "scene/description.h"
#include "session/commands.h"
#include "session/frame_server.h"
#include "session/journal_queue.h"
#include "session/live_simulation.h"
#include "session/servo_bank.h"
#include "session/session_recorder.h"
#include "simulation/atom_directory.h"
#include "view/atom_colours.h"
#include "view/build_frame.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
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

// State of a hand for the window.
struct LiveHand {
    AtomRange held;                        // atoms in hand, as for picking; none: the hand is empty
    Vec3 grabbed_angstrom = Vec3::Zero();  // position of the reference atom in hand, world frame
    std::string held_address;              // address for edits; empty: nothing is held
    ContactModel contact;
};

// All that the window shows, consistent for one moment between two steps.
struct LiveFrame {
    FrameScene picture;  // the window sets its camera
    std::vector<LiveHand> hands;
    std::shared_ptr<const AtomDirectory> atoms;  // names of picked atoms
    std::vector<glm::vec3> places;               // positions of all atoms, Å, drawn or not
    AtomRange framed;                            // atoms that the first view frames; none: all
    std::vector<ViewLabel> labels;               // labels in the picture
    std::vector<LegendEntry> legend;             // colour legend
    Readout readout;                             // readings; the contact is that of the first hand
    // Edits by the person that were not undone.
    std::shared_ptr<const std::vector<EditDescription>> edits{};
};

// The devices must outlive the session; only its servo thread may use them meanwhile.
class LiveSession {
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
    ~LiveSession();

    void send(const Command& command);

    // Replaces the device of a hand. The new one takes hold of the molecule where it is: no force
    // at first, then quiet cycles and a ramp. Waits for the running step; afterwards the previous
    // device belongs to the caller again. Throws LoadError and changes nothing if the new device
    // must not be run with the present period.
    void change_device(Device& device, HandOrders* orders, std::size_t slot = 0);

    // Sets the target of a live hand, m.
    void move_hand(const Vec3& target_m, std::size_t slot = 0);

    // Reads the newest frame and requests the next one. False if there is none since the last call.
    bool read_frame(LiveFrame& frame);

    // A copy of the world between two steps; waits for the running step.
    World copy_world();

    // Takes out the servo ticks in order, for all hands by slot. Ticks are lost if nobody takes
    // them out.
    bool pop_ticks(std::span<ServoTick> ticks) noexcept;
    bool pop_tick(ServoTick& tick) noexcept;  // ticks of the first hand
    std::size_t hands() const noexcept { return devices_.size(); }

    ServoHealth servo_health() const noexcept;

    // The server's notes since the last call.
    std::vector<std::string> take_server_notes();

    // Starts recording into the folder; the journal begins at the start of the session. Throws
    // LoadError as Recording does, if a recording is running already, and if a trajectory is
    // played, which a journal does not contain.
    void begin_recording(const std::filesystem::path& folder, bool overwrites = false,
                         const std::optional<TrajectorySettings>& trajectory = {});
    // Throws LoadError if not everything could be written.
    void end_recording();
    // Seconds recorded so far; empty if nothing is being recorded.
    std::optional<double> recorded_s();
    // Notes on the recording for the user since the last call, one sentence each.
    std::vector<std::string> take_recording_notes();

private:
    class Line;

    void start_servo();
    void stop_servo();
    void run_servo();
    void run_simulation();
    void run_recorder();
    void play(const LiveEvent& event);
    void obey(const Command& command);
    void make(const EditDescription& edit);
    void adopt_edit();
    void serve_clients(bool is_before_step);
    void change_device(const DeviceEvent& change, const LiveDevice& device);
    void post_frame_if_wanted();
    void record_what_happened();

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
    std::optional<World> copied_world_;
    bool world_wanted_ = false;
    std::condition_variable world_copied_;
    const bool plays_;  // whether it plays a trajectory
    std::atomic<bool> stopping_{false}, servo_stopping_{false}, recorder_stopping_{false};

    // Used by the simulation's thread only.
    ViewSettings view_;
    FrameBuilder builder_;
    std::vector<HandPose> poses_;
    std::shared_ptr<const AtomDirectory> atoms_;
    std::shared_ptr<const std::vector<EditDescription>> edits_ =
        std::make_shared<std::vector<EditDescription>>();
    std::uint64_t edition_ = 0;
    bool step_once_ = false;
    LiveClock::Moment settled_{};  // after a reset: time until the hand rests
    AtomRange framed_;
    std::future<void> building_;  // preparation of a long edit
    std::deque<EditDescription> waiting_edits_;

    std::mutex recorder_mutex_;
    SessionRecorder recorder_;
    std::string recording_problem_;  // since the last call of end_recording()

    std::thread simulation_thread_, servo_thread_, recorder_thread_;
};

}  // namespace palpa
