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
    std::optional<std::filesystem::path> library;  // nothing: where it is installed
    double retry_s = 1;                            // between two looks for a device that was lost
    bool is_paced = true;                          // else as fast as the library answers
};

// Opens the first device that is free. One that asks for its calibration is opened; until that is
// done its readings are not valid, and status() says so.
OpenedDevice open_force_dimension(const ForceDimensionSettings& settings,
                                  const DeviceRequest& request);

// As in the list of devices: PALPA_FORCE_DIMENSION of the environment is the library.
OpenedDevice open_force_dimension_device(const DeviceRequest& request);

// On USB.
bool is_force_dimension_there(const DeviceRequest& request);

// Made by open_force_dimension().
class ForceDimension final : public Device {
public:
    // So many ticks in a row fail until the device counts as lost; the status is asked for every
    // so many; after so many the motors are asked for again where the device let go of its own.
    static constexpr int lost_ticks = 20, status_ticks = 50, refused_ticks = 1000;

    // Takes an open device, and starts its thread.
    ForceDimension(const dhd::Library& library, dhd::Id id, DeviceSpec spec,
                   const ForceDimensionSettings& settings);
    ~ForceDimension() override;

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override { forces_.post(force_newton); }
    std::string_view status() const noexcept override;

    // Force away, motors off, device given back; also at exit(). Again: nothing.
    void close() noexcept;

private:
    enum class State { Ready, NeedsCalibration, ForceButton, Refused, Lost };

    void run() noexcept;
    void tick() noexcept;
    bool take_pose(DeviceReading& reading) noexcept;  // false where the device does not answer
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

    // its own thread
    std::optional<dhd::Id> id_;  // nothing: it is lost
    bool has_wrist_ = false;
    std::uint64_t ticks_ = 0;
    int failed_ticks_ = 0, refused_left_ticks_ = 0;

    // the servo
    DeviceReading last_;

    std::mutex mutex_;
    std::condition_variable wake_;
    bool is_over_ = false;  // for its thread
    std::thread thread_;
};

}  // namespace palpa
