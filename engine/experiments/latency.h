// How long it takes from what a device says to what it plays, and how late a servo wakes.
#pragma once
#include "haptics/device.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

namespace palpa {

// A servo at 1 kHz on a thread of its own, without real-time priority, and a molecule that answers
// within the tick: 1 N, and 1.4 N while the device's clutch is pressed. The whole safety chain is
// in between; a simulation is not.
class AnsweringServo {
public:
    using Clock = std::chrono::steady_clock;

    // The servo uses the device until it is destroyed.
    explicit AnsweringServo(Device& device);
    AnsweringServo(const AnsweringServo&) = delete;
    AnsweringServo& operator=(const AnsweringServo&) = delete;
    ~AnsweringServo();

    static double newton(bool is_pressed) noexcept { return is_pressed ? 1.4 : 1.0; }

    // Number of changes of the force, and time of the last write.
    int answers() const noexcept { return answers_; }
    Clock::time_point answered() const noexcept { return answered_; }

    // For every tick: time from before the reading to after the force, µs. Ends the servo.
    std::vector<double> stop();

private:
    void run();

    Device& device_;
    std::atomic<bool> is_over_{false};
    std::atomic<int> answers_{0};
    std::atomic<Clock::time_point> answered_{};
    std::vector<double> ticks_us_;
    std::thread thread_;
};

// How late ticks begin on a thread that waits for them as a live session's servo does.
struct WakeUps {
    bool is_real_time = false, is_locked = false;  // as the system granted
    std::vector<double> late_us;                   // of each tick
    std::uint64_t missed = 0;                      // ticks that were skipped meanwhile, beside
};

// A tick a millisecond, for that many with those missed; with ordinary priority, or what a session
// asks for.
WakeUps measure_wake_ups(int ticks, bool asks_for_real_time);

// A histogram: bins that double in width, the first below 1 us, and how many ticks each has.
struct LatencyBin {
    double below_us = 0;
    std::uint64_t ticks = 0;
};
std::vector<LatencyBin> bin_latencies(const std::vector<double>& late_us);

}  // namespace palpa
