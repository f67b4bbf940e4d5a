#include "tools/commands/latency.h"

#include "devices/emulated_omni.h"
#include "experiments/latency.h"
#include "math/quantile.h"
#include "platform/program.h"

#include <fmt/format.h>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
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

}  // namespace palpa
