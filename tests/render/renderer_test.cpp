// Facts that any right picture shows, whatever its colours: what is seen where, and how far away.
#include "render/renderer.h"

#include "tests/render/pixels.h"
#include "tests/support/gpu.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

using namespace palpa;

using test::count, test::height, test::pixel_of, test::width;

TEST_CASE("a sphere is seen at its centre, as near as its front", "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.camera.eye = {1, 2, 12};
    scene.camera.target = {1, 1, 0};
    scene.spheres = {{{0, 0, 0}, 1.5F, {1, 0, 0}, 7}, {{3, 1, -2}, 1, {0, 1, 0}, 8}};

    const Picture picture = renderer.draw(scene, width, height);

    for (const SphereShape& sphere : scene.spheres) {
        const std::size_t at = pixel_of(scene.camera, sphere.centre);
        CHECK(picture.picks[at] == sphere.pick);
        const glm::vec3 ray = sphere.centre - scene.camera.eye;
        const float front = glm::length(ray) - sphere.radius;
        // Along the axis of the camera, as depth is told.
        const float cosine =
            glm::dot(glm::normalize(ray), glm::normalize(scene.camera.target - scene.camera.eye));
        CHECK(picture.depth[at] == Approx(front * cosine).epsilon(0.002));
    }
    CHECK(picture.picks[0] == Picture::nothing_seen);
    CHECK(std::isinf(picture.depth[0]));
    test::check_silent(device);
}

TEST_CASE("a picture's middle can be moved, and what is seen moves with it", "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.camera.eye = {0, 0, 12};
    scene.camera.centre = {0.5F, -0.25F};
    scene.spheres = {{{0, 0, 0}, 0.5F, {1, 0, 0}, 7}};
    scene.cones = {{{-1, 1, 0}, {-2, 1, 0}, 0.2F, 0.2F, {1, 1, 1}, {1, 1, 1}, 8}};

    const Picture picture = renderer.draw(scene, width, height);

    // Half of the half width to the right, a quarter of the half height down.
    const auto pick_at = [&](double x, double y) {
        return picture.picks[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)];
    };
    CHECK(pick_at(160 + 80, 120 + 30) == 7);
    CHECK(pick_at(160, 120) == Picture::nothing_seen);
    CHECK(picture.depth[150 * width + 240] == Approx(11.5).epsilon(0.001));
    const double pixels_per_angstrom = 120 / std::tan(0.3) / 12;
    CHECK(pick_at(240 - 1.5 * pixels_per_angstrom, 150 - pixels_per_angstrom) == 8);
    const glm::vec3 there = project(scene.camera, {-1.5F, 1, 0}, width, height);
    CHECK(there.x == Approx(240 - 1.5 * pixels_per_angstrom));
    CHECK(there.y == Approx(150 - pixels_per_angstrom));
    test::check_silent(device);
}

TEST_CASE("a sphere's outline is as large as perspective makes it", "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.camera.eye = {0, 0, 10};
    scene.spheres = {{{0, 0, 0}, 2, {1, 1, 1}, 1}};

    const Picture picture = renderer.draw(scene, width, height);

    // Seen under the angle asin(r/d), on a plane of height/2 per tan(angle/2).
    const double radius = std::tan(std::asin(2.0 / 10)) / std::tan(0.3) * height / 2;
    CHECK(static_cast<double>(count(picture, 1)) ==
          Approx(std::numbers::pi * radius * radius).epsilon(0.01));
}

