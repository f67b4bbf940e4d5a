#include "app/window_devices.h"

#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>

using namespace palpa;

TEST_CASE("a window begins with the mouse until a pad that was chosen is there",
          "[tools][preferences]") {
    const test::TemporaryFolder folder;
    PreferencesFile preferences(folder.add_file("p.toml", "device = \"gamepad\"\n"));
    EmulatedOmniSettings emulated;
    emulated.hand = hand_model(HandGrip::Medium);
    WindowDevices devices(emulated, preferences);

    const WindowDevice first = devices.open_first({});

    REQUIRE(first.device);
    CHECK(first.mouse_reach_m > 0);
    CHECK(devices.notice().empty());
    const DeviceMenu menu = devices.menu();
    CHECK(menu.current == "mouse");
    CHECK(menu.wanted == "gamepad");
    CHECK_FALSE(menu.is_there("gamepad"));
    devices.pads().is_there = true;
    CHECK(menu.is_there("gamepad"));
    CHECK(menu.open("gamepad").device->spec().name == "game pad");
}

TEST_CASE("a device that was chosen and is none is said", "[tools][preferences]") {
    const test::TemporaryFolder folder;
    PreferencesFile preferences(folder.add_file("p.toml", "device = \"omnibus\"\n"));
    EmulatedOmniSettings emulated;
    emulated.hand = hand_model(HandGrip::Medium);
    WindowDevices devices(emulated, preferences);

    const WindowDevice first = devices.open_first({});

    CHECK(first.device);
    CHECK_THAT(devices.notice(),
               Catch::Contains("expected one of") && Catch::Contains("until then: mouse"));
    CHECK(devices.menu().wanted.empty());
}
