// What every device has to do, whatever stands behind it. Another device is another rig, and a
// name in `PALPA_MOTOR_RIGS`, or a kind of `HidRig`.
#include "devices/device_check.h"
#include "devices/emulated_omni.h"
#include "devices/force_dimension.h"
#include "devices/force_joystick.h"
#include "devices/game_pad.h"
#include "devices/hid_device.h"
#include "devices/mouse_handle.h"
#include "devices/open_haptics.h"
#include "devices/played_handle.h"
#include "devices/sony_pad.h"
#include "devices/space_mouse.h"
#include "haptics/exchange.h"
#include "haptics/safety.h"
#include "haptics/servo.h"
#include "tests/devices/template_device.h"
#include "tests/support/force_dimension_stub/load.h"
#include "tests/support/hid_reports.h"
#include "tests/support/open_haptics_stub/load.h"
#include "tests/support/pid_stick.h"
#include "tests/support/wait_until.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string_view>
#include <thread>

using namespace palpa;

namespace {

// A rig is a device and what a test may do to it:
//   has_own_thread  whether something else than the servo's thread moves it
//   device()        what is tested
//   tick()          after each write: lets a millisecond pass
//   plug(bool)      takes the cable out, or puts it in
//   motors()        what the hand gets now, N
//   played(force)   what of it the hand should get
//   close()         no device() after that
//   moves_m         how far 1 N moves it in 50 ms, from and to; of those that it moves
//   push(way)       where no force moves the handle: what the hand does to it, 1 at the end

// A device that is always there, with a cable.
template <class Inner, class Settings>
class CabledRig {
public:
    static constexpr bool has_own_thread = false;

    Device& device() { return device_; }
    void tick() {}
    void plug(bool is_plugged) { device_.is_plugged = is_plugged; }
    Vec3 motors() const { return device_.written_newton; }
    static Vec3 played(const Vec3& force_newton) { return force_newton; }

private:
    class Cabled final : public Device {
    public:
        const DeviceSpec& spec() const noexcept override { return inner_.spec(); }
        DeviceReading read() noexcept override {
            DeviceReading reading = inner_.read();
            reading.valid = reading.valid && is_plugged;
            return reading;
        }
        void write(const Vec3& force_newton) noexcept override {
            written_newton = is_plugged ? force_newton : Vec3(Vec3::Zero());
            inner_.write(written_newton);
        }

        bool is_plugged = true;
        Vec3 written_newton = Vec3::Zero();

    private:
        Inner inner_{Settings{}};
    };

    Cabled device_;
};

// Half of a t^2 is (1 N - 0.26 N) / 45 g * (50 ms)^2 / 2, 20 mm; less where it is not free.
constexpr std::array<double, 2> omni_moves_m{0.010, 0.021};

class EmulatedRig : public CabledRig<EmulatedOmni, EmulatedOmniSettings> {
public:
    static constexpr std::array<double, 2> moves_m = omni_moves_m;
};

class MouseRig : public CabledRig<MouseHandle, MouseHandleSettings> {
public:
    // 1 N on 200 N/m, 5 mm, but for e^(-50 ms/20 ms) of it.
    static constexpr std::array<double, 2> moves_m{0.0045, 0.0047};
};

using PlayedRig = CabledRig<PlayedHandle, PlayedHandleSettings>;

// As if the hardware's thread ran once a tick: a handle without mass in 4 Ns/m.
class TemplateRig {
public:
    static constexpr bool has_own_thread = true;
    static constexpr std::array<double, 2> moves_m{0.0124, 0.0126};  // 1 N/4 Ns/m * 50 ms

    TemplateRig() : device_(test::open_template(wire_).device) {
        REQUIRE(device_);
        post();
    }

