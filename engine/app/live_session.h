// A scene that runs in real time: the servo at 1 kHz and the simulation at its declared period,
// each on a thread of its own, and what a third one, with the window, may ask of them and see of
// them.
#pragma once
#include "app/live_clock.h"
#include "core/mailbox.h"
#include "core/ring.h"
#include "haptics/device.h"
#include "haptics/exchange.h"
#include "haptics/hand.h"
#include "haptics/servo.h"
#include "render/frame_scene.h"
#include "scene/description.h"
#include "session/commands.h"
#include "simulation/simulation.h"
#include "view/build_frame.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace palpa {

// What the window shows, all of one moment between two steps.
struct LiveFrame {
    FrameScene picture;                    // its camera is the window's business
    std::uint32_t grabbed_atoms = 0;       // what is picked below this is in hand
    Vec3 grabbed_angstrom = Vec3::Zero();  // the reference atom in hand, in the world
    AtomRange framed;                      // what the first view frames; none: everything
    std::vector<ViewLabel> labels;         // of the picture
    Readout readout;
};

// The device must outlive the session, and belongs to its servo thread meanwhile.
class LiveSession {
public:
    // Loads the scene and starts both threads. `orders`: of an emulated device's hand; null where
    // the device cannot stand still. `clock`: null is the machine's. Throws LoadError, and where
    // the device must not be run with the scene's period (check_period).
    LiveSession(const SceneDescription& scene, const ViewSettings& view, Device& device,
                HandOrders* orders, LiveClock* clock = nullptr);
    LiveSession(const LiveSession&) = delete;
    LiveSession& operator=(const LiveSession&) = delete;
    ~LiveSession();

    void send(const Command& command);

    // Puts another device in the hand's place, which takes hold of the molecule where it is: no
    // force, then quiet cycles and ramp. Waits for the step that is under way; the device before is
    // the caller's again. Throws LoadError, and changes nothing, where the other one must not be
    // run with the present period.
    void change_device(Device& device, HandOrders* orders);

    // Where a live hand wants the handle, m.
    void move_hand(const Vec3& target_m);

    // The newest frame; asks for the next one. False if none came since the last call.
    bool read_frame(LiveFrame& frame);

    // Every servo tick in its order, as long as somebody takes them out.
    bool pop_tick(ServoTick& tick) noexcept { return ticks_.pop(tick); }

    ServoHealth servo_health() const noexcept;

private:
    // What only the simulation's thread touches.
    struct State {
        Simulation simulation;
        ViewSettings view;
        HandPose hand;
        TouchModel felt;  // by the hand now; the last step's answer is the simulation's
        bool step_once = false;
        LiveClock::Moment settled{};  // after a reset, until the hand rests
        Readout readout;
    };

    // What the servo is told.
    struct ServoOrder {
        ServoSettings settings;
        std::uint32_t restarts = 0;  // another number ends a latched stop
        bool is_paused = false;      // on a device that stands still
    };

    struct DeviceChange {
        Device* device;
        HandOrders* orders;
    };

    void start_servo(const State& state);
    void stop_servo();
    void run_servo(ServoOrder order);
    void run_simulation(State& state);
    void step(State& state);
    void hold(State& state);
    void obey(State& state, const Command& command);
    void reset(State& state);
    void change_device(State& state, const DeviceChange& change);
    void take_hold_anew(State& state);
    ServoOrder build_order(const State& state);
    void order_servo(const State& state);
    void post_frame_if_wanted(const State& state);

    static constexpr std::size_t ring_size = 8192;  // 8 s of ticks

    LiveClock machine_clock_;
    LiveClock& clock_;
    SceneDescription scene_;
    Device* device_;
    HandOrders* orders_;
    HandOrder order_;  // as posted last
    Exchange exchange_;
    Mailbox<ServoOrder> servo_orders_;
    std::uint32_t restarts_ = 0, revision_ = 0;
    Mailbox<LiveFrame> frames_;
    Ring<ServoTick, ring_size> ticks_;
    std::atomic<bool> frame_wanted_{true};
    std::atomic<std::uint64_t> overruns_{0};
    std::atomic<bool> real_time_{false}, locked_{false};

    std::mutex mutex_;  // of the commands
    std::condition_variable has_command_;
    std::vector<Command> commands_;
    std::optional<DeviceChange> device_change_;  // until it is done
    std::condition_variable device_changed_;
    std::atomic<bool> stopping_{false}, servo_stopping_{false};

    State state_;
    AtomRange framed_;
    ServoState servo_state_;  // the servo's, while it runs
    std::thread simulation_thread_, servo_thread_;
};

}  // namespace palpa
