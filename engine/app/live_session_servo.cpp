// The servos' thread of a live session.
#include "app/live_session.h"
#include "platform/thread.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <span>
#include <thread>

namespace palpa {
namespace {

constexpr std::chrono::microseconds servo_tick{1'000'000 / static_cast<int>(servo_rate_hz)};

}  // namespace

void LiveSession::start_servo() {
    servo_thread_ = std::thread([this] { run_servo(); });
}

// The force fades first.
void LiveSession::stop_servo() {
    servo_stopping_ = true;
    servo_thread_.join();
    servo_stopping_ = false;
    for (const LiveDevice& device : devices_) device.device->write(Vec3::Zero());
}

void LiveSession::run_servo() {
    real_time_ = &clock_ == &machine_clock_ && ask_for_real_time();
    locked_ = ask_for_locked_memory();
    const std::size_t count = devices_.size();
    // An emulated device lives on the servo's ticks, however late they come, and can stand still.
    const bool is_emulated =
        std::ranges::all_of(devices_, [](const LiveDevice& d) { return d.orders != nullptr; });
    std::array<DeviceReading, most_hands> readings;
    std::array<double, most_hands> stamps{};
    std::array<LiveTick, most_hands> last{};
    std::array<ServoTick, most_hands> ticks{};
    const LiveClock::Moment start = clock_.now();
    LiveClock::Moment next = start;
    // The force fades before the last tick.
    constexpr int last_ticks = 12;
    for (int ending = 0; ending < last_ticks;) {
        servos_.take_orders();
        const bool is_ending = servo_stopping_;
        ending += is_ending ? 1 : 0;
        bool stands_still = servos_.is_paused() && !is_ending;
        for (std::size_t slot = 0; slot < count; ++slot) {
            readings[slot] = devices_[slot].device->read();
            stands_still = stands_still && readings[slot].time_s == stamps[slot];
            stamps[slot] = readings[slot].time_s;
        }
        const std::chrono::duration<double> real_s = clock_.now() - start;
        if (!stands_still) {
            servos_.tick(std::span(readings).first(count),
                         is_emulated ? readings[0].time_s : real_s.count(), is_ending);
            std::ranges::copy(servos_.ticks(), last.begin());
            std::ranges::transform(servos_.ticks(), ticks.begin(), &LiveTick::tick);
            ticks_->push(std::span<const ServoTick>(ticks).first(count));
            journal_queue_.push(servos_.ticks());
        }
        for (std::size_t slot = 0; slot < count; ++slot) {
            devices_[slot].device->show(last[slot].tick.contact, last[slot].tick.waiting_m);
            devices_[slot].device->write(last[slot].tick.sent_newton);
        }
        next += servo_tick;
        const LiveClock::Moment now = clock_.now();
        if (now - next > servo_tick) {
            overruns_ += static_cast<std::uint64_t>((now - next) / servo_tick);
            next = now;
        }
        clock_.wait_for_tick(next);
    }
}

}  // namespace palpa
