#include "devices/open_haptics.h"

#include "tests/support/open_haptics_stub/load.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait_until.h"

#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

using namespace palpa;
using test::OpenHapticsStub;
using test::StubCalibration;

namespace {

OpenedDevice open_stub(const std::string& library = PALPA_OPEN_HAPTICS_STUB) {
    OpenHapticsSettings settings;
    settings.library = library;
    settings.retry_s = 1e-3;
    DeviceRequest request;
    request.system_root = "/nowhere";
    return open_haptics(settings, request);
}

const DeviceCheck& check_of(const OpenedDevice& opened, const std::string& layer) {
    const auto found = std::find_if(opened.checks.begin(), opened.checks.end(),
                                    [&](const DeviceCheck& check) { return check.layer == layer; });
    REQUIRE(found != opened.checks.end());
    return *found;
}

// Registered before any device is open, so run after what a device has registered.
OpenHapticsStub* watched_at_exit = nullptr;
const bool is_watching = std::atexit([] {
                             OpenHapticsStub* const stub = watched_at_exit;
                             if (stub) _exit(stub->is_open() || stub->is_running() ? 1 : 42);
                         }) == 0;

// The device behind the stub, after its first tick.
struct StubbedOmni {
    OpenHapticsStub& stub = test::load_open_haptics_stub();
    OpenedDevice opened;

    explicit StubbedOmni(StubCalibration calibration = StubCalibration::Done) {
        stub.set_calibration(calibration);
        opened = open_stub();
        REQUIRE(opened.device);
        stub.step(1);
    }
    StubbedOmni(const StubbedOmni&) = delete;
    StubbedOmni& operator=(const StubbedOmni&) = delete;
    ~StubbedOmni() {
        opened.device.reset();
        INFO(stub.first_violation());
        CHECK(stub.violations() == 0);
    }

    Device& device() { return *opened.device; }
    Vec3 motors() { return {stub.motor_newton(0), stub.motor_newton(1), stub.motor_newton(2)}; }
    Vec3 handle_m() { return {stub.handle_m(0), stub.handle_m(1), stub.handle_m(2)}; }
    // Each tick with this force.
    DeviceReading tick(const Vec3& force_newton, int times = 1) {
        for (int i = 0; i < times; ++i) {
            device().write(force_newton);
            stub.step(1);
        }
        return device().read();
    }
};

}  // namespace

TEST_CASE("limits are those that the library says", "[devices][open-haptics]") {
    StubbedOmni omni;
    const DeviceSpec& spec = omni.device().spec();

    CHECK(spec.name == "emulated PHANTOM Omni");
    CHECK(spec.peak_force_newton == OpenHapticsStub::peak_newton);
    CHECK(spec.continuous_force_newton == OpenHapticsStub::continuous_newton);
    CHECK((spec.half_workspace_m - Vec3(0.080, 0.060, 0.035)).norm() < 1e-15);
    for (const DeviceCheck& check : omni.opened.checks) {
        INFO(check.layer << ": " << check.found);
        CHECK(check.outcome == (check.layer == "bus" ? CheckOutcome::Unknown : CheckOutcome::Ok));
    }
    CHECK(check_of(omni.opened, "library").found == PALPA_OPEN_HAPTICS_STUB);
    CHECK(check_of(omni.opened, "rate").found == "1000 ticks a second");
    CHECK(check_of(omni.opened, "motors").found == "at 25 % of their thermal limit");
}

