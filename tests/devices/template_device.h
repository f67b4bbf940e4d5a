// A device to begin with (devices/adding.md): copy it to devices/NAME.{h,cpp}, and put what talks
// to the hardware in the place of TemplateWire. It passes the conformance tests as it stands.
#pragma once
#include "core/mailbox.h"
#include "devices/device_check.h"
#include "haptics/device.h"
#include "math/vec.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <string_view>

namespace palpa::test {

// What the hardware's own thread and the servo's hand over. That thread posts a reading whenever it
// has one, sane and in SI, and plays the newest force; where that is not renewed, none.
struct TemplateWire {
    Mailbox<DeviceReading> readings;
    Mailbox<Vec3> forces;
    std::atomic<bool> is_plugged{true};
};

class TemplateDevice final : public Device {
public:
    explicit TemplateDevice(TemplateWire& wire) : wire_(wire) {
        // As the hardware says it, or its maker: then the header says where.
        spec_.name = "template";
        spec_.peak_force_newton = 3;
        spec_.half_workspace_m = Vec3(0.08, 0.06, 0.04);
    }
    ~TemplateDevice() override { wire_.forces.post(Vec3::Zero()); }

    const DeviceSpec& spec() const noexcept override { return spec_; }

    // Nothing new is not valid.
    DeviceReading read() noexcept override {
        const bool is_new = wire_.readings.read(reading_);
        reading_.valid = is_new && reading_.valid && reading_.position_m.allFinite();
        return reading_;
    }

    // No motor is given what is no number, or more than it can.
    void write(const Vec3& force_newton) noexcept override {
        const double norm = force_newton.stableNorm();
        const double share = std::min(1.0, spec_.peak_force_newton / std::max(norm, 1e-12));
        wire_.forces.post(force_newton.allFinite() ? Vec3(share * force_newton)
                                                   : Vec3(Vec3::Zero()));
    }

    std::string_view status() const noexcept override {
        return wire_.is_plugged ? "" : "the template was unplugged: plug it in again";
    }

private:
    TemplateWire& wire_;
    DeviceSpec spec_;
    DeviceReading reading_;
};

// A check for each layer, to the first that it cannot do without.
inline OpenedDevice open_template(TemplateWire& wire) {
    if (!wire.is_plugged) {
        return {nullptr, {{"bus", CheckOutcome::Failed, "nothing is plugged in", "plug it in"}}};
    }
    return {std::make_unique<TemplateDevice>(wire),
            {{"bus", CheckOutcome::Ok, "the template's wire", ""}}};
}

}  // namespace palpa::test
