// A Phantom Omni or a Touch, through its maker's library OpenHaptics. Position in metres from the
// middle of the usable workspace, axes as the library has them: x right, y up, z towards the user.
// The dark button of the stylus is bit 0 (the clutch), the light one bit 1.
//
// Threads: the library's scheduler calls tick() 1000 times a second; read() and write() are the
// servo's and meet it at two mailboxes. A third thread brings a lost device back.
#pragma once
#include "core/mailbox.h"
#include "devices/device_check.h"
#include "devices/fading_force.h"
#include "devices/open_haptics_library.h"
#include "haptics/device.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace palpa {

struct OpenHapticsSettings {
    std::optional<std::filesystem::path> library;  // nothing: where it is installed
    std::string device_name;  // as the maker's set-up program has it; empty: the default device
    double retry_s = 1;       // between two looks for a device that was lost
};

// Nothing is waited for but the library's own start. A device that asks for its inkwell is opened;
// until it has been there its readings are not valid, and status() says so.
OpenedDevice open_haptics(const OpenHapticsSettings& settings, const DeviceRequest& request);

// As in the list of devices: PALPA_OPENHAPTICS and PALPA_OMNI of the environment are library and
// name.
OpenedDevice open_omni(const DeviceRequest& request);

// On USB or FireWire; one on Ethernet does not show.
bool is_omni_there(const DeviceRequest& request);

// Made by open_haptics(). The library serves one device a process; a second one is not opened.
class OpenHaptics final : public Device {
public:
    // Without force after the last error: the device lets go, then the safety chain begins anew.
    static constexpr int warm_ticks = 1000, refused_ticks = 100;

    // Takes an open device, and starts the scheduler.
    OpenHaptics(const hd::Library& library, hd::Handle handle, DeviceSpec spec,
                const Vec3& centre_m, const OpenHapticsSettings& settings);
    ~OpenHaptics() override;

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override { forces_.post(force_newton); }
    std::string_view status() const noexcept override;

    // The library's last error; success if there was none.
    hd::Code last_error() const noexcept { return last_error_; }

    // Force away, scheduler stopped, device given back; also at exit(). Again: nothing.
    void close() noexcept;

private:
    enum class State { Starting, NeedsCalibration, NeedsInkwell, Ready, Warm, Refused, Lost };

    // The library's thread.
    hd::Code tick() noexcept;
    bool update_calibration() noexcept;  // true where positions can be believed
    DeviceReading take_reading() noexcept;
    bool take_errors() noexcept;  // false where the reading is not to be believed
    // The third one.
    void keep();
    void start() noexcept;
    void stop() noexcept;

    const hd::Library library_;
    const OpenHapticsSettings settings_;
    DeviceSpec spec_;
    const Vec3 centre_m_;
    hd::Handle handle_;
    hd::Schedule schedule_ = 0;
    int calibration_style_ = hd::inkwell;

    FadingForce forces_;
    Mailbox<DeviceReading> readings_;
    std::atomic<State> state_{State::Starting};
    std::atomic<hd::Code> last_error_{hd::success};
    std::atomic<bool> is_lost_{false};
    std::atomic<bool> is_closing_{false};   // from now on no force
    std::atomic<bool> played_zero_{false};  // since then

    // the library's thread
    std::uint64_t ticks_ = 0;
    int warm_left_ticks_ = 0, refused_left_ticks_ = 0;  // still without force

    // the servo
    DeviceReading last_;

    std::mutex mutex_;
    std::condition_variable wake_;
    bool is_over_ = false;  // for the third thread
    std::thread keeper_;
};

}  // namespace palpa
