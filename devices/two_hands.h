// Two devices as one: each hand holds one of two molecules. The molecule in the first hand is seen
// from the one that it is measured from, which the second hand holds, so that what counts is how
// far the first handle is ahead of the second, and both feel the same force, opposite.
#pragma once
#include "haptics/device.h"

#include <memory>

namespace palpa {

// Of two masses on a spring between them, or of two dampers in series: m1 m2/(m1 + m2).
double in_series(double first, double second) noexcept;

// The first handle's turns are the molecule's; the second one turns nothing. The clutch of either
// hand is that of both.
class TwoHands final : public Device {
public:
    // The second must outlive it: in a window the first may be exchanged.
    TwoHands(std::unique_ptr<Device> first, Device& second);

    // What both can do: the weaker one's force; box of both together; dampers in series, as that of
    // the way between the handles is.
    const DeviceSpec& spec() const noexcept override { return spec_; }

    // Valid where both are.
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override;
    void show(const TouchModel& touch) noexcept override;
    std::string_view status() const noexcept override;
    void attend(bool is_meant) noexcept override;
    HandRate view_rate() const noexcept override;

private:
    std::unique_ptr<Device> first_;
    Device& second_;
    DeviceSpec spec_;
};

}  // namespace palpa
