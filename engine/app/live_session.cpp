#include "app/live_session.h"

#include "core/load_error.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/step.h"
#include "view/first_view.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace palpa {
namespace {

using Duration = std::chrono::steady_clock::duration;

constexpr std::chrono::microseconds servo_tick{1'000'000 / static_cast<int>(servo_rate_hz)};

// How long after a reset the hand comes to rest before it has hold of the molecule again.
constexpr std::chrono::milliseconds settle_time{400};

int ticks_of(double period_ms) {
    return static_cast<int>(std::lround(period_ms * 1e-3 * servo_rate_hz));
}

// Above all ordinary threads, where the system lets us.
bool ask_for_real_time() noexcept {
    sched_param parameters{};
    parameters.sched_priority = 50;
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

// So that no tick waits for a page.
bool ask_for_locked_memory() noexcept {
    return mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
}

Duration period_of(const Simulation& simulation) {
    return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(simulation.period_s));
}

// While nothing moves, the hand feels nothing and has no hold.
TouchModel without_force(TouchModel touch) noexcept {
    touch.force_newton.setZero();
    touch.is_still = true;
    return touch;
}

// Where forces must be exact, real time is what limits the work for it, unless the scene does.
SceneDescription limited_by_period(SceneDescription scene) {
    constexpr double share = 0.8;
    if (scene.coupling.feel_within_pN && !scene.statics.budget_us)
        scene.statics.budget_us = share * 1e3 * scene.period_ms;
    return scene;
}

}  // namespace

LiveSession::LiveSession(const SceneDescription& scene, const ViewSettings& view, Device& device,
                         HandOrders* orders, LiveClock* clock)
    : clock_(clock ? *clock : machine_clock_),
      scene_(scene),
      device_(&device),
      orders_(orders),
      state_{load_simulation(limited_by_period(scene)), view, {}, {}, false, {}, {}},
      framed_(framed_atoms(scene.view, state_.simulation)) {
    check_period(device.spec(), scene.period_ms * 1e-3);
    order_.granted_ticks = ticks_of(scene.period_ms);
    exchange_.touch.post(state_.simulation.touch);
    start_servo(state_);
    simulation_thread_ = std::thread([this] { run_simulation(state_); });
}

LiveSession::~LiveSession() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    has_command_.notify_one();
    stop_servo();
    simulation_thread_.join();
}

void LiveSession::send(const Command& command) {
    if (const auto* const pause = std::get_if<Pause>(&command)) {
        order_.frozen = pause->paused;
    } else if (std::holds_alternative<StepOnce>(command)) {
        order_.frozen = true;
        ++order_.grants;
    } else if (std::holds_alternative<Reset>(command)) {
        ++order_.restarts;
    } else if (const auto* const settings = std::get_if<LiveSettings>(&command)) {
        if (bears_period(device_->spec(), settings->period_ms * 1e-3))
            order_.granted_ticks = ticks_of(settings->period_ms);
    }
    if (orders_) orders_->post(order_);
    {
        const std::lock_guard lock(mutex_);
        commands_.push_back(command);
    }
    has_command_.notify_one();
}

void LiveSession::change_device(Device& device, HandOrders* orders) {
    check_period(device.spec(), order_.granted_ticks / servo_rate_hz);
    order_.target_m.setZero();
    if (orders) orders->post(order_);
    std::unique_lock lock(mutex_);
    device_change_ = {&device, orders};
    has_command_.notify_one();
    device_changed_.wait(lock, [&] { return !device_change_; });
}

void LiveSession::move_hand(const Vec3& target_m) {
    order_.target_m = target_m;
    if (orders_) orders_->post(order_);
}

bool LiveSession::read_frame(LiveFrame& frame) {
    const bool is_new = frames_.read(frame);
    frame_wanted_ = true;
    return is_new;
}

ServoHealth LiveSession::servo_health() const noexcept { return {overruns_, real_time_, locked_}; }

