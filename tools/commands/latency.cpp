#include "tools/commands/latency.h"

#include "devices/emulated_omni.h"
#include "experiments/latency.h"
#include "math/quantile.h"
#include "platform/program.h"

#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

namespace palpa {

void print_latency_heading() {
    fmt::print("{:<24} {:>9} {:>9} {:>9}  {}\n", "device", "median us", "p99 us", "most us",
               "from, to");
}

void print_latency(const std::string& device, std::size_t asked,
                   const std::vector<double>& samples_us, const std::string& what) {
    if (samples_us.empty()) {
        fmt::print("{:<24} no answer arrived\n", device);
        return;
    }
    const std::size_t lost = asked - samples_us.size();
    fmt::print("{:<24} {:>9.0f} {:>9.0f} {:>9.0f}  {}{}\n", device, quantile(samples_us, 0.5),
               quantile(samples_us, 0.99), quantile(samples_us, 1), what,
               lost > 0 ? fmt::format("; {} of {} never arrived", lost, asked) : "");
}

int latency_command() {
    print_latency_heading();
    EmulatedOmni omni(EmulatedOmniSettings{});
    AnsweringServo servo(omni);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    const std::vector<double> ticks_us = servo.stop();
    print_latency("emulated Omni", ticks_us.size(), ticks_us,
                  "reading to rendered force: both in one tick");
    std::fflush(stdout);

    std::error_code error;
    const std::filesystem::path program = find_program_file().parent_path() / "hid_latency";
    const std::string command = fmt::format("umockdev-wrapper '{}'", program.string());
    const bool is_built = std::filesystem::exists(program, error);
    if (!is_built || std::system(command.c_str()) != 0) {
        fmt::print(
            "SpaceMouse, game pads and joysticks: not measured; this needs {} (built\nwith the "
            "tests) and the package umockdev\n",
            program.string());
    }
    return 0;
}

namespace {

nlohmann::ordered_json as_json(const char* priority, const WakeUps& found) {
    nlohmann::ordered_json classes = nlohmann::ordered_json::array();
    for (const LatencyBin& each : bin_latencies(found.late_us))
        classes.push_back({{"below_us", each.below_us}, {"ticks", each.ticks}});
    return {{"priority", priority},
            {"granted", found.is_real_time},
            {"locked", found.is_locked},
            {"ticks", found.late_us.size()},
            {"missed", found.missed},
            {"median_us", quantile(found.late_us, 0.5)},
            {"p99_us", quantile(found.late_us, 0.99)},
            {"p999_us", quantile(found.late_us, 0.999)},
            {"most_us", quantile(found.late_us, 1)},
            {"classes", classes}};
}

void print_wake_ups(const char* priority, const WakeUps& found) {
    fmt::print("{:<10} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>8}\n", priority,
               quantile(found.late_us, 0.5), quantile(found.late_us, 0.99),
               quantile(found.late_us, 0.999), quantile(found.late_us, 1), found.missed);
}

}  // namespace

int wake_up_command(double seconds, bool json) {
    const int ticks = static_cast<int>(std::lround(seconds * servo_rate_hz));
    const WakeUps real_time = measure_wake_ups(ticks, true),
                  ordinary = measure_wake_ups(ticks, false);
    if (json) {
        const nlohmann::ordered_json rows = {as_json("real-time", real_time),
                                             as_json("ordinary", ordinary)};
        fmt::print("{}\n", nlohmann::ordered_json{{"wake_ups", rows}}.dump(2));
        return 0;
    }
    fmt::print("{:<10} {:>9} {:>9} {:>9} {:>9} {:>8}  of {} ticks each\n", "priority", "median us",
               "p99 us", "p99.9 us", "most us", "missed", ticks);
    print_wake_ups("real-time", real_time);
    print_wake_ups("ordinary", ordinary);
    if (!real_time.is_real_time)
        fmt::print("real-time priority was not granted: both rows are of ordinary priority\n");
    return 0;
}

}  // namespace palpa
