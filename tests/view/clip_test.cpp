#include "view/clip.h"

#include "render/renderer.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "tests/support/gpu.h"
#include "tests/support/held_scene.h"
#include "tests/support/paths.h"
#include "view/build_frame.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr std::uint32_t in_hand = 0, other = 1;

bool has(const FrameScene& frame, const glm::vec3& centre) {
    return std::ranges::any_of(frame.spheres,
                               [&](const SphereShape& s) { return s.centre == centre; });
}

}  // namespace

TEST_CASE("what stands in front of the molecule in hand is left out, nothing else",
          "[view][clip]") {
    const OrbitCamera camera{.distance = 20};  // looks along -z from (0, 0, 20)
    const glm::vec3 front(0.5F, 0, 5), behind(0, 0, -5), aside(6, 0, 5), at_eye(0, 0, 25);
    FrameScene frame;
    frame.spheres = {{{0, 0, 0}, 0.5F, glm::vec3(1), in_hand}};
    for (const glm::vec3& place : {front, behind, aside, at_eye}) {
        frame.spheres.push_back({place, 0.5F, glm::vec3(1), other});
    }
    frame.cones = {{front, aside, 0.1F, 0.1F, glm::vec3(1), glm::vec3(1), other},
                   {behind, aside, 0.1F, 0.1F, glm::vec3(1), glm::vec3(1), other},
                   {front, {0, 0, 4}, 0.1F, 0.1F, glm::vec3(1), glm::vec3(1), arrow_pick}};

    clip_in_front({0, 1}, camera, frame);

    CHECK(has(frame, {0, 0, 0}));
    CHECK_FALSE(has(frame, front));
    CHECK_FALSE(has(frame, at_eye));
    CHECK(has(frame, behind));
    CHECK(has(frame, aside));
    REQUIRE(frame.cones.size() == 2);
    CHECK(frame.cones[0].a == behind);
    CHECK(frame.cones[1].pick == arrow_pick);
}

TEST_CASE("the partner of a hydrogen bond stays with its bonds, an atom without bonds goes",
          "[view][clip]") {
    const OrbitCamera camera{.distance = 20};
    const glm::vec3 partner(0, 0, 3), next(0, 1, 4), beyond(0, 1, 5.5F);
    FrameScene frame;
    frame.spheres = {{{0, 0, 0}, 0.5F, glm::vec3(1), in_hand}};
    for (const glm::vec3& place : {partner, next, beyond}) {
        frame.spheres.push_back({place, 0.1F, glm::vec3(1), other});
    }
    const auto add = [&](const glm::vec3& a, const glm::vec3& b, std::uint32_t pick) {
        frame.cones.push_back({a, b, 0.1F, 0.1F, glm::vec3(1), glm::vec3(1), pick});
    };
    add(partner, next, other);
    add(next, beyond, other);

    SECTION("bonded") {
        add({0, 0, 0.6F}, {0, 0, 2.8F}, hydrogen_bond_pick);
        clip_in_front({0, 1}, camera, frame);
        CHECK(has(frame, partner));
        CHECK(has(frame, next));
        CHECK_FALSE(has(frame, beyond));
        CHECK(frame.cones.size() == 2);
    }
    SECTION("beside, with a bond to what is hidden") {
        frame.spheres[3].centre = {5, 0, 5.5F};
        frame.cones[1].b = {5, 0, 5.5F};
        clip_in_front({0, 1}, camera, frame);
        CHECK(frame.spheres.size() == 1);
        CHECK(frame.cones.empty());
    }
}

TEST_CASE("clipped, the inhibitor is seen whole in its pocket from any side", "[view][clip][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    const World world = test::protease_world();
    const AtomRange held = held_range(world, hand_at(world, 0));
    const auto representation =
        GENERATE(Representation::InHand, Representation::SpaceFilling, Representation::Pocket);
    const float azimuth = GENERATE(0.0F, 1.5F, 3.0F, 4.5F), elevation = GENERATE(-0.9F, 0.0F, 0.9F);
    FrameScene frame = build_frame(world, {.representation = representation});
    const FrameScene alone = [&] {
        FrameScene only = frame;
        std::erase_if(only.spheres, [&](const SphereShape& s) { return !has_atom(held, s.pick); });
        std::erase_if(only.cones, [&](const ConeShape& c) { return !has_atom(held, c.pick); });
        return only;
    }();
    OrbitCamera camera;
    orbit(camera, azimuth, elevation);
    frame_shapes(camera, alone.spheres, 1);
    clip_in_front(held, camera, frame);
    const auto pixels_in_hand = [&](FrameScene scene) {
        scene.camera = frame_camera(camera, frame);
        const Picture picture = renderer.draw(scene, 200, 200);
        return static_cast<double>(std::ranges::count_if(
            picture.picks, [&](std::uint32_t p) { return has_atom(held, p); }));
    };

    CHECK(pixels_in_hand(frame) > 0.95 * pixels_in_hand(alone));
    test::check_silent(device);
}