    Device& device() { return *device_; }
    void tick() {
        if (!wire_.is_plugged) return;
        wire_.forces.read(force_newton_);
        handle_m_ += servo_tick_s / 4 * force_newton_;
        handle_m_ = handle_m_.cwiseMax(-device_->spec().half_workspace_m)
                        .cwiseMin(device_->spec().half_workspace_m);
        ++ticks_;
        post();
    }
    void plug(bool is_plugged) {
        wire_.is_plugged = is_plugged;
        force_newton_.setZero();
        DeviceReading gone;
        if (!is_plugged) wire_.readings.post(gone);
        CHECK(device_->status().empty() == is_plugged);
        CHECK((test::open_template(wire_).device != nullptr) == is_plugged);
    }
    Vec3 motors() { return force_newton_; }
    static Vec3 played(const Vec3& force_newton) { return force_newton; }

private:
    void post() {
        wire_.readings.post({static_cast<double>(ticks_) * servo_tick_s, handle_m_, 0, true});
    }

    test::TemplateWire wire_;
    Vec3 handle_m_ = Vec3::Zero(), force_newton_ = Vec3::Zero();
    int ticks_ = 0;
    std::unique_ptr<Device> device_;
};

class GamePadRig {
public:
    static constexpr bool has_own_thread = false;

    GamePadRig() { tick(); }

    Device& device() { return device_; }
    void tick() { link_.inputs.post({.is_there = is_plugged_}); }
    void plug(bool is_plugged) {
        is_plugged_ = is_plugged;
        tick();
    }
    static Vec3 motors() { return Vec3::Zero(); }
    static Vec3 played(const Vec3& /*force_newton*/) { return Vec3::Zero(); }

private:
    PadLink link_;
    bool is_plugged_ = true;
    GamePad device_{link_};
};

class OpenHapticsRig {
public:
    static constexpr bool has_own_thread = true;
    static constexpr std::array<double, 2> moves_m = omni_moves_m;

    OpenHapticsRig() : stub_(test::load_open_haptics_stub()) {
        OpenHapticsSettings settings;
        settings.library = PALPA_OPEN_HAPTICS_STUB;
        settings.retry_s = 1e-3;
        DeviceRequest request;
        request.system_root = "/nowhere";
        device_ = open_haptics(settings, request).device;
        REQUIRE(device_);
        tick();
    }
    OpenHapticsRig(const OpenHapticsRig&) = delete;
    OpenHapticsRig& operator=(const OpenHapticsRig&) = delete;
    ~OpenHapticsRig() {
        device_.reset();
        INFO(stub_.first_violation());
        CHECK(stub_.violations() == 0);
    }

    Device& device() { return *device_; }
    void tick() { stub_.step(1); }
    void plug(bool is_plugged) { stub_.plug(is_plugged); }
    Vec3 motors() { return {stub_.motor_newton(0), stub_.motor_newton(1), stub_.motor_newton(2)}; }
    static Vec3 played(const Vec3& force_newton) { return force_newton; }
    void close() { device_.reset(); }
    // Its own thread stops in the middle of a tick, until release().
    void hold() {
        stub_.block();
        stepper_ = std::thread([this] { stub_.step(1); });
        stub_.wait_until_blocked();
    }
    void release() {
        stub_.unblock();
        stepper_.join();
    }

private:
    test::OpenHapticsStub& stub_;
    std::unique_ptr<Device> device_;
    std::thread stepper_;
};

// Its own thread stands in the middle of a tick but for the steps.
class ForceDimensionRig {
public:
    static constexpr bool has_own_thread = true;
    static constexpr std::array<double, 2> moves_m = omni_moves_m;

    ForceDimensionRig() : stub_(test::load_force_dimension_stub()) {
        DeviceRequest request;
        request.system_root = "/nowhere";
        device_ = open_force_dimension(
                      {.library = PALPA_FORCE_DIMENSION_STUB, .retry_s = 1e-3, .is_paced = false},
                      request)
                      .device;
        REQUIRE(device_);
        tick();
    }
    ForceDimensionRig(const ForceDimensionRig&) = delete;
    ForceDimensionRig& operator=(const ForceDimensionRig&) = delete;
    ~ForceDimensionRig() {
        close();
        INFO(stub_.first_violation());
        CHECK(stub_.violations() == 0);
    }

