// A pad that is only numbers, which the sound library offers for tests.
#include "sound/pad_rumble.h"

#include <catch2/catch.hpp>
#include <limits>

#define SDL_MAIN_HANDLED
#include <SDL.h>

using namespace palpa;

namespace {

// A pad with motors, as long as it lives.
struct VirtualPad {
    VirtualPad() {
        REQUIRE(SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) == 0);
        SDL_VirtualJoystickDesc pad{};
        pad.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
        pad.type = SDL_JOYSTICK_TYPE_GAMECONTROLLER;
        pad.naxes = SDL_CONTROLLER_AXIS_MAX;
        pad.nbuttons = SDL_CONTROLLER_BUTTON_MAX;
        pad.userdata = this;
        pad.Rumble = [](void* pad, std::uint16_t low, std::uint16_t high) {
            static_cast<VirtualPad*>(pad)->shakes = {low, high};
            return 0;
        };
        number = SDL_JoystickAttachVirtualEx(&pad);
        REQUIRE(number >= 0);
    }
    VirtualPad(const VirtualPad&) = delete;
    VirtualPad& operator=(const VirtualPad&) = delete;
    ~VirtualPad() {
        SDL_JoystickDetachVirtual(number);
        SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
    }

    int number = -1;
    Shake shakes;
};

}  // namespace

TEST_CASE("the light motor shakes with the force, the heavy one at a snap", "[sound]") {
    CHECK(shake_of(0, false) == Shake{0, 0});
    CHECK(shake_of(0.02, false) == Shake{0, 0});
    CHECK(shake_of(1.51, false) == Shake{0, 32768});  // half-way
    CHECK(shake_of(3, false) == Shake{0, 65535});
    CHECK(shake_of(30, true) == Shake{65535, 65535});
    CHECK(shake_of(std::numeric_limits<double>::quiet_NaN(), false) == Shake{0, 0});
}

TEST_CASE("a pad is found, shakes with the force and at each new snap, and stops at the end",
          "[sound]") {
    VirtualPad pad;
    {
        PadRumble rumble;
        REQUIRE(rumble.find());
        rumble.play(3, 5);  // five snaps before somebody listened
        CHECK(pad.shakes == Shake{0, 65535});
        rumble.play(0, 6);
        CHECK(pad.shakes.low == 65535);
        rumble.play(1, 6);
        CHECK(pad.shakes.high > 0);
    }
    CHECK(pad.shakes == Shake{0, 0});
}

TEST_CASE("without a pad nothing shakes, and nothing is wrong", "[sound]") {
    PadRumble rumble;
    if (SDL_NumJoysticks() == 0) CHECK_FALSE(rumble.find());
    rumble.play(1, 1);
}
