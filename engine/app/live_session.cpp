#include "app/live_session.h"

#include "core/files.h"
#include "core/load_error.h"
#include "session/run_headless.h"
#include "simulation/resources.h"

#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpa {
namespace {

using Duration = std::chrono::steady_clock::duration;

// How long after a reset the hand comes to rest before it has hold of the molecule again.
constexpr std::chrono::milliseconds settle_time{400};

int ticks_of(double period_ms) {
    return static_cast<int>(std::lround(period_ms * 1e-3 * servo_rate_hz));
}

Duration period_of(const World& world) {
    return std::chrono::duration_cast<Duration>(
        std::chrono::duration<double>(world.resource<Clock>().period_s));
}

HandDevice describe(const LiveDevice& device) {
    return {device.device->spec(), device.orders != nullptr};
}

std::vector<HandDevice> describe(std::span<const LiveDevice> devices) {
    std::vector<HandDevice> described;
    for (const LiveDevice& device : devices) described.push_back(describe(device));
    return described;
}

// Of what the event is about to read.
std::vector<std::optional<std::string>> read_files(const LiveEvent& event) {
    const auto* const command = std::get_if<CommandEvent>(&event);
    const auto* const edit = command ? std::get_if<EditDescription>(&command->command) : nullptr;
    if (!edit) return {};
    std::vector<std::optional<std::string>> contents;
    EditAction action = edit->action;
    for (const std::filesystem::path* const file : list_files(action)) {
        try {
            contents.emplace_back(read_text_file(*file));
        } catch (const LoadError&) {  // the edit will say so
            contents.emplace_back();
        }
    }
    return contents;
}

}  // namespace

// To the servos' mailboxes.
class LiveSession::Line final : public ServoLine {
public:
    explicit Line(ServoBank& servos) : servos_(servos) {}

    void post(std::size_t slot, const LocalContactModel& contact, std::uint64_t number) override {
        Mailbox<LocalContactModel>& mailbox = servos_.exchange(slot).contact;
        LocalContactModel& draft = mailbox.draft();
        draft = contact;
        draft.model.number = number;
        mailbox.send();
        posted_[slot].contact = number;
    }
    void post(std::size_t slot, const ServoOrder& order) override {
        servos_.orders(slot).post(order);
        posted_[slot].order = order.number;
    }

    const AllPostNumbers& posted() const noexcept { return posted_; }

private:
    ServoBank& servos_;
    AllPostNumbers posted_{};
};

LiveSession::LiveSession(const SceneDescription& scene, const ViewSettings& view,
                         std::span<const LiveDevice> devices, LiveClock* clock, FrameServer* server,
                         const std::optional<PlaybackChoice>& playback,
                         const StageFunction& on_stage)
    : clock_(clock ? *clock : machine_clock_),
      devices_(devices.begin(), devices.end()),
      orders_(devices.size()),
      servos_(devices.size()),
      line_(std::make_unique<Line>(servos_)),
      simulation_(scene, describe(devices), *line_, playback, on_stage),
      server_(server),
      ticks_(std::make_unique<Ticks>()),
      journal_queue_(devices.size(), line_->posted()),
      plays_(playback.has_value()),
      frame_builder_(scene, simulation_, view),
      poses_(devices.size()),
      recorder_(scene, simulation_.devices()) {
    for (HandOrder& order : orders_) order.granted_ticks = ticks_of(scene.period_ms);
    start_servo();
    simulation_thread_ = std::thread([this] { run_simulation(); });
    recorder_thread_ = std::thread([this] { run_recorder(); });
}

LiveSession::LiveSession(const SceneDescription& scene, const ViewSettings& view, Device& device,
                         HandOrders* orders, LiveClock* clock)
    : LiveSession(scene, view, std::array{LiveDevice{&device, orders}}, clock) {}

LiveSession::~LiveSession() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    has_command_.notify_one();
    stop_servo();
    simulation_thread_.join();
    recorder_stopping_ = true;
    recorder_thread_.join();
}

