#include "app/render_scale.h"

#include <catch2/catch.hpp>

using palpa::RenderScale;

namespace {

// A machine whose frames cost a fixed part and one per pixel, after that many of them.
double settled(double fixed_ms, double full_ms) {
    RenderScale scale;
    for (int frame = 0; frame < 2000; ++frame) {
        scale.add_frame(fixed_ms + full_ms * scale.value() * scale.value());
    }
    return fixed_ms + full_ms * scale.value() * scale.value();
}

}  // namespace

TEST_CASE("a quick machine draws at full size", "[app]") {
    RenderScale scale;
    for (int frame = 0; frame < 100; ++frame) scale.add_frame(5);
    CHECK(scale.value() == 1);
}

TEST_CASE("a slow machine draws smaller, until it shows thirty frames a second", "[app]") {
    const double full_ms = GENERATE(40.0, 80.0, 200.0);
    const double fixed_ms = GENERATE(0.0, 10.0);
    const double frame_ms = settled(fixed_ms, full_ms);
    CHECK(frame_ms < 1000.0 / 30);
    CHECK(frame_ms > 20);  // not smaller than need be
}

TEST_CASE("where the pixels are not what takes long, they are not given up", "[app]") {
    RenderScale scale;
    for (int frame = 0; frame < 400; ++frame) scale.add_frame(45 + 2 * scale.value());
    CHECK(scale.value() > 0.9);
}

TEST_CASE("a hopeless machine still shows something, a stutter changes nothing", "[app]") {
    RenderScale hopeless;
    for (int frame = 0; frame < 1000; ++frame) {
        hopeless.add_frame(5000 * hopeless.value() * hopeless.value());
    }
    CHECK(hopeless.value() == RenderScale::smallest);

    RenderScale steady;
    for (int frame = 0; frame < 200; ++frame) steady.add_frame(frame % 40 == 20 ? 60 : 8);
    CHECK(steady.value() == 1);
}
