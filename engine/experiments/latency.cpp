#include "experiments/latency.h"

#include "haptics/exchange.h"
#include "haptics/safety.h"
#include "haptics/servo.h"
#include "platform/thread.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace palpa {
namespace {

constexpr double newton_per_model_newton = 1e9;
constexpr int ticks_per_model = 10;  // or it would be stale

}  // namespace

AnsweringServo::AnsweringServo(Device& device) : device_(device), thread_([this] { run(); }) {}

AnsweringServo::~AnsweringServo() { (void)stop(); }

std::vector<double> AnsweringServo::stop() {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
    return std::move(ticks_us_);
}

void AnsweringServo::run() {
    ServoSettings settings;
    settings.force_law = ConstantForceLaw{newton_per_model_newton};
    settings.safety.is_full = true;
    limit_to(device_.spec(), settings.safety);
    ServoState state;
    Exchange exchange;
    LocalContactModel contact;
    bool was_pressed = false;
    const Clock::time_point start = Clock::now();
    Clock::time_point next = start;
    for (int tick = 0; !is_over_; ++tick) {
        const Clock::time_point begin = Clock::now();
        const DeviceReading reading = device_.read();
        const bool is_pressed_now = is_pressed(reading.buttons, Button::Clutch);
        const bool is_news = is_pressed_now != was_pressed;
        was_pressed = is_pressed_now;
        contact.model.force_newton = Vec3(0, newton(is_pressed_now) / newton_per_model_newton, 0);
        if (is_news || tick % ticks_per_model == 0) exchange.contact.post(contact);
        const ServoTick done = step_servo(settings, state, exchange, reading,
                                          std::chrono::duration<double>(begin - start).count());
        device_.write(done.sent_newton);
        const Clock::time_point end = Clock::now();
        if (is_news) {
            answered_ = end;
            ++answers_;
        }
        ticks_us_.push_back(std::chrono::duration<double, std::micro>(end - begin).count());
        next = std::max(next + std::chrono::milliseconds(1), end);
        sleep_exactly_until(next);
    }
}

WakeUps measure_wake_ups(int ticks, bool asks_for_real_time) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds tick{1};
    WakeUps found;
    found.late_us.reserve(static_cast<std::size_t>(ticks));
    // On a thread that ends, and its priority with it.
    std::thread servo([&] {
        if (asks_for_real_time) {
            found.is_real_time = ask_for_real_time();
            found.is_locked = ask_for_locked_memory();
        }
        Clock::time_point next = Clock::now() + tick;
        while (found.late_us.size() + found.missed < static_cast<std::size_t>(ticks)) {
            wait_awake_until(next);
            const Clock::time_point now = Clock::now();
            found.late_us.push_back(std::chrono::duration<double, std::micro>(now - next).count());
            next += tick;
            if (now - next > tick) {  // as a session's servo does it
                found.missed += static_cast<std::uint64_t>((now - next) / tick);
                next = now;
            }
        }
    });
    servo.join();
    return found;
}

std::vector<LatencyBin> bin_latencies(const std::vector<double>& late_us) {
    std::vector<LatencyBin> bins{{1, 0}};
    for (const double late : late_us) {
        std::size_t at = 0;
        for (double below = 1; late >= below; below *= 2) ++at;
        while (bins.size() <= at) bins.push_back({2 * bins.back().below_us, 0});
        ++bins[at].ticks;
    }
    return bins;
}

}  // namespace palpa