TEST_CASE("what is nearer hides what is behind it, sphere and cone alike", "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.spheres = {{{0, 0, -3}, 1, {1, 0, 0}, 1}, {{0, 0, 2}, 0.5F, {0, 1, 0}, 2}};
    scene.cones = {{{-3, 0, 0}, {3, 0, 0}, 0.4F, 0.4F, {0, 0, 1}, {0, 0, 1}, 3}};

    const Picture picture = renderer.draw(scene, width, height);

    CHECK(picture.picks[pixel_of(scene.camera, {0, 0, 2})] == 2);
    CHECK(picture.picks[pixel_of(scene.camera, {1.5F, 0, 0})] == 3);
    CHECK(picture.depth[pixel_of(scene.camera, {1.5F, 0, 0})] == Approx(10 - 0.4).epsilon(0.01));
    CHECK(picture.picks[pixel_of(scene.camera, {0, 0.9F, -3})] == 1);
    test::check_silent(device);
}

TEST_CASE("a cylinder covers what it covers from every side, a cone comes to its point",
          "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    const glm::vec3 axis =
        GENERATE(glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::normalize(glm::vec3(1, 1, 1)),
                 glm::normalize(glm::vec3(-1, 0.5F, 1)));
    FrameScene scene;
    scene.cones = {{-1.5F * axis, 1.5F * axis, 0.3F, 0.3F, {1, 0, 0}, {0, 1, 0}, 1}};

    const Picture cylinder = renderer.draw(scene, width, height);
    scene.cones[0].radius_b = 0.001F;
    const Picture cone = renderer.draw(scene, width, height);

    for (const float along : {-1.3F, -0.5F, 0.2F, 1.0F}) {
        const std::size_t at = pixel_of(scene.camera, along * axis);
        CHECK(cylinder.picks[at] == 1);
        CHECK(cone.picks[at] == 1);
    }
    CHECK(cylinder.picks[pixel_of(scene.camera, 2.1F * axis)] == Picture::nothing_seen);
    CHECK(static_cast<double>(count(cone, 1)) < 0.75 * static_cast<double>(count(cylinder, 1)));
    test::check_silent(device);
}

TEST_CASE("forced staging draws the same picture to the bit", "[render][gpu]") {
    FrameScene scene;
    for (int i = 0; i < 50; ++i) {
        scene.spheres.push_back({{std::sin(i), std::cos(1.7 * i), 0.1F * static_cast<float>(i)},
                                 0.4F,
                                 {0.5F, 0.5F, 0.5F},
                                 static_cast<std::uint32_t>(i)});
    }
    GpuDevice direct(test::validated(false)), staged(test::validated(true));

    const Picture a = Renderer(direct).draw(scene, width, height);
    const Picture b = Renderer(staged).draw(scene, width, height);

    CHECK(a.rgba == b.rgba);
    CHECK(a.picks == b.picks);
    test::check_silent(staged);
}

TEST_CASE("a crease is darker than an open surface, an outline darker than both", "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.camera.eye = {0, 0, 14};
    // Two spheres that touch, and one far behind them.
    scene.spheres = {{{-1, 0, 0}, 1, {0.6F, 0.6F, 0.6F}, 1},
                     {{1, 0, 0}, 1, {0.6F, 0.6F, 0.6F}, 2},
                     {{0, 2.2F, -6}, 3, {0.6F, 0.6F, 0.6F}, 3}};
    const auto brightness = [&](const Picture& picture, const glm::vec3& place) {
        return picture.rgba[4 * pixel_of(scene.camera, place)];
    };
    const glm::vec3 crease(-0.12F, -0.1F, 0.45F);
    const Picture both = renderer.draw(scene, width, height);
    scene.spheres[1].centre.y = -50;  // out of the way
    const Picture alone = renderer.draw(scene, width, height);

    CHECK(brightness(both, crease) + 10 < brightness(alone, crease));
    // Just outside of the near sphere, on the far one.
    const glm::vec3 edge(-1, 1.04F, 0);
    REQUIRE(alone.picks[pixel_of(scene.camera, edge)] == 3);
    CHECK(brightness(alone, edge) < 60);
    CHECK(brightness(alone, {0, 2.4F, -3}) > 100);
    test::check_silent(device);
}

