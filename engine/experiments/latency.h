// Measures the latency from the report of a device to the force that it plays.
#pragma once
#include "haptics/device.h"

#include <atomic>
#include <chrono>
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

}  // namespace palpa
