// Omega, delta, sigma and lambda of Force Dimension and the Falcon of Novint, through the maker's
// library DHD. Position in metres from the library's origin. The library's x is towards the person,
// y right, z up; here and in the program x is right, y up, z towards the person.
// Bit 0 of the buttons is the clutch; a sigma.7, which has no button, is clutched by its gripper.
//
// Threads: one of its own asks and tells the device once a millisecond, and looks for it when it is
// lost; read() and write() are the servo's and meet it at two mailboxes.
#pragma once
#include "core/mailbox.h"
#include "devices/device_check.h"
#include "devices/fading_force.h"
#include "devices/force_dimension_library.h"
#include "haptics/device.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>

namespace palpa {

struct ForceDimensionSettings {
    std::optional<std::filesystem::path> library;  // unset: the installed library
    double retry_s = 1;                            // s between two searches for a lost device
    bool is_paced = true;                          // false: as fast as the library answers
};

// Opens the first free device. A device that needs calibration is opened too; until it is
// calibrated its readings are invalid and status() says so.
OpenedDevice open_force_dimension(const ForceDimensionSettings& settings,
                                  const DeviceRequest& request);

// For the list of devices. The environment variable PALPA_FORCE_DIMENSION names the library.
OpenedDevice open_force_dimension_device(const DeviceRequest& request);

// Whether a device is on USB.
bool is_force_dimension_there(const DeviceRequest& request);

// Made by open_force_dimension().
class ForceDimension final : public Device {
public:
    // Numbers of ticks: failures in a row after which the device counts as lost; between two
    // queries of the status; until the motors are switched on again after the device switched them
    // off.
    static constexpr int lost_ticks = 20, status_ticks = 50, refused_ticks = 1000;

    // Takes an open device, and starts its thread.
    ForceDimension(const dhd::Library& library, dhd::Id id, DeviceSpec spec,
                   const ForceDimensionSettings& settings);
    ~ForceDimension() override;

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override { forces_.post(force_newton); }
    std::string_view status() const noexcept override;

    // Sets the force to zero, switches the motors off and closes the device; also at exit(). A
    // second call waits for the first, and does nothing.
    void close() noexcept;

private:
    enum class State { Ready, NeedsCalibration, ForceButton, Refused, Lost };

    void run() noexcept;
    void tick() noexcept;
    bool take_pose(DeviceReading& reading) noexcept;  // false if the device does not answer
    void look_at_status() noexcept;
    void start() noexcept;
    void stop() noexcept;
    void wait_for(std::chrono::steady_clock::duration time);

    const dhd::Library library_;
    const ForceDimensionSettings settings_;
    const DeviceSpec spec_;

    FadingForce forces_;
    Mailbox<DeviceReading> readings_;
    std::atomic<State> state_{State::Ready};
    std::atomic<bool> is_closing_{false};

    // used by its own thread
    std::optional<dhd::Id> id_;  // unset: the device is lost
    bool has_wrist_ = false;
    std::uint64_t ticks_ = 0;
    int failed_ticks_ = 0, refused_left_ticks_ = 0;

    // used by the servo
    DeviceReading last_;

    std::once_flag closed_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool is_over_ = false;  // tells its thread to end
    std::thread thread_;
};

}  // namespace palpa
