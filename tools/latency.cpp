#include "tools/latency.h"

#include "devices/emulated_omni.h"
#include "haptics/exchange.h"
#include "haptics/safety.h"
#include "haptics/servo.h"
#include "tools/bench_row.h"

#include <fmt/format.h>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
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
    Touch touch;
    bool was_pressed = false;
    const Clock::time_point start = Clock::now();
    Clock::time_point next = start;
    for (int tick = 0; !is_over_; ++tick) {
        const Clock::time_point begin = Clock::now();
        const DeviceReading reading = device_.read();
        const bool is_pressed_now = is_pressed(reading.buttons, Button::Clutch);
        const bool is_news = is_pressed_now != was_pressed;
        was_pressed = is_pressed_now;
        touch.model.force_newton = Vec3(0, newton(is_pressed_now) / newton_per_model_newton, 0);
        if (is_news || tick % ticks_per_model == 0) exchange.touch.post(touch);
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
        std::this_thread::sleep_until(next);
    }
}

void print_latency_heading() {
    fmt::print("{:<24} {:>9} {:>9} {:>9}  {}\n", "device", "median us", "p99 us", "most us",
               "from, to");
}

void print_latency(const std::string& device, std::size_t asked,
                   const std::vector<double>& samples_us, const std::string& what) {
    if (samples_us.empty()) {
        fmt::print("{:<24} no answer came\n", device);
        return;
    }
    const std::size_t lost = asked - samples_us.size();
    fmt::print("{:<24} {:>9.0f} {:>9.0f} {:>9.0f}  {}{}\n", device, quantile(samples_us, 0.5),
               quantile(samples_us, 0.99), quantile(samples_us, 1), what,
               lost > 0 ? fmt::format("; {} of {} never came", lost, asked) : "");
}

int latency_command() {
    print_latency_heading();
    EmulatedOmni omni(EmulatedOmniSettings{});
    AnsweringServo servo(omni);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    const std::vector<double> ticks_us = servo.stop();
    print_latency("emulated Omni", ticks_us.size(), ticks_us,
                  "reading, to the force played: both lie in one tick");
    std::fflush(stdout);

    std::error_code error;
    const std::filesystem::path program =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "hid_latency";
    const std::string command = fmt::format("umockdev-wrapper '{}'", program.string());
    const bool is_built = std::filesystem::exists(program, error);
    if (!is_built || std::system(command.c_str()) != 0) {
        fmt::print(
            "SpaceMouse, game pads and joysticks: not measured; that takes {}, which is\n"
            "built with the tests, and the package umockdev\n",
            program.string());
    }
    return 0;
}

}  // namespace palpa
