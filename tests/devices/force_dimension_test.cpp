#include "devices/force_dimension.h"

#include "tests/support/force_dimension_stub/load.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait_until.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

using namespace palpa;
using test::ForceDimensionStub;

namespace {

OpenedDevice open_dhd_stub(const std::string& library = PALPA_FORCE_DIMENSION_STUB) {
    DeviceRequest request;
    request.system_root = "/nowhere";
    return open_force_dimension({.library = library, .retry_s = 1e-3, .is_paced = false}, request);
}

const DeviceCheck& dhd_check_of(const OpenedDevice& opened, const std::string& layer) {
    const auto found = std::find_if(opened.checks.begin(), opened.checks.end(),
                                    [&](const DeviceCheck& check) { return check.layer == layer; });
    REQUIRE(found != opened.checks.end());
    return *found;
}

// The device behind the stub, after its first tick.
struct StubbedOmega {
    ForceDimensionStub& stub = test::load_force_dimension_stub();
    OpenedDevice opened;

    explicit StubbedOmega(int type = dhd::omega_3, bool needs_calibration = false) {
        stub.set_type(type);
        stub.need_calibration(needs_calibration);
        opened = open_dhd_stub();
        REQUIRE(opened.device);
        stub.step(1);
    }
    StubbedOmega(const StubbedOmega&) = delete;
    StubbedOmega& operator=(const StubbedOmega&) = delete;
    ~StubbedOmega() {
        close();
        INFO(stub.first_violation());
        CHECK(stub.violations() == 0);
    }

    void close() {
        stub.run_freely();
        opened.device.reset();
    }
    Device& device() { return *opened.device; }
    // In the library's axes.
    Vec3 motors() { return {stub.motor_newton(0), stub.motor_newton(1), stub.motor_newton(2)}; }
    DeviceReading tick(const Vec3& force_newton, int times = 1) {
        for (int i = 0; i < times; ++i) {
            device().write(force_newton);
            stub.step(1);
        }
        return device().read();
    }
};

constexpr double upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

}  // namespace

TEST_CASE("an omega is opened with its limits, motors on, weight carried",
          "[devices][force-dimension]") {
    StubbedOmega omega;
    const DeviceSpec& spec = omega.device().spec();

    CHECK(spec.name == "emulated omega");
    CHECK(spec.is_real);
    CHECK(spec.peak_force_newton == 12);
    CHECK(spec.half_workspace_m == Vec3::Constant(0.075));
    CHECK(omega.stub.is_force_enabled());
    CHECK(omega.stub.is_gravity_compensated());
    CHECK_FALSE(omega.stub.is_button_emulated());
    CHECK(omega.motors() == Vec3::Zero());
    CHECK(omega.device().read().valid);
    CHECK_FALSE(omega.device().read().valid);  // nothing newer
    CHECK(omega.device().status().empty());
    for (const DeviceCheck& check : omega.opened.checks) {
        INFO(check.layer << ": " << check.found);
        CHECK(check.outcome == (check.layer == "bus" ? CheckOutcome::Unknown : CheckOutcome::Ok));
    }
    CHECK(std::filesystem::path(dhd_check_of(omega.opened, "library").found) ==
          PALPA_FORCE_DIMENSION_STUB);
}

TEST_CASE("every type has its limits, and one that is not known an omega's",
          "[devices][force-dimension]") {
    // Of a continuous force only an omega's is known, its peak.
    const auto [type, peak, half_m, continuous, outcome] =
        GENERATE(table<int, double, double, double, CheckOutcome>({
            {dhd::falcon, 8, 0.04, 0, CheckOutcome::Ok},
            {dhd::delta_3, 20, 0.15, 0, CheckOutcome::Ok},
            {dhd::omega_7_left, 12, 0.075, 12, CheckOutcome::Ok},
            {dhd::sigma_7, 12, 0.075, 0, CheckOutcome::Unknown},
            {91, 12, 0.075, 0, CheckOutcome::Unknown},
        }));
    CAPTURE(type);
    StubbedOmega omega(type);

    const DeviceSpec& spec = omega.device().spec();
    CHECK(spec.peak_force_newton == peak);
    CHECK(spec.continuous_force_newton == continuous);
    CHECK(spec.half_workspace_m == Vec3::Constant(half_m));
    CHECK(dhd_check_of(omega.opened, "limits").outcome == outcome);
    CHECK(omega.stub.is_button_emulated() == (type == dhd::sigma_7));
}

