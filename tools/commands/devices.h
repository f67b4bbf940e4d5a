// palpa devices: what is plugged in, what works, what is wrong and what mends it.
#pragma once
#include <string>

namespace palpa {

struct DevicesOptions {
    std::string name;  // as --device takes it; empty: all
    bool json = false;
    bool tests_force = false;
    bool times_latency = false;
    double wake_up_s = 0;  // time only how late the servo wakes, for so long
};

// Exit code 0 if there is a device that can be used, emulated ones beside, else 1.
int devices_command(const DevicesOptions& options);

// One line a device, for --device list.
void print_device_list();

}  // namespace palpa
