// palpa devices --latency: prints how long it takes from what a device says to what it plays.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace palpa {

// Its heading, and one line: median, p99 and most, in us, what lies between, and how many of those
// that were asked for never came.
void print_latency_heading();
void print_latency(const std::string& device, std::size_t asked,
                   const std::vector<double>& samples_us, const std::string& what);

// The emulated device in this process; then the others, where bin/hid_latency, which is built with
// the tests, can show them to the real libhidapi. Exit code 0.
int latency_command();

// How late a servo's thread wakes, for so many seconds with real-time priority and as long without.
int wake_up_command(double seconds, bool json);

}  // namespace palpa