    Device& device() { return *device_; }
    void tick() { stub_.step(1); }
    void plug(bool is_plugged) { stub_.plug(is_plugged); }
    // The library has the axis to the person first, then right, then up.
    Vec3 motors() { return {stub_.motor_newton(1), stub_.motor_newton(2), stub_.motor_newton(0)}; }
    static Vec3 played(const Vec3& force_newton) { return force_newton; }
    void close() {
        stub_.run_freely();
        device_.reset();
    }
    void hold() {}
    void release() {}

private:
    test::ForceDimensionStub& stub_;
    std::unique_ptr<Device> device_;
};

// What a HidRig stands for: the device, its reports with the handle pushed along an axis, and what
// of the newest report that was written reaches the hand.
struct SpaceMouseKind {
    static inline const test::MockHid hid = test::space_mouse_hid;
    static std::unique_ptr<HidProtocol> protocol() {
        return std::make_unique<SpaceMouseProtocol>();
    }
    static test::Bytes report(const Vec3& push) { return test::pushed_cap(push); }
    static constexpr std::size_t size = 2, force_byte = 0;  // none
};

struct DualSenseKind {
    static inline const test::MockHid hid = test::dualsense_hid;
    static std::unique_ptr<HidProtocol> protocol() {
        return std::make_unique<SonyPadProtocol>(SonyModel::DualSense);
    }
    static test::Bytes report(const Vec3& push) {
        return test::dualsense_report(test::pushed_sticks(push));
    }
    static constexpr std::size_t size = 63, force_byte = 13;
};

struct BluetoothDualSenseKind : DualSenseKind {
    static inline const test::MockHid hid = test::by_bluetooth(test::dualsense_hid);
    static test::Bytes report(const Vec3& push) {
        return test::dualsense_bluetooth_report(test::pushed_sticks(push));
    }
    static constexpr std::size_t size = 78, force_byte = 15;
};

struct DualShock4Kind {
    static inline const test::MockHid hid = test::dualshock4_hid;
    static std::unique_ptr<HidProtocol> protocol() {
        return std::make_unique<SonyPadProtocol>(SonyModel::DualShock4);
    }
    static test::Bytes report(const Vec3& push) {
        return test::dualshock4_report(test::pushed_sticks(push));
    }
    static constexpr std::size_t size = 32, force_byte = 4;
};

// Until the device has read the one report that is on its way, and played what is newest.
void wait_for_answer(const HidDevice& device, std::uint64_t reports_before) {
    test::wait_until([&] { return device.reports() > reports_before; },
                     "the device reads its report");
}

// A force has no direction there: it counts as one along y.
template <class Kind>
class HidRig {
public:
    static constexpr bool has_own_thread = true;

    HidRig() : number_(bus_.plug(Kind::hid)) {
        if (Kind::protocol()->is_talkative()) bus_.send(number_, Kind::report(push_));
        // Nothing is too late however slow the machine.
        OpenedDevice opened =
            open_hid(Kind::protocol(),
                     {.retry_s = 1e-3, .stale_s = 1e3, .silent_s = 1e3, .is_paced = false});
        REQUIRE(opened.device);
        device_ = std::move(opened.device);
        // Or the next one would be joined to it.
        if (Kind::protocol()->is_talkative()) wait_for_answer(hid(), 0);
        tick();
    }