TEST_CASE("the pose comes from the transform, columns first, millimetres made metres",
          "[devices][open-haptics]") {
    StubbedOmni omni;
    (void)omni.tick(Vec3(0.9, -0.7, 0.5), 60);
    const Vec3 handle = omni.handle_m();
    const DeviceReading reading = omni.tick(Vec3::Zero());

    CHECK(handle.norm() > 0.01);
    // Half an encoder step on each axis.
    CHECK((reading.position_m - handle).cwiseAbs().maxCoeff() <= 0.5 * 0.055e-3 + 1e-9);
    CHECK((reading.orientation * Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-12);
    CHECK((reading.orientation * Vec3::UnitZ() - Vec3::UnitZ()).norm() < 1e-12);
}

TEST_CASE("a transform by hand, and those that are none", "[devices][open-haptics]") {
    StubbedOmni omni;
    // x of the stylus along z of the world, y along x, z along y.
    double m[16] = {0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 10, 50, -40, 1};
    const auto report = [&] {
        omni.stub.report_transform(m);
        return omni.tick(Vec3::Zero());
    };
    const DeviceReading good = report();

    CHECK(good.valid);
    CHECK((good.position_m - Vec3(0.010, 0.020, -0.020)).norm() < 1e-15);
    CHECK((good.orientation * Vec3::UnitX() - Vec3::UnitZ()).norm() < 1e-12);
    CHECK((good.orientation * Vec3::UnitY() - Vec3::UnitX()).norm() < 1e-12);

    SECTION("no number") { m[13] = std::nan(""); }
    SECTION("a place that no stylus reaches") { m[14] = 1e6; }
    SECTION("axes of no length") { m[2] = 0; }
    SECTION("axes that are not square") { m[6] = 0.5; }
    SECTION("a mirror") { m[2] = -1; }
    CHECK_FALSE(report().valid);
    CHECK(omni.device().read().position_m.allFinite());
}

TEST_CASE("the dark button of the stylus is the clutch", "[devices][open-haptics]") {
    StubbedOmni omni;
    omni.stub.press(1);
    CHECK(is_pressed(omni.tick(Vec3::Zero()).buttons, Button::Clutch));
    omni.stub.press(2);
    CHECK(omni.tick(Vec3::Zero()).buttons == 2);
}

TEST_CASE("a force that no servo renews is gone after 70 ticks", "[devices][open-haptics]") {
    StubbedOmni omni;
    omni.device().write(Vec3(1, 0, 0));

    omni.stub.step(1 + FadingForce::stale_ticks);
    CHECK(omni.motors().x() == 1);
    omni.stub.step(FadingForce::fade_ticks / 2);
    CHECK(omni.motors().x() == Approx(0.5));
    omni.stub.step(FadingForce::fade_ticks / 2);
    CHECK(omni.motors() == Vec3::Zero());
    omni.stub.step(1000);
    CHECK(omni.motors() == Vec3::Zero());
    (void)omni.tick(Vec3(0, 1, 0));
    CHECK(omni.motors() == Vec3(0, 1, 0));
}

TEST_CASE("a force beyond the motors is cut along its direction", "[devices][open-haptics]") {
    StubbedOmni omni;
    (void)omni.tick(Vec3(30, 40, 0));
    CHECK((omni.motors() - Vec3(1.98, 2.64, 0)).norm() < 1e-12);
}

TEST_CASE("an error of the force takes it away for a while, and is told",
          "[devices][open-haptics]") {
    const auto [code, trouble, ticks] = GENERATE(table<hd::Code, DeviceTrouble, int>({
        {hd::warm_motors, DeviceTrouble::WarmMotors, OpenHaptics::warm_ticks},
        {hd::exceeded_max_force, DeviceTrouble::ForceRefused, OpenHaptics::refused_ticks},
        {hd::exceeded_force_impulse, DeviceTrouble::ForceRefused, OpenHaptics::refused_ticks},
        {hd::exceeded_max_velocity, DeviceTrouble::ForceRefused, OpenHaptics::refused_ticks},
        {hd::force_error, DeviceTrouble::ForceRefused, OpenHaptics::refused_ticks},
    }));
    CAPTURE(code);
    StubbedOmni omni;
    (void)omni.tick(Vec3(0.5, 0, 0), 3);

    omni.stub.raise_error(code);
    const DeviceReading told = omni.tick(Vec3(0.5, 0, 0));
    const std::string status(omni.device().status());
    int without = 0;
    for (; omni.motors() == Vec3::Zero() && without < 2000; ++without) {
        (void)omni.tick(Vec3(0.5, 0, 0));
    }

    CHECK(told.valid);
    CHECK(told.trouble == trouble);
    CHECK(status.back() == '.');
    CHECK(without == ticks);
    CHECK(omni.motors() == Vec3(0.5, 0, 0));
    CHECK(omni.device().read().trouble == DeviceTrouble::None);
    CHECK(omni.device().status().empty());
    CHECK(dynamic_cast<OpenHaptics&>(omni.device()).last_error() == code);
}

TEST_CASE("a device that is lost is opened again by itself", "[devices][open-haptics]") {
    const hd::Code code = GENERATE(hd::device_fault, hd::comm_error, hd::comm_config_error);
    CAPTURE(code);
    StubbedOmni omni;
    (void)omni.tick(Vec3(0.5, 0, 0), 3);
    REQUIRE(omni.stub.devices_opened() == 1);

    omni.stub.raise_error(code);
    DeviceReading reading = omni.tick(Vec3(0.5, 0, 0));
    CHECK_FALSE(reading.valid);
    test::wait_until([&] { return (reading = omni.tick(Vec3::Zero())).valid; }, "the device");

    CHECK(omni.stub.devices_opened() == 2);
    CHECK(omni.stub.is_force_enabled());
    (void)omni.tick(Vec3(0.5, 0, 0));
    CHECK(omni.motors() == Vec3(0.5, 0, 0));
}

TEST_CASE("a scheduler that does not start is tried again, and the status says so",
          "[devices][open-haptics]") {
    StubbedOmni omni;
    omni.stub.refuse_starts(3);
    omni.stub.raise_error(hd::comm_error);
    DeviceReading reading = omni.tick(Vec3(0.5, 0, 0));
    CHECK_FALSE(reading.valid);
    const auto is_back = [&] {
        reading = omni.tick(Vec3::Zero());
        const auto opened = omni.stub.devices_opened();
        const std::string status(omni.device().status());
        if (opened == 3 && omni.stub.devices_opened() == 3)
            CHECK_THAT(status, Catch::Contains("does not answer"));
        return reading.valid;
    };
    test::wait_until(is_back, "the device");

    CHECK(omni.stub.devices_opened() == 5);
    CHECK(omni.device().status().empty());
    (void)omni.tick(Vec3(0.5, 0, 0));
    CHECK(omni.motors() == Vec3(0.5, 0, 0));
}

TEST_CASE("while a device is away the status says so, and closing does not wait for it",
          "[devices][open-haptics]") {
    StubbedOmni omni;
    omni.stub.plug(false);
    (void)omni.tick(Vec3(0.5, 0, 0), 2);

    CHECK_THAT(std::string(omni.device().status()), Catch::Contains("does not answer"));
    omni.opened.device.reset();
    CHECK_FALSE(omni.stub.is_open());
    CHECK_FALSE(omni.stub.is_running());
}

TEST_CASE("an error of a frame spoils its reading alone", "[devices][open-haptics]") {
    StubbedOmni omni;
    omni.stub.raise_error(hd::frame_error);
    CHECK_FALSE(omni.tick(Vec3::Zero()).valid);
    CHECK(omni.tick(Vec3::Zero()).valid);
    CHECK(omni.stub.devices_opened() == 1);
}

TEST_CASE("what the library can calibrate by itself it does", "[devices][open-haptics]") {
    StubbedOmni omni(StubCalibration::NeedsUpdate);

    CHECK(check_of(omni.opened, "calibration").outcome == CheckOutcome::Ok);
    CHECK(omni.device().read().valid);
    // Later as well, and what came before is not believed.
    omni.stub.set_calibration(StubCalibration::NeedsUpdate);
    CHECK_FALSE(omni.tick(Vec3::Zero()).valid);
    CHECK(omni.tick(Vec3::Zero()).valid);
}

TEST_CASE("a stylus that has to go into its inkwell is asked for, and has no force before",
          "[devices][open-haptics]") {
    StubbedOmni omni(StubCalibration::NeedsInkwell);
    const DeviceCheck& check = check_of(omni.opened, "calibration");
    CHECK(check.outcome == CheckOutcome::Failed);
    CHECK_THAT(check.remedy, Catch::Contains("inkwell"));

    CHECK_FALSE(omni.tick(Vec3(1, 0, 0), 600).valid);
    CHECK(omni.motors() == Vec3::Zero());
    CHECK_THAT(std::string(omni.device().status()), Catch::Contains("inkwell"));

    omni.stub.put_into_inkwell();
    CHECK(omni.tick(Vec3(1, 0, 0), 251).valid);
    CHECK(omni.device().status().empty());
    CHECK(omni.motors() == Vec3(1, 0, 0));
}

TEST_CASE("a calibration that fails leaves readings invalid and the handle free",
          "[devices][open-haptics]") {
    StubbedOmni omni(StubCalibration::Broken);

    CHECK(check_of(omni.opened, "calibration").outcome == CheckOutcome::Failed);
    CHECK_FALSE(omni.tick(Vec3(1, 0, 0), 100).valid);
    CHECK(omni.motors() == Vec3::Zero());
    CHECK_FALSE(omni.device().status().empty());
}

TEST_CASE("without a device the report names the layer that failed, and a remedy",
          "[devices][open-haptics]") {
    OpenHapticsStub& stub = test::load_open_haptics_stub();
    std::string library = PALPA_OPEN_HAPTICS_STUB, layer, told;
    SECTION("no library") {
        library = "/nowhere/libHD.so";
        layer = "library";
        told = "/nowhere/libHD.so";
    }
    SECTION("a library that lacks a function") {
        library = PALPA_OPEN_HAPTICS_STUB_LACKING;
        layer = "symbols";
        told = "hdUnschedule";
    }
    SECTION("nothing plugged in") {
        stub.plug(false);
        layer = "init";
        told = "0x0300";
    }
    const OpenedDevice opened = open_stub(library);

    CHECK_FALSE(opened.device);
    CHECK(opened.checks.back().layer == layer);
    CHECK(opened.checks.back().outcome == CheckOutcome::Failed);
    CHECK_THAT(opened.checks.back().found, Catch::Contains(told));
    CHECK_FALSE(opened.checks.back().remedy.empty());
    CHECK(stub.devices_opened() == 0);
}

TEST_CASE("a device that is plugged in is reported with the library that is missing",
          "[devices][open-haptics]") {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "sys/bus/usb/devices/1-2");
    (void)folder.add_file("sys/bus/usb/devices/1-2/idVendor", "2988\n");
    (void)folder.add_file("sys/bus/usb/devices/1-2/idProduct", "0302\n");
    OpenHapticsSettings settings;
    settings.library = "/nowhere/libHD.so";
    DeviceRequest request;
    request.system_root = folder.path();

    const OpenedDevice opened = open_haptics(settings, request);

    CHECK_FALSE(opened.device);
    CHECK(check_of(opened, "bus").outcome == CheckOutcome::Ok);
    CHECK_THAT(check_of(opened, "bus").found, Catch::Contains("2988:0302"));
    CHECK(check_of(opened, "permission").outcome == CheckOutcome::Unknown);
    CHECK(opened.checks.back().layer == "library");
    CHECK(opened.checks.back().outcome == CheckOutcome::Failed);
}