TEST_CASE("what is on top is hidden by nothing else, and in order among itself", "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    const glm::vec3 grey(0.5F);
    const bool is_on_top = GENERATE(false, true);
    scene.spheres = {{{0, 0, -3}, 0.5F, grey, 1, is_on_top},
                     {{0, 0, -5}, 1, grey, 2, is_on_top},
                     {{0, 0, 0}, 2, grey, 3}};
    scene.cones = {{{-1, 1.2F, -3}, {1, 1.2F, -3}, 0.2F, 0.2F, grey, grey, 4, is_on_top},
                   {{-1, 1.2F, 2}, {1, 1.2F, 2}, 0.2F, 0.2F, grey, grey, 5}};
    scene.camera.far = 40;

    const Picture picture = renderer.draw(scene, width, height);

    const std::size_t middle = pixel_of(scene.camera, {0, 0, 0});
    CHECK(picture.picks[middle] == (is_on_top ? 1 : 3));
    CHECK(picture.depth[middle] == Approx(is_on_top ? 12.5 : 8).margin(0.02));
    const std::size_t stick = pixel_of(scene.camera, {0, 1.2F, -3});
    CHECK(picture.picks[stick] == (is_on_top ? 4 : 3));
    CHECK(picture.picks[pixel_of(scene.camera, {0, 1.2F, 2})] == 5);
    test::check_silent(device);
}

TEST_CASE("an empty scene is its background, a camera inside a sphere sees past it",
          "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.background = {0, 0, 1};
    CHECK(renderer.draw(scene, 4, 4).rgba[2] == 255);

    scene.spheres = {{scene.camera.eye, 1, {1, 1, 1}, 5}};
    CHECK(count(renderer.draw(scene, width, height), 5) == 0);
    test::check_silent(device);
}

TEST_CASE("a size of nothing or beyond the device is refused in a sentence", "[render][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    const FrameScene scene;

    CHECK_THROWS_AS(renderer.draw(scene, 0, 10), GpuError);
    CHECK_THROWS_AS(renderer.draw(scene, 10, 0), GpuError);
    CHECK_THROWS_WITH(renderer.check_size({1'000'000, 10}),
                      Catch::Matchers::Contains("a picture of 1000000x10; expected 1x1 to"));
    test::check_silent(device);
}

TEST_CASE("what stays from frame to frame shows the newest scene and size, and picks from it",
          "[render][gpu]") {
    GpuDevice device(test::validated(GENERATE(false, true)));
    Renderer renderer(device);
    FrameScene scene;
    const auto fresh = [&](std::uint32_t wide, std::uint32_t high) {
        return Renderer(device).draw(scene, wide, high).rgba;
    };
    scene.spheres = {{{0, 0, 0}, 1, {1, 0, 0}, 7}};

    CHECK(renderer.draw(scene, 64, 48).rgba == fresh(64, 48));
    CHECK(renderer.pick(32, 24) == 7);
    for (int i = 1; i < 40; ++i) {  // more than the buffers had room for
        scene.spheres.push_back({{0.1F * static_cast<float>(i), 0, 0}, 1, {0, 1, 0}, 8});
        scene.cones.push_back({{0, 0, 0}, {0, 0.1F * static_cast<float>(i), 2}, 0.4F, 0.2F});
    }
    CHECK(renderer.draw(scene, 64, 48).rgba == fresh(64, 48));
    CHECK(renderer.draw(scene, 32, 80).rgba == fresh(32, 80));
    scene.cones.clear();
    scene.spheres.resize(1);
    const Picture colours = renderer.draw(scene, 64, 48, PictureContent::Colours);
    CHECK(colours.rgba == fresh(64, 48));
    CHECK(colours.picks.empty());
    CHECK(renderer.pick(32, 24) == 7);
    CHECK(renderer.pick(0, 0) == Picture::nothing_seen);
    CHECK(renderer.pick(64, 24) == Picture::nothing_seen);
    test::check_silent(device);
}
