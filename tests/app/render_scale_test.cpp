#include "app/render_scale.h"

#include <catch2/catch.hpp>

using palpa::RenderScale;

namespace {

// What a frame costs: a part that is fixed, one per pixel, and one per pixel with effects.
struct Machine {
    double fixed_ms, pixels_ms, effects_ms;

    double frame_ms(const RenderScale& scale) const {
        const double pixels = scale.value() * scale.value();
        return fixed_ms + pixels * (pixels_ms + (scale.has_effects() ? effects_ms : 0));
    }
    void run(RenderScale& scale, int frames) const {
        for (int frame = 0; frame < frames; ++frame) scale.add_frame(frame_ms(scale));
    }
};

}  // namespace

TEST_CASE("a quick machine draws at full size with all effects", "[app]") {
    RenderScale scale;
    Machine{1, 3, 1}.run(scale, 100);
    CHECK(scale.value() == 1);
    CHECK(scale.has_effects());
}

TEST_CASE("where that is enough, a slow machine leaves out the effects and no pixels", "[app]") {
    const Machine machine{2, 22, 20};
    RenderScale scale;
    for (int frame = 0; frame < 2000; ++frame) {
        scale.add_frame(machine.frame_ms(scale));
        REQUIRE(scale.value() == 1);
    }
    CHECK_FALSE(scale.has_effects());
}

TEST_CASE("a slower machine draws fewer pixels too, until it shows thirty frames a second",
          "[app]") {
    const Machine machine{GENERATE(0.0, 10.0), GENERATE(35.0, 60.0, 75.0), GENERATE(1.0, 40.0)};
    RenderScale scale;
    machine.run(scale, 2000);
    CHECK(machine.frame_ms(scale) < 1000.0 / 30);
    CHECK(machine.frame_ms(scale) > 20);  // not less than need be
    CHECK_FALSE(scale.has_effects());
}

TEST_CASE("what a machine left out comes back when it is quick again", "[app]") {
    RenderScale scale;
    Machine{5, 60, 30}.run(scale, 1000);
    REQUIRE(scale.value() < 1);
    Machine{1, 4, 2}.run(scale, 1000);
    CHECK(scale.value() == 1);
    CHECK(scale.has_effects());
}

TEST_CASE("where the pixels are not what takes long, nothing is given up", "[app]") {
    const Machine machine{45, 1, 1};
    RenderScale scale;
    int full = 0;
    for (int frame = 0; frame < 2000; ++frame) {
        scale.add_frame(machine.frame_ms(scale));
        full += scale.value() == 1 && scale.has_effects() ? 1 : 0;
    }
    CHECK(full > 1800);  // now and then less is tried
}

TEST_CASE("half of the pixels either way are always drawn, a stutter changes nothing", "[app]") {
    RenderScale hopeless;
    Machine{0, 5000, 100}.run(hopeless, 1000);
    CHECK(hopeless.value() == 0.5);

    RenderScale steady;
    for (int frame = 0; frame < 200; ++frame) steady.add_frame(frame % 40 == 20 ? 60 : 8);
    CHECK(steady.value() == 1);
    CHECK(steady.has_effects());
}
