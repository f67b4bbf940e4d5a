// What goes wrong or is changed while a hand feels a scene, at random; and a device that keeps
// account of what a servo wrote to it.
#pragma once
#include "core/draws.h"
#include "devices/faulty_device.h"
#include "scene/edits.h"

#include <limits>
#include <string>
#include <vector>

namespace palpa {

struct Disturbances {
    std::vector<std::string> settings;  // gains, laws and stop, as "key=value"
    std::vector<FaultPeriod> faults;
    std::vector<EditDescription> edits;  // in the order of time
};

// For two waters on an axis, "moved" in hand, until `end_s`. A fault in half of all cases, edits in
// half of them.
Disturbances draw_disturbances(Draws& draws, double end_s);

// Whether a fault or an edit may act on the force at that time: edits glide, and a period of the
// simulation passes until they are felt.
bool is_disturbed(const Disturbances& disturbances, double time_s, double period_s) noexcept;

// Between a device without faults and the one that adds them: records where the handle truly was,
// and which force truly reached it.
class WatchedDevice final : public Device {
public:
    explicit WatchedDevice(Device& device) : device_(device) {}

    const DeviceSpec& spec() const noexcept override { return device_.spec(); }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override;
    void show(const ContactModel& contact, const Vec3& waiting_m) noexcept override {
        device_.show(contact, waiting_m);
    }

    double work_J() const noexcept { return work_J_; }  // on the hand, up to the last reading
    // Infinite where one was not finite.
    double most_newton() const noexcept { return most_newton_; }
    // From one tick to the next, where the force did not go to zero at once.
    double most_change_newton() const noexcept { return most_change_newton_; }

private:
    Device& device_;
    Vec3 last_m_ = Vec3::Zero(), sent_newton_ = Vec3::Zero();
    bool has_reading_ = false;
    double work_J_ = 0, most_newton_ = 0, most_change_newton_ = 0;
};

}  // namespace palpa