void LiveSession::send(const Command& command) {
    for (std::size_t slot = 0; slot < devices_.size(); ++slot) {
        HandOrder& order = orders_[slot];
        if (const auto* const pause = std::get_if<Pause>(&command)) {
            order.frozen = pause->paused;
        } else if (std::holds_alternative<StepOnce>(command)) {
            order.frozen = true;
            ++order.grants;
        } else if (std::holds_alternative<Reset>(command)) {
            ++order.restarts;
        } else if (const auto* const settings = std::get_if<LiveSettings>(&command)) {
            if (supports_period(devices_[slot].device->spec(), settings->period_ms * 1e-3))
                order.granted_ticks = ticks_of(settings->period_ms);
        }
        if (devices_[slot].orders) devices_[slot].orders->post(order);
    }
    {
        const std::lock_guard lock(mutex_);
        commands_.push_back(command);
    }
    has_command_.notify_one();
}

void LiveSession::change_device(Device& device, HandOrders* orders, std::size_t slot) {
    check_period(device.spec(), orders_[slot].granted_ticks / servo_rate_hz);
    orders_[slot].target_m.setZero();
    orders_[slot].is_clutched = false;
    if (orders) orders->post(orders_[slot]);
    const LiveDevice next{&device, orders};
    std::unique_lock lock(mutex_);
    device_change_ = {{slot, describe(next)}, next};
    has_command_.notify_one();
    device_changed_.wait(lock, [&] { return !device_change_; });
}

void LiveSession::move_hand(const Vec3& target_m, std::size_t slot, bool is_clutched) {
    orders_[slot].target_m = target_m;
    orders_[slot].is_clutched = is_clutched;
    if (devices_[slot].orders) devices_[slot].orders->post(orders_[slot]);
}

void LiveSession::ask(const std::function<void()>& question) {
    std::unique_lock lock(mutex_);
    question_ = &question;
    has_command_.notify_one();
    answered_.wait(lock, [&] { return !question_; });
}

World LiveSession::copy_world() {
    std::optional<World> world;
    ask([&] { world = simulation_.world().without_caches(); });
    return std::move(*world);
}

std::optional<UnbindingPath> LiveSession::find_unbinding() {
    std::optional<UnbindingPath> unbinding;
    ask([&] { unbinding = simulation_.unbinding(); });
    return unbinding;
}

bool LiveSession::read_frame(LiveFrame& frame) {
    const bool is_new = frames_.read(frame);
    frame_wanted_ = true;
    return is_new;
}

bool LiveSession::pop_ticks(std::span<ServoTick> ticks) noexcept {
    if (!ticks_->pop(ticks[0])) return false;
    // The servo pushes those of all hands or none.
    for (std::size_t slot = 1; slot < hands();) slot += ticks_->pop(ticks[slot]) ? 1 : 0;
    return true;
}

ServoHealth LiveSession::servo_health() const noexcept { return {overruns_, real_time_, locked_}; }

// ---- the simulation's thread -------------------------------------------------------------------

// The same order as in lockstep: where a period begins, the last step's answer is published, and
// the next step starts from the hands' poses at that moment. Commands are carried out at once,
// between steps.
void LiveSession::run_simulation() {
    LiveClock::Moment next = clock_.now();
    while (!stopping_) {
        adopt_edit();
        serve_clients(false);
        const bool settles = clock_.now() < settled_;
        const bool is_paused = simulation_.readout().paused;
        if (building_.valid()) {
            // Nothing moves until the edit is made; what lasts longer than servos go on with the
            // same contact model lets their forces fade.
        } else if (!settles && (!is_paused || step_once_)) {
            step_once_ = false;
            serve_clients(true);
            play(PublishEvent{});
            play(StepEvent{{}, simulation_.has_renewal()});
            simulation_.start_renewal();
        } else if (settles || !simulation_.all_stand_still()) {
            play(HoldEvent{});
        }
        next += period_of(simulation_.world());
        const LiveClock::Moment now = clock_.now();
        if (now > next) next = now;  // late: the clock goes on from here
        post_frame_if_wanted();
        for (bool waited = false; !waited && !stopping_;) {
            std::vector<Command> commands;
            {
                std::unique_lock lock(mutex_);
                waited = !clock_.wait_for_period(next, lock, has_command_, [&] {
                    return stopping_ || !commands_.empty() || device_change_ || question_;
                });
                commands.swap(commands_);
                if (device_change_) {  // who asked for it waits
                    change_device(device_change_->event, device_change_->device);
                    device_change_.reset();
                    device_changed_.notify_one();
                }
            }
            for (const Command& command : commands) apply(command);
            answer();
            if (!commands.empty()) post_frame_if_wanted();
        }
    }
}

