#include "experiments/mouse_person.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

using namespace palpa;

TEST_CASE("a person at the mouse drags no faster and no longer than people do, and arrives",
          "[experiments][mouse]") {
    MousePerson person(GENERATE(1, 2, 3));
    const OrbitCamera camera;
    constexpr double frame_s = 1.0 / 30;
    const glm::vec3 goal(20, 5, -3);
    glm::vec3 ring(0);
    double dragged = 0, paused_s = 0;
    bool held = false;
    int lifts = 0;
    for (int frame = 0; frame < 3000; ++frame) {
        const MousePerson::Motion motion = person.act(camera, 720, ring, goal, frame_s);
        const double length = std::hypot(motion.right, motion.down);
        REQUIRE(length <= MousePerson::pixels_per_s * frame_s * (1 + 1e-5));
        if (held && !motion.holds) {
            ++lifts;
            CHECK(dragged >= MousePerson::longest_drag_pixels);
            CHECK(dragged <=
                  MousePerson::longest_drag_pixels + MousePerson::pixels_per_s * frame_s + 0.01);
        }
        if (!held && motion.holds && lifts > 0) CHECK(paused_s >= MousePerson::pause_s - 1e-9);
        if (!motion.holds) REQUIRE(length == 0);
        dragged = motion.holds ? (held ? dragged : 0) + length : dragged;
        paused_s = motion.holds ? 0 : paused_s + frame_s;
        held = motion.holds;
        ring += find_mouse_way(camera, ring, 720, motion.right, motion.down, motion.notches);
    }
    CHECK(lifts > 1);
    CHECK(glm::distance(ring, goal) < 0.4);  // a notch of the wheel is 0.25 Å
}