TEST_CASE("an empty name of the library is none", "[devices][open-haptics]") {
    setenv("PALPA_OPENHAPTICS", "", 1);
    const OpenedDevice opened = open_omni({});
    unsetenv("PALPA_OPENHAPTICS");

    CHECK_THAT(check_of(opened, "library").found, Catch::Contains("libHD"));
}

TEST_CASE("a second device is not opened beside the first", "[devices][open-haptics]") {
    StubbedOmni omni;
    const OpenedDevice second = open_stub();

    CHECK_FALSE(second.device);
    CHECK(second.checks.back().layer == "init");
    CHECK(omni.tick(Vec3(1, 0, 0)).valid);
    omni.opened.device.reset();
    CHECK(open_stub().device);
}

TEST_CASE("closing plays a last tick without force, then stops", "[devices][open-haptics]") {
    StubbedOmni omni;
    (void)omni.tick(Vec3(1, 0, 0), 5);
    REQUIRE(omni.motors() == Vec3(1, 0, 0));
    // The library's own clock goes on meanwhile.
    std::thread clock([&] {
        while (omni.stub.is_running()) omni.stub.step(1);
    });

    omni.opened.device.reset();
    clock.join();

    CHECK_FALSE(omni.stub.was_stopped_under_force());
    CHECK_FALSE(omni.stub.is_open());
    CHECK(omni.motors() == Vec3::Zero());
}