    Device& device() { return *device_; }
    HidDevice& hid() { return dynamic_cast<HidDevice&>(*device_); }
    void push(const Vec3& push) { push_ = push; }
    // Every force that was written before is played then.
    void tick() {
        if (!is_plugged_) return;
        const std::uint64_t before = hid().reports();
        bus_.send(number_, Kind::report(push_));
        wait_for_answer(hid(), before);
    }
    void plug(bool is_plugged) {
        if (is_plugged == is_plugged_) return;
        is_plugged_ = is_plugged;
        is_plugged ? void(number_ = bus_.plug(Kind::hid)) : bus_.unplug(number_);
        last_.clear();
        test::wait_until([&] { return hid().status().empty() == is_plugged; },
                         "the device is lost or found");
    }
    Vec3 motors() {
        const test::Bytes written = is_plugged_ ? bus_.take_written(number_) : test::Bytes{};
        if (written.size() >= Kind::size) last_.assign(written.end() - Kind::size, written.end());
        if (last_.empty() || Kind::force_byte == 0) return Vec3::Zero();
        return {0, last_[Kind::force_byte] * 3.0 / 255, 0};
    }
    static Vec3 played(const Vec3& force_newton) {
        if (Kind::force_byte == 0) return Vec3::Zero();
        return {0, std::round(255 * std::min(force_newton.norm() / 3, 1.0)) * 3 / 255, 0};
    }
    void close() { device_.reset(); }

private:
    test::HidBus bus_;
    int number_;
    bool is_plugged_ = true;
    Vec3 push_ = Vec3::Zero();
    std::unique_ptr<Device> device_;
    test::Bytes last_;
};

// It feels what is written to it, and says where it is.
class JoystickRig {
public:
    static constexpr bool has_own_thread = true;

    JoystickRig() : number_(bus_.plug(test::force_joystick_hid())) {
        OpenedDevice opened =
            open_hid(std::make_unique<ForceJoystickProtocol>(),
                     {.retry_s = 1e-3, .stale_s = 1e3, .silent_s = 1e3, .is_paced = false});
        REQUIRE(opened.device);
        device_ = std::move(opened.device);
        tick();
    }

    Device& device() { return *device_; }
    void tick() {
        if (!is_plugged_) return;
        const auto& hid = dynamic_cast<HidDevice&>(*device_);
        const std::uint64_t before = hid.reports();
        bus_.send(number_, test::pushed_stick(Vec3::Zero()));
        wait_for_answer(hid, before);
    }
    void plug(bool is_plugged) {
        if (is_plugged == is_plugged_) return;
        is_plugged_ = is_plugged;
        stick_ = {};
        is_plugged ? void(number_ = bus_.plug(test::force_joystick_hid())) : bus_.unplug(number_);
        const std::string_view told = is_plugged ? "Move the stick" : "The force-feedback joystick";
        test::wait_until([&] { return device_->status().starts_with(told); },
                         "the stick is lost or found");
    }
    Vec3 motors() {
        if (is_plugged_) stick_.take(bus_.take_written(number_));
        return stick_.force_newton();
    }
    // Whole steps of a ten thousandth of 3 N, and no more; nothing towards the user.
    static Vec3 played(const Vec3& force_newton) {
        const auto step = [](double newton) {
            return std::trunc(1e4 / 3 * newton + std::copysign(1e-9, newton)) * 3 / 1e4;
        };
        return {step(force_newton.x()), step(force_newton.y()), 0};
    }
    void close() { device_.reset(); }

private:
    test::HidBus bus_;
    int number_;
    bool is_plugged_ = true;
    test::PidStick stick_;
    std::unique_ptr<Device> device_;
};

#define PALPA_HID_RIGS                                                             \
    HidRig<SpaceMouseKind>, HidRig<DualSenseKind>, HidRig<BluetoothDualSenseKind>, \
        HidRig<DualShock4Kind>
#define PALPA_MOTOR_RIGS EmulatedRig, MouseRig, TemplateRig, OpenHapticsRig, ForceDimensionRig
#define PALPA_RIGS PALPA_MOTOR_RIGS, JoystickRig, PlayedRig, GamePadRig, PALPA_HID_RIGS

// The servo with a device at its hands: what a molecule at a fixed place asks for.
struct ServoRun {
    ServoSettings settings;
    ServoState state;
    Exchange exchange;
    ContactModel model;
    std::uint64_t ticks = 0;

    ServoRun() {
        settings.force_law = ConstantForceLaw{1e9};
        settings.safety.is_full = true;
    }
    explicit ServoRun(const DeviceSpec& device) : ServoRun() { limit_to(device, settings.safety); }

