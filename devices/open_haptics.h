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
    std::optional<std::filesystem::path> library;  // unset: the installed library
    std::string device_name;  // name in the maker's set-up program; empty: the default device
    double retry_s = 1;       // s between two searches for a lost device
};

// Waits only for the start of the library. A device that must be put into its inkwell is opened
// too; until then its readings are invalid and status() says so.
OpenedDevice open_haptics(const OpenHapticsSettings& settings, const DeviceRequest& request);

// For the list of devices. The environment variables PALPA_OPENHAPTICS and PALPA_OMNI name the
// library and the device.
OpenedDevice open_omni(const DeviceRequest& request);

// Whether a device is on USB or FireWire; a device on Ethernet is not found.
bool is_omni_there(const DeviceRequest& request);

// Made by open_haptics(). The library serves one device a process; a second one is not opened.
class OpenHaptics final : public Device {
public:
    // Number of ticks without force after the last error: the device switches off, then the safety
    // chain starts again.
    static constexpr int warm_ticks = 1000, refused_ticks = 100;

    // Takes an open device, and starts the scheduler.
    OpenHaptics(const hd::Library& library, hd::Handle handle, DeviceSpec spec,
                const Vec3& centre_m, const OpenHapticsSettings& settings);
    ~OpenHaptics() override;

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override { forces_.post(force_newton); }
    std::string_view status() const noexcept override;

    // The last error of the library, or success.
    hd::Code last_error() const noexcept { return last_error_; }

    // Sets the force to zero, stops the scheduler and closes the device; also at exit(). A second
    // call waits for the first, and does nothing.
    void close() noexcept;

private:
    enum class State { Starting, NeedsCalibration, NeedsInkwell, Ready, Warm, Refused, Lost };

    // The library's thread.
    hd::Code tick() noexcept;
    bool update_calibration() noexcept;  // true if positions are valid
    DeviceReading take_reading() noexcept;
    bool take_errors() noexcept;  // false if the reading is not valid
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
    std::atomic<bool> is_closing_{false};   // no force from now on
    std::atomic<bool> played_zero_{false};  // zero force was sent since then

    // the library's thread
    std::uint64_t ticks_ = 0;
    int warm_left_ticks_ = 0, refused_left_ticks_ = 0;  // remaining ticks without force

    // the servo
    DeviceReading last_;

    std::once_flag closed_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool is_over_ = false;  // tells the third thread to end
    std::thread keeper_;
};

}  // namespace palpa
