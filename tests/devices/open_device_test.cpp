#include "devices/open_device.h"

#include "core/load_error.h"
#include "tests/support/load_error_of.h"
#include "tests/support/open_haptics_stub/load.h"

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
    CHECK_THAT(told, Catch::Contains("emulated, mouse, omni"));
    CHECK_THAT(told, Catch::Contains("did you mean 'omni'"));
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