    void ask_for(const Vec3& force_newton) {
        model.force_newton = force_newton / 1e9;
        exchange.contact.post({model});
    }

    template <class Rig>
    ServoTick tick(Rig& rig) {
        if (ticks % 10 == 0) exchange.contact.post({model});  // or it would be stale
        const DeviceReading reading = rig.device().read();
        const ServoTick done =
            step_servo(settings, state, exchange, reading, static_cast<double>(++ticks) * 1e-3);
        rig.device().write(done.sent_newton);
        rig.tick();
        return done;
    }
};

}  // namespace

TEMPLATE_TEST_CASE("a device says what it can do", "[devices][conformance]", PALPA_RIGS) {
    TestType rig;
    const DeviceSpec& spec = rig.device().spec();

    CHECK_FALSE(spec.name.empty());
    CHECK(spec.rate_hz == servo_rate_hz);
    CHECK(spec.peak_force_newton >= spec.continuous_force_newton);
    CHECK(spec.peak_force_newton < 100);
    CHECK(spec.viscosity_N_s_per_m >= 0);
    CHECK(spec.cap_N_per_m >= 0);
    if (spec.name == "mouse and keys") {
        CHECK(spec.half_workspace_m.isZero());  // it has no end
    } else {
        CHECK(spec.half_workspace_m.minCoeff() > 0.005);
    }
    CHECK(spec.half_workspace_m.maxCoeff() < 1);
}

TEMPLATE_TEST_CASE("a device at rest gives valid readings whose clock runs",
                   "[devices][conformance]", PALPA_RIGS) {
    TestType rig;
    const Vec3 reach = 3 * rig.device().spec().half_workspace_m;
    double last_s = -1;

    for (int i = 0; i < 500; ++i) {
        const DeviceReading reading = rig.device().read();
        REQUIRE(reading.valid);
        REQUIRE(reading.trouble == DeviceTrouble::None);
        REQUIRE((reading.position_m.cwiseAbs().array() <= reach.array()).all());
        REQUIRE(std::abs(reading.orientation.norm() - 1) < 1e-9);
        REQUIRE(reading.time_s > last_s);
        last_s = reading.time_s;
        rig.device().write(Vec3::Zero());
        rig.tick();
    }
    CHECK(last_s == Approx(0.499));
}

TEMPLATE_TEST_CASE("the handle goes where the newest force pushes it", "[devices][conformance]",
                   PALPA_MOTOR_RIGS) {
    TestType rig;
    const int axis = GENERATE(0, 1, 2);
    const double side = GENERATE(-1.0, 1.0);
    const Vec3 push = side * Vec3::Unit(axis);
    const Vec3 before = rig.device().read().position_m;

    for (int i = 0; i < 50; ++i) {
        if (i == 0) rig.device().write(-push);  // overtaken at once
        rig.device().write(push);
        rig.tick();
    }

    const Vec3 moved = rig.device().read().position_m - before;
    CHECK(moved.dot(push) > TestType::moves_m[0]);
    CHECK(moved.dot(push) < TestType::moves_m[1]);
    CHECK((moved - moved.dot(push) * push).norm() < 1e-9);
}

TEMPLATE_TEST_CASE("without motors the handle goes where it is pushed, whatever the force",
                   "[devices][conformance]", PALPA_HID_RIGS) {
    TestType rig;
    const int axis = GENERATE(0, 1, 2);
    const double side = GENERATE(-1.0, 1.0);
    const Vec3 push = side * Vec3::Unit(axis);
    rig.push(push);
    rig.tick();
    const Vec3 before = rig.device().read().position_m;

    for (int i = 0; i < 50; ++i) {
        rig.device().write(3 * Vec3::Random());
        rig.tick();
        (void)rig.device().read();
    }

    // 50 ms and the look before, of 60 mm/s.
    const Vec3 moved = rig.device().read().position_m - before;
    CHECK((moved - 51e-3 * 0.060 * push).norm() < 1e-9);
}