TEST_CASE("a scheduler that stands still keeps nobody from closing", "[devices][open-haptics]") {
    StubbedOmni omni;
    (void)omni.tick(Vec3(1, 0, 0), 5);

    omni.opened.device.reset();

    CHECK(omni.stub.was_stopped_under_force());
    CHECK_FALSE(omni.stub.is_force_enabled());
    CHECK(omni.motors() == Vec3::Zero());
}

TEST_CASE("an exception closes the device on its way", "[devices][open-haptics]") {
    OpenHapticsStub& stub = test::load_open_haptics_stub();
    try {
        const OpenedDevice opened = open_stub();
        opened.device->write(Vec3(1, 0, 0));
        stub.step(1);
        throw std::runtime_error("somewhere else");
    } catch (const std::runtime_error&) {
        CHECK(stub.devices_opened() == 1);
    }
    CHECK_FALSE(stub.is_open());
    CHECK_FALSE(stub.is_force_enabled());
    CHECK(stub.motor_newton(0) == 0);
}

TEST_CASE("exit() closes a device that nobody destroyed", "[devices][open-haptics]") {
    REQUIRE(is_watching);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        OpenHapticsStub& stub = test::load_open_haptics_stub();
        watched_at_exit = &stub;
        Device* const forgotten = open_stub().device.release();
        forgotten->write(Vec3(1, 0, 0));
        stub.step(1);
        std::exit(stub.motor_newton(0) == 1 ? 0 : 2);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);

    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 42);
}

