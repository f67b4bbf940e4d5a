// A device on hidapi that says how fast the hand wants its handle to go, and plays the force as far
// as it can: on a thread of its own the device is found, read, written, and looked for again after
// it was unplugged. What its reports mean is a HidProtocol's.
//
// Where it senses no place the handle is one that is not there (devices/rate_handle.h), on the
// servo's clock, a tick a read. The clutch takes that handle back to the middle of its box. The
// second button gives the rate to the camera, and back. Where it senses one, the handle glides from
// report to report.
#pragma once
#include "core/mailbox.h"
#include "devices/device_check.h"
#include "devices/hid_bus.h"
#include "devices/rate_handle.h"
#include "haptics/device.h"
#include "haptics/safety.h"

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace palpa {

// What a hand does to the device. Bit 0 of the buttons is the clutch, bit 1 the camera.
struct HidInput {
    HandRate rate;
    std::uint32_t buttons = 0;
    std::optional<Vec3> place_m;  // of the handle, where it is sensed and was reported
};

// What the device shall do about it: 0 nothing, 255 all it can.
struct HidOutput {
    std::uint8_t force = 0;      // the norm of the force, full at full_newton
    std::uint8_t contact = 0;    // how far that has risen lately
    bool is_lit = false;         // the person is heard, and moves the handle
    Vec3 newton = Vec3::Zero();  // the force itself, on a device with motors
    bool operator==(const HidOutput&) const = default;
};

// What one kind of device says and hears. Pure: knows no thread, no clock and no library.
class HidProtocol {
public:
    HidProtocol() = default;
    HidProtocol(const HidProtocol&) = delete;
    HidProtocol& operator=(const HidProtocol&) = delete;
    virtual ~HidProtocol() = default;

    virtual std::string_view name() const noexcept = 0;
    virtual bool is_ours(const HidPlace& place) const noexcept = 0;

    // Easily taken for one of ours: why it is not; empty for all others.
    virtual std::string why_not(const HidPlace& /*place*/) const { return {}; }

    // Its limits, where it senses a place and has motors: a peak force says that it does.
    virtual void describe(DeviceSpec& /*spec*/) const noexcept {}

    // Whether it reports without being touched.
    virtual bool is_talkative() const noexcept = 0;

    // Just opened: a device of which nothing is known. What came of it; of no layer where nothing
    // can go wrong. It is not used where that failed.
    virtual DeviceCheck begin(HidLine& line, const HidPlace& place) noexcept = 0;

    // Behind the last report, before the line is closed.
    virtual void end(HidLine& /*line*/) noexcept {}

    // Changes of `input` what the report says; false, and nothing changed, where it is none that
    // is known.
    virtual bool decode(HidBytes report, HidInput& input) noexcept = 0;

    // The report that does this, until the next call; empty where there is nothing new to say.
    virtual HidBytes encode(const HidOutput& output) noexcept = 0;

    // The next one that it takes besides, likewise.
    virtual HidBytes encode_next() noexcept { return {}; }

    // The report that was given last was not written: the device does not know it.
    virtual void forget() noexcept {}

    // Between two reports out: what the line takes without a queue.
    virtual double least_s() const noexcept = 0;
};

struct HidSettings {
    double retry_s = 1;      // between two looks for a device that was lost
    double stale_s = 0.020;  // a force that the servo does not renew is played no longer
    double silent_s = 0.25;  // a rate that the device does not renew is one no longer
    bool is_paced = true;    // keeps HidProtocol::least_s
};

class HidDevice final : public Device {
public:
    // The force that is played as all the device can do: the clamp, unless a scene changes it.
    static constexpr double full_newton = SafetySettings{}.clamp_newton;
    // In which what rises counts as contact: long enough to be felt, e^-1.
    static constexpr double contact_s = 0.050;

    // In which a handle that is sensed comes nearer to the place of the newest report, to 1/e:
    // about as long as the next one takes. No faster than the safety chain bears.
    static constexpr double glide_s = 0.008, glide_m_per_s = 1;

    // Takes an open line on which the protocol has begun.
    HidDevice(std::unique_ptr<HidProtocol> protocol, HidLine line, const HidPlace& place,
              const HidSettings& settings);
    ~HidDevice() override;

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override;
    std::string_view status() const noexcept override;
    void attend(bool is_meant) noexcept override { is_meant_ = is_meant; }
    HandRate view_rate() const noexcept override;

    // How many reports were read, and how many of them could be understood.
    std::uint64_t reports() const noexcept { return reports_; }
    std::uint64_t understood() const noexcept { return understood_; }

    // What it does is taken away, the device given back; also at exit(). Again: nothing.
    void close() noexcept;

private:
    using Clock = std::chrono::steady_clock;

    bool has_motors() const noexcept { return spec_.peak_force_newton > 0; }

    // The servo's thread.
    void read_place(DeviceReading& reading) noexcept;
    void read_rate(DeviceReading& reading) noexcept;

    // Its own thread.
    void run() noexcept;
    void serve() noexcept;
    void take(HidBytes report) noexcept;
    void play(const HidOutput& output) noexcept;
    // Nothing, again for a while where the line does not take it.
    void play_last() noexcept;
    HidOutput newest_output() noexcept;
    void find() noexcept;
    bool begin(const HidPlace& place) noexcept;
    void start() noexcept;
    void lose() noexcept;
    void post(const HidInput& input) noexcept;

    const std::unique_ptr<HidProtocol> protocol_;
    const HidSettings settings_;
    DeviceSpec spec_;
    std::string lost_;  // the sentence

    Mailbox<HidInput> inputs_;
    Mailbox<HidOutput> outputs_;
    mutable Mailbox<HandRate> views_;
    std::atomic<bool> is_plugged_{true}, is_meant_{true}, moves_view_{false}, is_closing_{false};
    std::atomic<bool> is_placed_{false};  // it has reported where its handle is
    std::atomic<std::uint64_t> reports_{0}, understood_{0};

    // its own thread
    HidLine line_;
    HidInput input_;  // the newest
    Clock::time_point heard_{}, renewed_{}, written_{};
    HidOutput wanted_, played_;  // by the servo; by the device
    bool has_played_ = false;

    // the servo
    RateHandle handle_;
    std::optional<Vec3> place_m_;  // instead, where it is sensed
    HidInput last_;
    std::uint64_t ticks_ = 0;
    double slow_share_ = 0;  // of the force, `contact_s` late

    // the window
    mutable HandRate view_;

    std::mutex mutex_;
    std::condition_variable wake_;
    std::thread thread_;
};

// Whether one of that kind is plugged in.
bool is_hid_there(const HidProtocol& protocol);

// The first device of a kind that this program has not opened yet, with every layer's checks.
OpenedDevice open_hid(std::unique_ptr<HidProtocol> protocol, const HidSettings& settings = {});

}  // namespace palpa