TEMPLATE_TEST_CASE("the newest force is the one that is played", "[devices][conformance]",
                   PALPA_RIGS) {
    TestType rig;
    for (const double newton : {2.5, 0.3, 1.0, 0.0, 0.7}) {
        rig.device().write(Vec3(0, 0, 1.1));
        rig.device().write(Vec3(0, newton, 0));
        rig.tick();
        CHECK((rig.motors() - rig.played(Vec3(0, newton, 0))).norm() < 1e-9);
    }
}

TEMPLATE_TEST_CASE("what is no force leaves a device in order", "[devices][conformance]",
                   PALPA_RIGS) {
    TestType rig;
    if constexpr (TestType::has_own_thread) {
        const double no_number = GENERATE(std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::infinity());
        for (int i = 0; i < 5; ++i) {
            rig.device().write(Vec3(0, no_number, 0));
            rig.tick();
            CHECK(rig.motors() == Vec3::Zero());
        }
    }

    for (int i = 0; i < 100; ++i) {
        rig.device().write(Vec3(0, 1e300, 0));
        rig.tick();
    }

    const DeviceReading reading = rig.device().read();
    CHECK(reading.valid);
    CHECK(reading.position_m.allFinite());
}

TEMPLATE_TEST_CASE("a closed device has no force", "[devices][conformance]", OpenHapticsRig,
                   ForceDimensionRig, JoystickRig, PALPA_HID_RIGS) {
    TestType rig;
    for (int i = 0; i < 10; ++i) {
        rig.device().write(Vec3(1, 2, 0));
        rig.tick();
    }
    REQUIRE((rig.motors() - rig.played(Vec3(1, 2, 0))).norm() < 1e-9);

    rig.close();

    CHECK(rig.motors() == Vec3::Zero());
}

// Without an end, if it waited.
TEMPLATE_TEST_CASE("neither read nor write waits for the device's own thread",
                   "[devices][conformance]", OpenHapticsRig, ForceDimensionRig) {
    TestType rig;
    rig.device().write(Vec3(1, 0, 0));
    rig.tick();
    rig.hold();

    int valid = 0;
    for (int i = 0; i < 1000; ++i) {
        valid += rig.device().read().valid ? 1 : 0;
        rig.device().write(Vec3(0, 0.001 * i, 0));
    }
    rig.release();
    rig.tick();

    CHECK(valid == 1);  // the one before
    CHECK(rig.motors() == Vec3(0, 0.999, 0));
}

TEMPLATE_TEST_CASE("an unplugged device costs the force, and gives it back when it returns",
                   "[devices][conformance]", PALPA_RIGS) {
    const int unplugged_at = GENERATE(0, 1, 2, 17, 100);
    CAPTURE(unplugged_at);
    TestType rig;
    ServoRun servo(rig.device().spec());
    servo.ask_for(Vec3(0, 0.1, 0));
    for (int i = 0; i < unplugged_at; ++i) (void)servo.tick(rig);

    rig.plug(false);
    (void)servo.tick(rig);
    CHECK(rig.motors() == Vec3::Zero());
    ServoTick tick;
    for (int i = 0; i < 12; ++i) {
        tick = servo.tick(rig);
        CHECK(rig.motors() == Vec3::Zero());
    }
    CHECK_FALSE(tick.reading.valid);
    CHECK(tick.stage == SafetyStage::Unplugged);
    CHECK(tick.sent_newton == Vec3::Zero());

    rig.plug(true);
    test::wait_until([&] { return (tick = servo.tick(rig)).reading.valid; }, "the device");
    for (int i = 0; i < 2100; ++i) tick = servo.tick(rig);  // quiet cycles and ramp
    CHECK(tick.sent_newton.y() == Approx(0.1));
    CHECK((rig.motors() - rig.played(tick.sent_newton)).norm() < 1e-9);
}

