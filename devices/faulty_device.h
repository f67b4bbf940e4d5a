// A device around another one that breaks when told to, for tests and scenarios.
#pragma once
#include "haptics/device.h"

#include <limits>
#include <utility>
#include <vector>

namespace palpa {

enum class DeviceFault {
    NotANumber,  // position
    Frozen,      // position and time stamp as when it began
    Jump,        // position off by `size_m` along x
    Invalid,     // nothing to say
    Late         // each tick takes `late_s` longer, as the servo's clock shows
};

// From one tick to before another; a tick ends with write().
struct FaultPeriod {
    DeviceFault fault = DeviceFault::Invalid;
    int begin = 0;
    int end = std::numeric_limits<int>::max();
    double size_m = 0.3;
    double late_s = 0.025;
};

// What works goes through unchanged.
class FaultyDevice final : public Device {
public:
    FaultyDevice(Device& device, std::vector<FaultPeriod> periods)
        : device_(device), periods_(std::move(periods)) {}

    const DeviceSpec& spec() const noexcept override { return device_.spec(); }
    void show(const ContactModel& contact, const Vec3& waiting_m) noexcept override {
        device_.show(contact, waiting_m);
    }

    DeviceReading read() noexcept override {
        DeviceReading reading = device_.read();
        bool is_frozen = false;
        for (const FaultPeriod& period : periods_) {
            if (!acts(period)) continue;
            switch (period.fault) {
                case DeviceFault::NotANumber:
                    reading.position_m.y() = std::numeric_limits<double>::quiet_NaN();
                    break;
                case DeviceFault::Frozen:
                    reading = last_;
                    is_frozen = true;
                    break;
                case DeviceFault::Jump:
                    reading.position_m.x() += period.size_m;
                    break;
                case DeviceFault::Invalid:
                    reading.valid = false;
                    break;
                case DeviceFault::Late:
                    break;
            }
        }
        if (!is_frozen) last_ = reading;
        return reading;
    }

    void write(const Vec3& force_newton) noexcept override {
        device_.write(force_newton);
        now_s_ += 1 / device_.spec().rate_hz;
        for (const FaultPeriod& period : periods_) {
            if (period.fault == DeviceFault::Late && acts(period)) now_s_ += period.late_s;
        }
        ++tick_;
    }

    // The servo's clock.
    double now_s() const noexcept { return now_s_; }

private:
    bool acts(const FaultPeriod& period) const noexcept {
        return tick_ >= period.begin && tick_ < period.end;
    }

    Device& device_;
    std::vector<FaultPeriod> periods_;
    DeviceReading last_;  // the last that was not frozen
    double now_s_ = 0;
    int tick_ = 0;
};

}  // namespace palpa