void LiveSession::start_servo(const State& state) {
    ServoOrder order = build_order(state);
    order.restarts = restarts_;
    servo_thread_ = std::thread([this, order] { run_servo(order); });
}

// The force fades first.
void LiveSession::stop_servo() {
    servo_stopping_ = true;
    servo_thread_.join();
    servo_stopping_ = false;
    device_->write(Vec3::Zero());
}

void LiveSession::run_servo(ServoOrder order) {
    real_time_ = &clock_ == &machine_clock_ && ask_for_real_time();
    locked_ = ask_for_locked_memory();
    ServoState& state = servo_state_;
    ServoTick last;
    const LiveClock::Moment start = clock_.now();
    LiveClock::Moment next = start;
    // The force fades before the last tick.
    constexpr int last_ticks = 12;
    for (int ending = 0; ending < last_ticks; ending += order.settings.is_ending ? 1 : 0) {
        const std::uint32_t restarts = order.restarts;
        if (servo_orders_.read(order) && order.restarts != restarts) release(state.safety);
        order.settings.is_ending = servo_stopping_;
        const DeviceReading reading = device_->read();
        // An emulated device lives on the servo's ticks, however late they come, and can stand
        // still.
        const std::chrono::duration<double> real_s = clock_.now() - start;
        const bool stands_still =
            order.is_paused && !servo_stopping_ && reading.time_s == last.reading.time_s;
        if (!stands_still) {
            last = step_servo(order.settings, state, exchange_, reading,
                              orders_ ? reading.time_s : real_s.count());
            ticks_.push(last);
        }
        device_->show(last.touch);
        device_->write(last.sent_newton);
        next += servo_tick;
        const LiveClock::Moment now = clock_.now();
        if (now - next > servo_tick) {
            overruns_ += static_cast<std::uint64_t>((now - next) / servo_tick);
            next = now;
        }
        clock_.wait_for_tick(next);
    }
}

// The same order as in lockstep: where a period begins, the last step's answer is published, and
// the next step starts from the hand's pose at that moment. Commands are obeyed at once, between
// steps.
void LiveSession::run_simulation(State& state) {
    LiveClock::Moment next = clock_.now();
    while (!stopping_) {
        const bool settles = clock_.now() < state.settled;
        if (!settles && (!state.readout.paused || state.step_once)) {
            step(state);
        } else if (settles || !orders_) {  // a paused emulated handle stands still by itself
            hold(state);
        }
        next += period_of(state.simulation);
        const LiveClock::Moment now = clock_.now();
        if (now > next) next = now;  // late: the clock goes on from here
        post_frame_if_wanted(state);
        for (bool waited = false; !waited && !stopping_;) {
            std::vector<Command> commands;
            {
                std::unique_lock lock(mutex_);
                waited = !clock_.wait_for_period(next, lock, has_command_, [&] {
                    return stopping_ || !commands_.empty() || device_change_;
                });
                commands.swap(commands_);
                if (device_change_) {  // who asked for it waits
                    change_device(state, *device_change_);
                    device_change_.reset();
                    device_changed_.notify_one();
                }
            }
            for (const Command& command : commands) obey(state, command);
            if (!commands.empty()) post_frame_if_wanted(state);
        }
    }
}

// Whatever the hand does meanwhile moves nothing, and it feels nothing.
void LiveSession::hold(State& state) {
    exchange_.hand.read(state.hand);
    take_hold(state.simulation, state.hand);
    exchange_.touch.post(state.felt = without_force(state.simulation.touch.model));
}

void LiveSession::step(State& state) {
    state.step_once = false;
    exchange_.touch.post(state.simulation.touch);
    state.felt = state.simulation.touch.model;
    exchange_.hand.read(state.hand);
    const LiveClock::Moment begin = clock_.now();
    (void)step_simulation(state.simulation, state.hand, state.felt);
    state.readout.step_ms = std::chrono::duration<double, std::milli>(clock_.now() - begin).count();
    ++state.readout.steps;
}