// To the right, up and towards the person by hand.
TEST_CASE("the library's axes become the program's, both ways", "[devices][force-dimension]") {
    StubbedOmega omega(dhd::omega_6);
    const double place[3] = {0.01, 0.02, 0.03};  // towards, right, up
    omega.stub.report(place, upright);

    const DeviceReading reading = omega.tick(Vec3(0.1, 0.2, 0.3));  // right, up, towards

    CHECK(reading.valid);
    CHECK((reading.position_m - Vec3(0.02, 0.03, 0.01)).norm() < 1e-15);
    CHECK(omega.motors() == Vec3(0.3, 0.1, 0.2));
    CHECK((reading.orientation * Vec3::UnitX() - Vec3::UnitX()).norm() < 1e-12);

    SECTION("a quarter turn about the vertical takes what is right to what is far") {
        // The library's x, towards the person, becomes its y, right; and y becomes -x, away.
        const double turned[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
        omega.stub.report(place, turned);
        const Quat turn = omega.tick(Vec3::Zero()).orientation;
        CHECK((turn * Vec3::UnitZ() - Vec3::UnitX()).norm() < 1e-12);
        CHECK((turn * Vec3::UnitX() + Vec3::UnitZ()).norm() < 1e-12);
        CHECK((turn * Vec3::UnitY() - Vec3::UnitY()).norm() < 1e-12);
    }
    SECTION("a turn about the axis to the person takes what is right up") {
        const double turned[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
        omega.stub.report(place, turned);
        const Quat turn = omega.tick(Vec3::Zero()).orientation;
        CHECK((turn * Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-12);
        CHECK((turn * Vec3::UnitZ() - Vec3::UnitZ()).norm() < 1e-12);
    }
}

TEST_CASE("a force moves the handle where it pushes", "[devices][force-dimension]") {
    StubbedOmega omega;
    const Vec3 force(0.9, -0.7, 0.5);
    const DeviceReading reading = omega.tick(force, 60);

    CHECK(reading.position_m.norm() > 0.01);
    CHECK(reading.position_m.normalized().dot(force.normalized()) > 0.99);
}

TEST_CASE("a pose that is none is not believed", "[devices][force-dimension]") {
    StubbedOmega omega(dhd::omega_6);
    double place[3] = {0, 0, 0};
    double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

    SECTION("no number") { place[1] = std::nan(""); }
    SECTION("a place that no handle reaches") { place[2] = 1e6; }
    SECTION("axes of no length") { axes[4] = 0; }
    SECTION("a mirror") { axes[8] = -1; }
    omega.stub.report(place, axes);
    CHECK_FALSE(omega.tick(Vec3::Zero()).valid);
    CHECK(omega.device().read().position_m.allFinite());
    omega.stub.report(nullptr, nullptr);
    CHECK(omega.tick(Vec3::Zero()).valid);
}

TEST_CASE("the first button of an omega is the clutch", "[devices][force-dimension]") {
    StubbedOmega omega;
    omega.stub.press(1);
    CHECK(is_pressed(omega.tick(Vec3::Zero()).buttons, Button::Clutch));
    omega.stub.press(2);
    CHECK(omega.tick(Vec3::Zero()).buttons == 2);
}

TEST_CASE("a force beyond an omega's motors is cut along its direction",
          "[devices][force-dimension]") {
    StubbedOmega omega;
    (void)omega.tick(Vec3(30, 40, 0));
    CHECK((omega.motors() - Vec3(0, 7.2, 9.6)).norm() < 1e-12);
    (void)omega.tick(Vec3(3, 4, 0));
    CHECK(omega.motors() == Vec3(0, 3, 4));
}

TEST_CASE("an omega plays no force that is no number", "[devices][force-dimension]") {
    StubbedOmega omega;
    (void)omega.tick(Vec3(1, 0, 0));
    (void)omega.tick(Vec3(std::nan(""), 0, 0));
    CHECK(omega.motors() == Vec3::Zero());
    (void)omega.tick(Vec3(0, INFINITY, 0));
    CHECK(omega.motors() == Vec3::Zero());
}

TEST_CASE("an omega's force that no servo renews is gone after 70 ticks",
          "[devices][force-dimension]") {
    StubbedOmega omega;
    omega.device().write(Vec3(1, 0, 0));

    omega.stub.step(1 + FadingForce::stale_ticks);
    CHECK(omega.motors().y() == 1);
    omega.stub.step(FadingForce::fade_ticks / 2);
    CHECK(omega.motors().y() == Approx(0.5));
    omega.stub.step(FadingForce::fade_ticks / 2);
    CHECK(omega.motors() == Vec3::Zero());
    (void)omega.tick(Vec3(0, 1, 0));
    CHECK(omega.motors() == Vec3(0, 0, 1));
}

TEST_CASE("a tick of an omega that fails has no reading and no force",
          "[devices][force-dimension]") {
    StubbedOmega omega;
    (void)omega.tick(Vec3(1, 0, 0));
    omega.stub.fail(1);
    CHECK_FALSE(omega.tick(Vec3(1, 0, 0)).valid);
    CHECK(omega.motors() == Vec3::Zero());
    CHECK(omega.tick(Vec3(1, 0, 0)).valid);
    CHECK(omega.motors() == Vec3(0, 1, 0));
    CHECK(omega.stub.devices_opened() == 1);
}

TEST_CASE("an omega that is lost is opened again by itself", "[devices][force-dimension]") {
    StubbedOmega omega;
    (void)omega.tick(Vec3(0.5, 0, 0), 3);

    omega.stub.plug(false);
    for (int i = 0; i < ForceDimension::lost_ticks; ++i) {
        CHECK(omega.stub.is_open());
        CHECK_FALSE(omega.tick(Vec3(0.5, 0, 0)).valid);
    }
    CHECK_FALSE(omega.stub.is_open());
    CHECK(omega.motors() == Vec3::Zero());
    test::wait_until([&] { return !omega.device().status().empty(); }, "the loss");
    CHECK_THAT(std::string(omega.device().status()), Catch::Contains("does not answer"));

    omega.stub.plug(true);
    DeviceReading reading;
    test::wait_until([&] { return (reading = omega.tick(Vec3::Zero())).valid; }, "the device");
    CHECK(omega.stub.devices_opened() == 2);
    CHECK(omega.stub.is_force_enabled());
    CHECK(omega.stub.is_gravity_compensated());
    CHECK(omega.device().status().empty());
    (void)omega.tick(Vec3(0.5, 0, 0));
    CHECK(omega.motors() == Vec3(0, 0.5, 0));
}

TEST_CASE("an omega that returns without its calibration is not believed from its first tick on",
          "[devices][force-dimension]") {
    StubbedOmega omega;
    (void)omega.tick(Vec3(0.5, 0, 0), 3);
    omega.stub.plug(false);
    (void)omega.tick(Vec3::Zero(), ForceDimension::lost_ticks);
    test::wait_until([&] { return !omega.device().status().empty(); }, "the loss");

    omega.stub.need_calibration(true);
    omega.stub.plug(true);
    const auto is_back = [&] {
        const DeviceReading reading = omega.tick(Vec3(0.5, 0, 0));
        CHECK_FALSE(reading.valid);
        CHECK(omega.motors() == Vec3::Zero());
        return omega.stub.devices_opened() == 2;
    };
    test::wait_until(is_back, "the device");
    for (int i = 0; i < ForceDimension::status_ticks; ++i) CHECK(is_back());
    CHECK_THAT(std::string(omega.device().status()), Catch::Contains("calibration"));
    omega.stub.need_calibration(false);
    CHECK(omega.tick(Vec3(0.5, 0, 0), ForceDimension::status_ticks + 1).valid);
    CHECK(omega.motors() == Vec3(0, 0.5, 0));
}

TEST_CASE("closing does not wait for an omega that is away", "[devices][force-dimension]") {
    StubbedOmega omega;
    omega.stub.plug(false);
    (void)omega.tick(Vec3::Zero(), ForceDimension::lost_ticks);
    omega.close();
    CHECK_FALSE(omega.stub.is_open());
}

TEST_CASE("an omega that let go gets its force back after a pause", "[devices][force-dimension]") {
    constexpr int too_fast = 2;
    StubbedOmega omega;
    (void)omega.tick(Vec3(0.5, 0, 0), 3);

    omega.stub.switch_off(too_fast);
    DeviceReading reading = omega.tick(Vec3(0.5, 0, 0), ForceDimension::status_ticks);
    CHECK(reading.valid);
    CHECK(reading.trouble == DeviceTrouble::ForceRefused);
    CHECK_THAT(std::string(omega.device().status()), Catch::Contains("switched the force off"));
    int without = 0;
    for (; omega.motors() == Vec3::Zero() && without < 5000; ++without)
        reading = omega.tick(Vec3(0.5, 0, 0));

    CHECK(without >= ForceDimension::refused_ticks - ForceDimension::status_ticks);
    CHECK(without <= ForceDimension::refused_ticks + 2 * ForceDimension::status_ticks);
    CHECK(omega.tick(Vec3::Zero()).trouble == DeviceTrouble::None);
    CHECK(omega.device().status().empty());
}

TEST_CASE("an omega that its button switched off waits for the button",
          "[devices][force-dimension]") {
    StubbedOmega omega;
    omega.stub.switch_off(dhd::off_by_button);

    CHECK(omega.tick(Vec3(0.5, 0, 0), 3000).trouble == DeviceTrouble::ForceRefused);
    CHECK(omega.motors() == Vec3::Zero());
    CHECK_THAT(std::string(omega.device().status()), Catch::Contains("force button"));

    omega.stub.press_force_button();
    (void)omega.tick(Vec3(0.5, 0, 0), ForceDimension::status_ticks + 1);
    CHECK(omega.motors() == Vec3(0, 0.5, 0));
    CHECK(omega.device().status().empty());
}

TEST_CASE("a device that waits for its calibration has no reading and no force",
          "[devices][force-dimension]") {
    StubbedOmega omega(dhd::falcon, true);
    const DeviceCheck& check = dhd_check_of(omega.opened, "calibration");
    CHECK(check.outcome == CheckOutcome::Failed);
    CHECK_THAT(check.remedy, Catch::Contains("Falcon"));

    CHECK_FALSE(omega.tick(Vec3(1, 0, 0), 100).valid);
    CHECK(omega.motors() == Vec3::Zero());
    CHECK_THAT(std::string(omega.device().status()), Catch::Contains("calibration"));

    omega.stub.need_calibration(false);
    CHECK(omega.tick(Vec3(1, 0, 0), ForceDimension::status_ticks + 1).valid);
    CHECK(omega.motors() == Vec3(0, 1, 0));
}

TEST_CASE("without an omega the report names the layer that failed, and a remedy",
          "[devices][force-dimension]") {
    ForceDimensionStub& stub = test::load_force_dimension_stub();
    std::string library = PALPA_FORCE_DIMENSION_STUB, layer, told, remedy;
    SECTION("no library") {
        library = "/nowhere/libdhd.so.3";
        layer = "library";
        told = "/nowhere/libdhd.so.3";
        remedy = "forcedimension.com";
    }
    SECTION("a library that lacks a function") {
        library = PALPA_FORCE_DIMENSION_STUB_LACKING;
        layer = "symbols";
        told = "dhdSetForce";
        remedy = "newer";
    }
    SECTION("nothing plugged in") {
        stub.plug(false);
        layer = "init";
        told = "no device found";
        remedy = "power and cable";
    }
    const OpenedDevice opened = open_dhd_stub(library);

    CHECK_FALSE(opened.device);
    CHECK(opened.checks.back().layer == layer);
    CHECK(opened.checks.back().outcome == CheckOutcome::Failed);
    CHECK_THAT(opened.checks.back().found, Catch::Contains(told));
    CHECK_THAT(opened.checks.back().remedy, Catch::Contains(remedy));
    CHECK(stub.devices_opened() == 0);
}

TEST_CASE("an omega that is plugged in is reported with the library that is missing",
          "[devices][force-dimension]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path device = folder.path() / "sys/bus/usb/devices/1-2";
    std::filesystem::create_directories(device);
    std::filesystem::create_directories(folder.path() / "dev/bus/usb/001");
    for (const auto& [name, text] : {std::pair{"idVendor", "1451\n"},
                                     {"idProduct", "0402\n"},
                                     {"busnum", "1\n"},
                                     {"devnum", "7\n"}})
        (void)folder.add_file(std::string("sys/bus/usb/devices/1-2/") + name, text);
    DeviceRequest request;
    request.system_root = folder.path();
    const auto open = [&] {
        return open_force_dimension({.library = "/nowhere/libdhd.so.3"}, request);
    };

    CHECK(dhd_check_of(open(), "permission").outcome == CheckOutcome::Failed);  // no such node
    (void)folder.add_file("dev/bus/usb/001/007", "");
    const OpenedDevice opened = open();
    CHECK_FALSE(opened.device);
    CHECK_THAT(dhd_check_of(opened, "bus").found, Catch::Contains("1451:0402"));
    CHECK(dhd_check_of(opened, "permission").outcome == CheckOutcome::Ok);
    CHECK(opened.checks.back().layer == "library");
    CHECK(is_force_dimension_there(request));
    request.system_root = "/nowhere";
    CHECK_FALSE(is_force_dimension_there(request));
}

TEST_CASE("a second hand does not take the first one's omega", "[devices][force-dimension]") {
    StubbedOmega omega;
    const OpenedDevice second = open_dhd_stub();

    CHECK_FALSE(second.device);
    CHECK(second.checks.back().layer == "init");
    CHECK(omega.tick(Vec3(1, 0, 0)).valid);
}

TEST_CASE("closing an omega takes the force away first", "[devices][force-dimension]") {
    StubbedOmega omega;
    (void)omega.tick(Vec3(1, 0, 0), 5);
    REQUIRE(omega.motors() == Vec3(0, 1, 0));

    omega.close();

    CHECK_FALSE(omega.stub.is_open());
    CHECK_FALSE(omega.stub.is_force_enabled());
    CHECK(omega.motors() == Vec3::Zero());
}

TEST_CASE("20,000 poses of random bits give finite readings or none",
          "[devices][force-dimension]") {
    StubbedOmega omega(dhd::omega_6);
    std::uint64_t bits = 0x9e3779b97f4a7c15;
    double numbers[12];
    int believed = 0;

    for (int i = 0; i < 20'000; ++i) {
        for (double& number : numbers) {
            bits ^= bits << 13, bits ^= bits >> 7, bits ^= bits << 17;
            std::memcpy(&number, &bits, sizeof number);
        }
        omega.stub.report(numbers, numbers + 3);
        const DeviceReading reading = omega.tick(Vec3(0.1, 0, 0));
        believed += reading.valid ? 1 : 0;
        REQUIRE(reading.position_m.allFinite());
        REQUIRE(reading.orientation.coeffs().allFinite());
    }

    CHECK(believed == 0);
}