TEMPLATE_TEST_CASE("a device that comes and goes at random never gets more than the clamp",
                   "[devices][conformance]", PALPA_RIGS) {
    TestType rig;
    ServoRun servo(rig.device().spec());
    std::mt19937 random(GENERATE(1U, 2U));
    std::normal_distribution<double> newton(0, 3);
    int valid = 0;
    bool is_awaited = false;  // plugged in, and not back yet

    for (int i = 0; i < 3000; i += is_awaited ? 0 : 1) {
        if (!is_awaited && random() % 50 == 0) {
            is_awaited = random() % 2 == 0;
            rig.plug(is_awaited);
        }
        if (is_awaited) std::this_thread::yield();
        if (random() % 5 == 0) servo.ask_for({newton(random), newton(random), newton(random)});
        const ServoTick tick = servo.tick(rig);
        valid += tick.reading.valid ? 1 : 0;
        is_awaited = is_awaited && !tick.reading.valid;
        REQUIRE(tick.sent_newton.allFinite());
        REQUIRE(tick.sent_newton.norm() <= servo.settings.safety.clamp_newton * (1 + 1e-12));
        REQUIRE(rig.motors().norm() <= servo.settings.safety.clamp_newton * (1 + 1e-12));
    }

    CHECK(valid > 100);
    CHECK(valid < 3000);
}

namespace {

// Mostly what a handle does, else anything that a broken driver could say.
DeviceReading random_reading(std::mt19937& random, const DeviceReading& before) {
    constexpr std::array odd{0.0,
                             -0.0,
                             1e-310,
                             1e308,
                             -1e308,
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
    std::normal_distribution<double> normal;
    const auto any = [&] { return odd[random() % odd.size()]; };
    DeviceReading reading = before;
    reading.valid = true;
    reading.trouble = DeviceTrouble::None;
    reading.time_s += servo_tick_s;
    reading.position_m += 1e-4 * Vec3(normal(random), normal(random), normal(random));
    switch (random() % 200) {
        case 0:
            reading.position_m(static_cast<Eigen::Index>(random() % 3)) = any();
            break;
        case 1:
            reading.orientation = Quat(any(), any(), any(), any());
            break;
        case 2:
            reading.time_s = any();
            break;
        case 3:
            reading.valid = false;
            break;
        case 4:
            reading.buttons = static_cast<std::uint32_t>(random());
            break;
        case 5:
            reading.trouble = static_cast<DeviceTrouble>(random() % 3);
            break;
        case 6:
            reading.position_m = Vec3::Zero();
            break;
        default:
            break;
    }
    return reading;
}

}  // namespace

TEST_CASE("a million readings, whatever they say, leave a force within the clamp",
          "[devices][conformance]") {
    const bool is_full = GENERATE(true, false);
    std::mt19937 random(5);
    std::normal_distribution<double> newton(0, 2);
    ServoRun servo;
    servo.settings.safety.is_full = is_full;
    DeviceReading sane;
    int with_force = 0;
    double worst = 0;

    for (int i = 0; i < 500'000; ++i) {
        if (random() % 14 == 0) servo.ask_for({newton(random), newton(random), newton(random)});
        if (random() % 100 == 0) servo.ask_for(Vec3::Zero());
        const DeviceReading reading = random_reading(random, sane);
        const bool is_sane = reading.position_m.norm() < 0.1 && std::isfinite(reading.time_s) &&
                             std::abs(reading.time_s) < 1e6 && reading.orientation.norm() < 2;
        if (is_sane) sane = reading;
        const double now_s = static_cast<double>(++servo.ticks) * 1e-3;
        const ServoTick tick =
            step_servo(servo.settings, servo.state, servo.exchange, reading, now_s);
        worst =
            std::max(worst, tick.sent_newton.allFinite() ? tick.sent_newton.norm()
                                                         : std::numeric_limits<double>::infinity());
        with_force += tick.sent_newton != Vec3::Zero() ? 1 : 0;
    }

    CHECK(worst <= servo.settings.safety.clamp_newton * (1 + 1e-12));
    CHECK(with_force > 5000);
}