// Answers a question once the commands that were sent before it are carried out.
void LiveSession::answer() {
    const std::lock_guard lock(mutex_);
    if (!question_ || !commands_.empty()) return;
    (*question_)();
    question_ = nullptr;
    answered_.notify_one();
}

void LiveSession::play(const LiveEvent& event) {
    PlayedEvent played{event, {}};
    for (std::size_t slot = 0; slot < devices_.size(); ++slot) {
        servos_.exchange(slot).hand.read(poses_[slot]);
        played.poses.push_back(poses_[slot].number);
    }
    played.files = read_files(event);
    simulation_.play(event, poses_);
    if (auto* const step = std::get_if<StepEvent>(&played.event)) {
        const World& world = simulation_.world();
        step->took_us = world.resource<StepReport>().took_us;
        trajectory_queue_.pass(world, world.resource<Clock>().period_s, simulation_.edition());
    }
    journal_queue_.push(std::move(played), line_->posted());
}

void LiveSession::apply(const Command& command) {
    if (const auto* const view = std::get_if<ViewSettings>(&command))
        return frame_builder_.show_as(*view);
    if (const auto* const order = std::get_if<PlaybackOrder>(&command))
        return simulation_.order(*order);
    if (const auto* const edit = std::get_if<EditDescription>(&command)) {
        if (!building_.valid()) return make(*edit);
        waiting_edits_.push_back(*edit);
        return;
    }
    step_once_ = step_once_ || std::holds_alternative<StepOnce>(command);
    if (std::holds_alternative<Reset>(command)) {
        if (building_.valid()) building_.get();  // of a world that goes
        waiting_edits_.clear();
        settled_ = clock_.now() + settle_time;
    }
    play(CommandEvent{command, clock_.now() < settled_});
}

void LiveSession::make(const EditDescription& edit) {
    const bool is_long = simulation_.takes_long(edit);
    play(CommandEvent{edit, clock_.now() < settled_, is_long});
    if (is_long) building_ = std::async(std::launch::async, [this] { simulation_.build_draft(); });
}

// Forces of clients are events of the session, so that a journal has them.
void LiveSession::serve_clients(bool is_before_step) {
    if (!server_) return;
    if (is_before_step) {
        server_->send(simulation_.world());
        return;
    }
    server_->poll(0);
    if (std::optional<ClientPull> pull = server_->take_pull())
        play(CommandEvent{std::move(*pull), clock_.now() < settled_});
    std::vector<std::string> notes = server_->take_notes();
    if (notes.empty()) return;
    const std::lock_guard lock(mutex_);
    constexpr std::size_t most_notes = 100;
    for (std::string& note : notes) server_notes_.push_back(std::move(note));
    if (server_notes_.size() > most_notes) {
        server_notes_.erase(server_notes_.begin(),
                            server_notes_.end() - static_cast<std::ptrdiff_t>(most_notes));
    }
}

std::vector<std::string> LiveSession::take_server_notes() {
    const std::lock_guard lock(mutex_);
    return std::exchange(server_notes_, {});
}

// As soon as it is built; then those that had to wait, up to the next that takes long.
void LiveSession::adopt_edit() {
    if (!building_.valid()) return;
    if (building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    building_.get();
    play(AdoptEvent{clock_.now() < settled_});
    while (!building_.valid() && !waiting_edits_.empty()) {
        make(waiting_edits_.front());
        waiting_edits_.pop_front();
    }
}

void LiveSession::change_device(const DeviceEvent& change, const LiveDevice& device) {
    stop_servo();
    devices_[change.slot] = device;
    servos_.begin_anew();
    settled_ = clock_.now() + settle_time;
    play(change);
    start_servo();
}

void LiveSession::post_frame_if_wanted() {
    if (frame_wanted_.exchange(false)) frames_.post(frame_builder_.build(simulation_));
}

}  // namespace palpa
