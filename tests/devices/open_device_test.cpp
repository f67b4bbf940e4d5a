#include "devices/open_device.h"

#include "core/load_error.h"
#include "tests/support/load_error_of.h"
#include "tests/support/open_haptics_stub/load.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>

using namespace palpa;

TEST_CASE("devices have names of their own, and the first is always there",
          "[devices][open-device]") {
    std::set<std::string_view> names;
    for (const DeviceMaker& maker : device_makers()) {
        CHECK(names.insert(maker.name).second);
        CHECK_FALSE(maker.summary.empty());
        REQUIRE(maker.open);
    }

    CHECK(device_makers().front().name == "emulated");
    CHECK(device_makers().front().open({}).device);
    CHECK(open_device("emulated", {}).device->spec().name == "emulated Omni");
}

TEST_CASE("a name that is none is answered with those that are", "[devices][open-device]") {
    const std::string told = test::load_error_of([] { (void)open_device("omnni", {}); });

    CHECK_THAT(told, Catch::Contains("--device omnni"));
    CHECK_THAT(told, Catch::Contains("emulated, mouse, omni, "));
    CHECK_THAT(told, Catch::Contains("did you mean 'omni'"));
}

TEST_CASE("a device that plays a file names it, others name none", "[devices][open-device]") {
    const auto told = [](const std::string& name) {
        return test::load_error_of([&] { (void)open_device(name, {}); });
    };
    const test::TemporaryFolder folder;
    const auto good =
        folder.add_file("a:b.csv", "time_s,handle_x_m,handle_y_m,handle_z_m\n0,0.01,0,0\n");
    const auto bad =
        folder.add_file("bad.csv", "time_s,handle_x_m,handle_y_m,handle_z_m\n0,0.01,0,up\n");

    CHECK(open_device("script:" + good.string(), {}).device->read().position_m.x() == 0.01);
    CHECK_THAT(told("script"), Catch::Contains("expected script:FILE"));
    CHECK_THAT(told("replay:"), Catch::Contains("expected replay:FOLDER"));
    CHECK_THAT(told("mouse:x"), Catch::Contains("does not play a file; expected mouse alone"));
    CHECK_THAT(told("scrip:x"), Catch::Contains("did you mean 'script'"));
    CHECK_THAT(told("script:" + bad.string()), Catch::Contains("bad.csv:2: 'up' is not a number"));
    CHECK_THAT(told("replay:" + folder.path().string()), Catch::Contains("trace.csv"));
}

TEST_CASE("a device that cannot be opened says which layer failed and what mends it",
          "[devices][open-device]") {
    setenv("PALPA_OPENHAPTICS", PALPA_OPEN_HAPTICS_STUB_LACKING, 1);
    const std::string told = test::load_error_of([] { (void)open_device("omni", {}); });
    setenv("PALPA_OPENHAPTICS", PALPA_OPEN_HAPTICS_STUB, 1);
    (void)test::load_open_haptics_stub();
    const std::string name = open_device("omni", {}).device->spec().name;
    unsetenv("PALPA_OPENHAPTICS");

    CHECK_THAT(told, Catch::Contains("symbols: missing: hdUnschedule; install OpenHaptics"));
    CHECK(name == "emulated PHANTOM Omni");
}