TEST_CASE("every documented error has words and a remedy", "[devices][open-haptics]") {
    std::set<std::string> said;
    for (const hd::Code code : {hd::warm_motors, hd::exceeded_max_force, hd::exceeded_force_impulse,
                                hd::exceeded_max_velocity, hd::force_error, hd::device_fault,
                                hd::already_initiated, hd::comm_error, hd::comm_config_error,
                                hd::timer_error, hd::bad_handle, hd::invalid_licence}) {
        CAPTURE(code);
        const hd::ErrorWords words = hd::describe(code);
        CHECK_FALSE(words.remedy.empty());
        CHECK(said.insert(std::string(words.what)).second);
    }
    for (const hd::Code code : {hd::invalid_enum, hd::illegal_begin, hd::scheduler_full, 0x999U}) {
        CHECK_FALSE(hd::describe(code).what.empty());
    }
    CHECK(hd::describe(hd::success).what.empty());
}

TEST_CASE("20,000 transforms of random bits give finite readings or none",
          "[devices][open-haptics]") {
    StubbedOmni omni;
    std::uint64_t bits = 0x9e3779b97f4a7c15;
    double m[16];
    int believed = 0;

    for (int i = 0; i < 20'000; ++i) {
        for (double& number : m) {
            bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
            std::memcpy(&number, &bits, sizeof number);
        }
        omni.stub.report_transform(m);
        const DeviceReading reading = omni.tick(Vec3(0.1, 0, 0));
        believed += reading.valid ? 1 : 0;
        REQUIRE(reading.position_m.allFinite());
        REQUIRE(reading.orientation.coeffs().allFinite());
    }
    omni.stub.report_transform(nullptr);

    CHECK(believed == 0);
    CHECK(omni.tick(Vec3::Zero()).valid);
}
