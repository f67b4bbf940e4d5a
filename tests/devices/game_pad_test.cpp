#include "devices/game_pad.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace palpa;
using Catch::Matchers::WithinAbs;

namespace {

struct Pad {
    // So many ticks with the sticks like that, posted as often as a window of 50 Hz does.
    DeviceReading push(const PadInput& input, int ticks) {
        DeviceReading reading;
        for (int i = 0; i < ticks; ++i) {
            if (i % 20 == 0) link.inputs.post(input);
            link.is_there = input.is_there;
            reading = pad.read();
            pad.write(Vec3(1, 2, 3));
        }
        return reading;
    }

    PadLink link;
    GamePad pad{link};
};

}  // namespace

TEST_CASE("a pad's sticks lead its handle right, up and towards the person", "[devices][pad]") {
    Pad pad;

    CHECK(pad.push({.is_there = true, .left_x = 1}, 100).valid);
    const Vec3 right = pad.pad.read().position_m;
    const Vec3 up = pad.push({.is_there = true, .left_y = -1}, 100).position_m - right;
    const Vec3 near = pad.push({.is_there = true, .right_y = 1}, 100).position_m - right - up;

    // 60 mm/s for 0.1 s, but for the tick in between.
    CHECK((right - Vec3(0.006, 0, 0)).norm() < 7e-5);
    CHECK((up - Vec3(0, 0.006, 0)).norm() < 7e-5);
    CHECK((near - Vec3(0, 0, 0.006)).norm() < 7e-5);
}

TEST_CASE("a stick turns the handle about the upright, to the right as seen from above",
          "[devices][pad]") {
    Pad pad;

    const Quat turned = pad.push({.is_there = true, .right_x = 1}, 500).orientation;

    CHECK((rotation_vector_of(turned) - Vec3(0, -0.8, 0)).norm() < 1e-9);
}

TEST_CASE("sticks in the middle, or no numbers, lead nowhere", "[devices][pad]") {
    Pad pad;
    const double stick = GENERATE(0.0, 0.1, -0.1, std::numeric_limits<double>::quiet_NaN());

    const DeviceReading reading = pad.push(
        {.is_there = true, .left_x = stick, .left_y = stick, .right_x = stick, .right_y = stick},
        100);

    CHECK(reading.valid);
    CHECK(reading.position_m == Vec3::Zero());
}

TEST_CASE("the clutch takes a pad's handle back to the middle", "[devices][pad]") {
    Pad pad;
    (void)pad.push({.is_there = true, .left_x = 1}, 500);

    const DeviceReading reading = pad.push({.is_there = true, .left_x = 1, .clutch = true}, 500);

    CHECK(is_pressed(reading.buttons, Button::Clutch));
    CHECK(reading.position_m.norm() < 1e-12);
}

TEST_CASE("a pad that is unplugged is told, and its sticks count as let go", "[devices][pad]") {
    Pad pad;
    CHECK_FALSE(pad.pad.read().valid);
    CHECK(pad.pad.status().starts_with("No game pad"));
    CHECK(pad.pad.status().ends_with('.'));

    const double there = pad.push({.is_there = true, .left_x = 1}, 200).position_m.x();
    CHECK(pad.pad.status().empty());
    const DeviceReading gone = pad.push({.is_there = false, .left_x = 1}, 200);
    CHECK_FALSE(gone.valid);
    CHECK(gone.position_m.x() == there);
    CHECK_FALSE(pad.pad.status().empty());
}

TEST_CASE("a window that hangs does not lead the handle on", "[devices][pad]") {
    Pad pad;
    (void)pad.push({.is_there = true, .left_x = 0.5}, 20);

    for (int i = 0; i < 300; ++i) (void)pad.pad.read();
    const Vec3 there = pad.pad.read().position_m;
    for (int i = 0; i < 300; ++i) (void)pad.pad.read();

    CHECK(pad.pad.read().position_m == there);
    CHECK(pad.pad.read().valid);
}

TEST_CASE("without a window a pad says so", "[devices][pad]") {
    const OpenedDevice opened = open_game_pad({});

    CHECK_FALSE(opened.device);
    CHECK(opened.checks.back().found == "only the window sees game pads");
}