void LiveSession::obey(State& state, const Command& command) {
    if (const auto* const settings = std::get_if<LiveSettings>(&command)) {
        state.readout.problem.clear();
        if (can_build_laws(settings->coupling)) {
            scene_.coupling = settings->coupling;
        } else {
            state.readout.problem =
                "eq. 2 of these numbers cannot have these slopes: the law from before stays";
        }
        try {
            check_period(device_->spec(), settings->period_ms * 1e-3);
            scene_.period_ms = settings->period_ms;
        } catch (const LoadError& error) {
            state.readout.problem = error.what();
        }
        set_coupling(scene_.coupling, state.simulation);
        state.simulation.period_s = scene_.period_ms * 1e-3;
        order_servo(state);
    } else if (const auto* const view = std::get_if<ViewSettings>(&command)) {
        state.view = *view;
    } else if (const auto* const pause = std::get_if<Pause>(&command)) {
        if (!orders_) hold(state);  // not what was travelled since the last look
        state.readout.paused = pause->paused;
        order_servo(state);
    } else if (std::holds_alternative<StepOnce>(command)) {
        state.readout.paused = state.step_once = true;
        order_servo(state);
    } else if (const auto* const anew = std::get_if<Reset>(&command)) {
        if (anew->start_angstrom) scene_.hand.start_angstrom = anew->start_angstrom;
        reset(state);
    }
}

void LiveSession::reset(State& state) {
    try {
        state.simulation = load_simulation(limited_by_period(scene_));
    } catch (const LoadError& error) {  // the files changed meanwhile: what runs, runs on
        state.readout.problem = error.what();
        return;
    }
    state.readout.problem.clear();
    take_hold_anew(state);
    order_servo(state);
}

void LiveSession::change_device(State& state, const DeviceChange& change) {
    stop_servo();
    device_ = change.device;
    orders_ = change.orders;
    // What the molecule was given of the handle's travel and work stays its own.
    ServoState fresh;
    fresh.travel_m = servo_state_.travel_m;
    fresh.turn = servo_state_.turn;
    fresh.hand_energy_J = servo_state_.hand_energy_J;
    servo_state_ = fresh;
    take_hold_anew(state);
    start_servo(state);
    order_servo(state);  // or it would take one that was meant for the device before
}

// Once the hand rests; until then it moves nothing.
void LiveSession::take_hold_anew(State& state) {
    state.settled = clock_.now() + settle_time;
    ++restarts_;
    state.simulation.touch.model.start = restarts_;
    hold(state);
}

// A hand takes hold quietly; laws that are exchanged glide.
LiveSession::ServoOrder LiveSession::build_order(const State& state) {
    ServoOrder order{build_servo_settings(scene_, state.simulation, device_->spec())};
    order.is_paused = orders_ && state.readout.paused;
    SafetySettings& safety = order.settings.safety;
    safety.starts_engaged = false;
    limit_to(device_->spec(), safety);
    if (order.settings.guarded) order.settings.guarded->revision = revision_++;
    return order;
}

void LiveSession::order_servo(const State& state) {
    ServoOrder order = build_order(state);
    order.restarts = restarts_;
    servo_orders_.post(order);
}

void LiveSession::post_frame_if_wanted(const State& state) {
    if (!frame_wanted_.exchange(false)) return;
    const auto grabbed =
        static_cast<std::uint32_t>(grabbed_points(state.simulation).positions.size());
    LiveFrame frame{{}, grabbed, grabbed_place(state.simulation), framed_, {}, state.readout};
    frame.picture =
        build_frame(state.simulation, state.simulation.touch.model, state.view, &frame.labels);
    frame.readout.touch = state.simulation.touch.model;
    if (const auto& flexible = state.simulation.flexible; flexible && flexible->adaptive) {
        if (const auto& exactness = flexible->adaptive->exactness) {
            frame.readout.error_pN = exactness->error();
            frame.readout.effort = exactness->effort();
        }
    }
    frames_.post(frame);
}

}  // namespace palpa
