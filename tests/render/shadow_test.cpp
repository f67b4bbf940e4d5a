// Shadows where geometry puts them.
#include "render/renderer.h"

#include "tests/render/meshes.h"
#include "tests/render/pixels.h"
#include "tests/support/gpu.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <numbers>

using namespace palpa;
using test::count, test::pixel_of;

namespace {

// A wall, and something 3 Å in front of it for the light from (-0.4, 0.6, 0.7) to fall on.
FrameScene wall_scene() {
    FrameScene scene;
    scene.occlusion = false;
    scene.outline = 0;
    scene.shadows = true;
    scene.camera.eye = {0, 0, 20};
    scene.meshes = {test::plane_mesh({0, 0, 0}, {6, 0, 0}, {0, 5, 0}, {0.5F, 0.5F, 0.5F}, 1)};
    return scene;
}
const glm::vec3 ahead(-1, 1.5F, 3), shadow(-1 + 3 * 0.4F / 0.7F, 1.5F - 3 * 0.6F / 0.7F, 0);
const double cosine = 0.7 / std::sqrt(0.4 * 0.4 + 0.6 * 0.6 + 0.7 * 0.7);

}  // namespace

TEST_CASE("a shadow falls where the light's ray through its thing meets the wall",
          "[render][shadow][gpu]") {
    GpuDevice device(test::validated(GENERATE(false, true)));
    Renderer renderer(device);
    FrameScene scene = wall_scene();
    const int kind = GENERATE(0, 1, 2);
    if (kind == 0) scene.spheres = {{ahead, 0.8F, {1, 0, 0}, 2}};
    if (kind == 1) {
        const glm::vec3 along(0.8F, 0, 0);
        scene.cones = {{ahead - along, ahead + along, 0.8F, 0.8F, {1, 0, 0}, {1, 0, 0}, 2}};
    }
    if (kind == 2) scene.meshes.push_back(test::sphere_mesh(ahead, 0.8F, {1, 0, 0}, 2, 24));

    const Picture picture = renderer.draw(scene, test::width, test::height);
    scene.shadows = false;
    const Picture without = renderer.draw(scene, test::width, test::height);

    CHECK(picture.picks == without.picks);
    const std::size_t middle = pixel_of(scene.camera, shadow);
    REQUIRE(picture.picks[middle] == 1);
    CHECK(std::abs(picture.rgba[4 * middle] - 255 * test::encoded(0.5 * 0.35)) < 2);
    // Some way out the wall is as it is without, on all sides.
    for (const glm::vec3& aside :
         {glm::vec3(3, 0, 0), glm::vec3(0, 2.5F, 0), glm::vec3(0, -2, 0)}) {
        const std::size_t at = pixel_of(scene.camera, shadow + aside);
        REQUIRE(picture.picks[at] == 1);
        CHECK(picture.rgba[4 * at] == without.rgba[4 * at]);
    }
    test::check_silent(device);
}

TEST_CASE("a ball's shadow is an ellipse with soft edges", "[render][shadow][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene = wall_scene();
    scene.spheres = {{ahead, 0.8F, {1, 0, 0}, 2}};

    const Picture picture = renderer.draw(scene, test::width, test::height);
    scene.shadows = false;
    const Picture without = renderer.draw(scene, test::width, test::height);

    // All that is missing of the light on the wall, in whole shadows: pi r^2 / cosine, and larger
    // as the lamp is not infinitely far: ten times half the diagonal of all that is in the scene.
    double missing = 0, in_between = 0;
    for (std::size_t i = 0; i < picture.picks.size(); ++i) {
        if (picture.picks[i] != 1) continue;
        const double with = test::decoded(picture.rgba[4 * i] / 255.0),
                     full = test::decoded(without.rgba[4 * i] / 255.0);
        const double share = (full - with) / (full - 0.5 * 0.35);
        missing += share;
        in_between += share > 0.1 && share < 0.9 ? 1 : 0;
    }
    const double pixels = 120 / std::tan(0.3) / 20;  // of an angstrom
    const double lamp = 10 * 0.5 * std::sqrt(12 * 12 + 10 * 10 + 3.8 * 3.8),
                 growth = lamp / (lamp - 3 / cosine);
    const double area = std::numbers::pi * 0.8 * 0.8 * growth * growth / cosine * pixels * pixels;
    CHECK(missing == Approx(area).epsilon(0.03));
    CHECK(in_between > 0.2 * area);
    test::check_silent(device);
}

TEST_CASE("what is convex, translucent or on top casts no shadow, on itself or others",
          "[render][shadow][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene = wall_scene();
    scene.spheres = {{ahead, 0.8F, {1, 0, 0}, 2, true}};
    scene.meshes.push_back(test::sphere_mesh(ahead + glm::vec3(2, 0, 0), 0.8F, {0, 1, 0}, 3, 24));
    scene.meshes.back().opacity = 0.5F;
    const Picture picture = renderer.draw(scene, test::width, test::height);
    scene.shadows = false;
    CHECK(picture.rgba == renderer.draw(scene, test::width, test::height).rgba);

    scene.meshes.clear();
    scene.spheres = {{{0, 0, 0}, GENERATE(1.0F, 3.0F), {0.7F, 0.7F, 0.7F}, 2}};
    const Picture bare = renderer.draw(scene, test::width, test::height);
    scene.shadows = true;
    const Picture ball = renderer.draw(scene, test::width, test::height);
    std::size_t darker = 0;
    for (std::size_t i = 0; i < ball.picks.size(); ++i) {
        darker += ball.rgba[4 * i] + 3 < bare.rgba[4 * i] ? 1 : 0;
    }
    // Only where light hardly reaches, at the shadow's own edge on the ball.
    CHECK(static_cast<double>(darker) < 0.02 * static_cast<double>(count(ball, 2)));
    test::check_silent(device);
}

TEST_CASE("nothing at all can be drawn with shadows", "[render][shadow][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.shadows = true;
    CHECK(count(renderer.draw(scene, 64, 48), Picture::nothing_seen) == 64 * 48);
    test::check_silent(device);
}
