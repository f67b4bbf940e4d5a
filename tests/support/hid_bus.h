// Human interface devices that are not there, for the real libhidapi and libudev: umockdev shows
// them a made-up /sys and /dev. The program has to be started with its library before all others.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace palpa::test {

struct MockHid {
    std::uint16_t vendor = 0, product = 0;
    std::uint8_t usage_page = 1, usage = 0;
    bool is_bluetooth = false;
    std::string name = "a device";
    std::vector<std::uint8_t> descriptor = {};  // empty: the shortest one that names the usage
    // What it answers when it is asked for a feature report, by its number: one after the other,
    // the last one for ever.
    std::map<std::uint8_t, std::vector<std::vector<std::uint8_t>>> features = {};
};

// One at a time; its devices are its own.
class HidBus {
public:
    // Throws what is missing where the program was started without umockdev.
    HidBus();
    HidBus(const HidBus&) = delete;
    HidBus& operator=(const HidBus&) = delete;
    ~HidBus();

    // It becomes /dev/hidrawNUMBER, a new number each time; by it the device is called below.
    int plug(const MockHid& device);
    void unplug(int number);

    // What the device says, one report. The next one only when that was read: what stands in for
    // the node keeps no borders between reports.
    void send(int number, std::span<const std::uint8_t> report);

    // What was written to it since the last call: output reports and feature reports in their
    // order.
    std::vector<std::uint8_t> take_written(int number);

private:
    struct Testbed;
    std::unique_ptr<Testbed> testbed_;
};

}  // namespace palpa::test
