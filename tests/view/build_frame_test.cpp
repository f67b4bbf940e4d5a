#include "view/build_frame.h"

#include "render/renderer.h"
#include "simulation/probe.h"
#include "tests/support/gpu.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>

using namespace palpa;

namespace {

constexpr std::uint32_t height = 270;
constexpr float aspect = 480.0F / 270;

}  // namespace

TEST_CASE("two waters are six spheres and four sticks, and an arrow along the force", "[view]") {
    Simulation simulation = load_simulation(test::water_scene());
    const double distance = GENERATE(2.5, 3.1);
    move_grabbed(simulation, distance);

    const FrameScene frame = build_frame(simulation, {}, aspect);

    CHECK(frame.spheres.size() == 6);
    REQUIRE(frame.cones.size() == 4 + 2);
    const ConeShape& shaft = frame.cones[4];
    const ConeShape& head = frame.cones[5];
    CHECK(head.pick == arrow_pick);
    // Pushed out at 2.5 Å, drawn in at 3.1.
    CHECK((head.b - shaft.a).x * (distance < 2.7 ? 1 : -1) > 0);
    CHECK(glm::length(glm::cross(head.b - shaft.a, {1, 0, 0})) < 1e-5);
    if (distance > 3) CHECK(glm::length(head.b - shaft.a) == Approx(5 * 0.322).epsilon(0.01));

    CHECK(build_frame(simulation, {Representation::SpaceFilling, false}, aspect).cones.empty());
    CHECK(build_frame(simulation, {Representation::Licorice, false}, aspect).cones.size() == 4);
}

TEST_CASE("every atom that nothing hides is seen at its centre, and all fit the picture",
          "[view][gpu]") {
    const auto representation = GENERATE(Representation::BallAndStick, Representation::SpaceFilling,
                                         Representation::Licorice);
    const float shape = GENERATE(as<float>{}, 480.0F / 270, 0.5F);
    const auto wide = static_cast<std::uint32_t>(static_cast<float>(height) * shape);
    GpuDevice device(test::validated());
    Renderer renderer(device);
    Simulation simulation = load_simulation(test::water_scene());
    const FrameScene frame = build_frame(simulation, {representation, false}, shape);

    const Picture picture = renderer.draw(frame, wide, height);

    int seen = 0;
    for (std::size_t i = 0; i < frame.spheres.size(); ++i) {
        const glm::vec3 there = project(frame.camera, frame.spheres[i].centre, wide, height);
        REQUIRE(there.x > 0);
        REQUIRE(there.x < static_cast<float>(wide));
        REQUIRE(there.y > 0);
        REQUIRE(there.y < static_cast<float>(height));
        const std::size_t at =
            static_cast<std::size_t>(there.y) * wide + static_cast<std::size_t>(there.x);
        // Whatever is seen there is the atom, or before its centre.
        const bool is_atom = picture.picks[at] == i;
        CHECK((is_atom || picture.depth[at] < there.z));
        if (is_atom) ++seen;
    }
    CHECK(seen >= 3);  // one hydrogen is behind its oxygen, and sticks as thick as atoms hide some
    // Nothing is cut off at the edges.
    for (std::uint32_t x = 0; x < wide; ++x) {
        REQUIRE(picture.picks[x] == Picture::nothing_seen);
        REQUIRE(picture.picks[std::size_t{wide} * (height - 1) + x] == Picture::nothing_seen);
    }
    test::check_silent(device);
}
