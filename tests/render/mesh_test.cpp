// Opaque meshes against impostors and closed formulas.
#include "render/renderer.h"

#include "tests/render/meshes.h"
#include "tests/render/pixels.h"
#include "tests/support/gpu.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <numbers>

using namespace palpa;

using test::count, test::height, test::pixel_of, test::width;

TEST_CASE("a tessellated sphere looks like the sphere", "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.outline = 0;
    scene.camera.centre = {0.2F, -0.1F};
    scene.camera.eye = {3, 2, 9};
    const glm::vec3 centre(0.3F, 0.2F, -0.5F), colour(0.8F, 0.4F, 0.1F);
    constexpr std::uint32_t rings = 64;
    scene.spheres = {{centre, 2, colour, 7}};
    const Picture exact = renderer.draw(scene, width, height);
    scene.spheres.clear();
    scene.meshes = {test::sphere_mesh(centre, 2, colour, 7, rings)};
    scene.meshes[0].is_closed = GENERATE(false, true);

    const Picture mesh = renderer.draw(scene, width, height);

    // A chord of the angle a lies within r (1 - cos(a / 2)) of its arc; triangles have one such
    // angle each way. Seen under the cosine c that is 1/c of it: where c may be less than 0.3, at
    // the rim, only pixels are compared.
    const double sag = 2 * 2 * (1 - std::cos(std::numbers::pi / rings / 2));
    const double pixels = static_cast<double>(count(exact, 7));
    CHECK(static_cast<double>(count(mesh, 7)) == Approx(pixels).epsilon(0.005));
    std::size_t compared = 0, unlike = 0;
    for (std::size_t i = 0; i < exact.picks.size(); ++i) {
        if (exact.picks[i] != 7 || mesh.picks[i] != 7) continue;
        const bool is_rim = exact.depth[i] > glm::length(scene.camera.eye - centre) - 1;
        if (is_rim) continue;
        ++compared;
        REQUIRE(std::abs(mesh.depth[i] - exact.depth[i]) < sag / 0.3);
        for (std::size_t c = 0; c < 3; ++c) {
            unlike += std::abs(int{mesh.rgba[4 * i + c]} - int{exact.rgba[4 * i + c]}) > 4 ? 1 : 0;
        }
    }
    CHECK(static_cast<double>(compared) > 0.5 * pixels);
    CHECK(unlike == 0);
    test::check_silent(device);
}

TEST_CASE("spheres, cones and triangles hide each other by depth, and are picked each as itself",
          "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    const glm::vec3 grey(0.5F);
    scene.spheres = {{{-1.5F, 0, 0}, 0.5F, grey, 1}, {{0, 1.5F, 0}, 0.2F, grey, 6, true}};
    scene.cones = {{{1, 0, -1}, {2, 0, -1}, 0.3F, 0.3F, grey, grey, 2}};
    scene.meshes = {test::plane_mesh({0, 0, 0.2F}, {2, 0, 0}, {0, 2, 0}, grey, 3),
                    test::sphere_mesh({1.5F, -1, 0}, 0.7F, grey, 4, 16)};
    // A triangle is picked as its first corner.
    scene.meshes[0].vertices[2].pick = scene.meshes[0].vertices[3].pick = 99;

    const Picture picture = renderer.draw(scene, width, height);

    const auto pick_at = [&](const glm::vec3& place) {
        return picture.picks[pixel_of(scene.camera, place)];
    };
    CHECK(pick_at({-1.5F, 0, 0.5F}) == 1);
    CHECK(pick_at({1.5F, 0, 0}) == 3);
    CHECK(pick_at({1.5F, -1, 0.7F}) == 4);
    CHECK(pick_at({0, 1.5F, 0}) == 6);  // on top
    CHECK(count(picture, 99) == 0);
    CHECK(picture.depth[pixel_of(scene.camera, {0.5F, 0.3F, 0.2F})] == Approx(9.8F).margin(1e-4));
    const glm::vec3 there = project(scene.camera, {1.5F, -1, 0.7F}, width, height);
    CHECK(renderer.pick(static_cast<std::uint32_t>(there.x), static_cast<std::uint32_t>(there.y)) ==
          4);
    test::check_silent(device);
}

TEST_CASE("a surface is lit on both sides, by the light from the camera's upper left",
          "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.occlusion = false;
    const bool is_turned = GENERATE(false, true);
    scene.meshes = {test::plane_mesh({0, 0, 0}, {is_turned ? -1.0F : 1.0F, 0, 0}, {0, 1, 0},
                                     {0.5F, 0.25F, 1}, 3)};

    const Picture picture = renderer.draw(scene, width, height);

    // At the middle ray and normal are one. The light's reflection has the normal's share of it.
    const double cosine = 0.7 / std::sqrt(0.4 * 0.4 + 0.6 * 0.6 + 0.7 * 0.7);
    const double shine = 0.15 * std::pow(cosine, 32) * cosine;
    const std::size_t at = 4 * pixel_of(scene.camera, {0.01F, 0.01F, 0});
    const std::array<double, 3> paint{0.5, 0.25, 1};
    for (std::size_t c = 0; c < 3; ++c) {
        const double light = paint[c] * (0.35 + 0.65 * cosine) + shine;
        const double code = 255 * test::encoded(std::min(light, 1.0));
        CHECK(std::abs(picture.rgba[at + c] - code) < 1.5);
    }
    test::check_silent(device);
}

TEST_CASE("colours between corners are as perspective has them", "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.occlusion = false;
    // A floor that leads away from the camera, black where it is near and white where it is far.
    scene.meshes = {test::plane_mesh({0, -1, 0}, {2, 0, 0}, {0, 0, -8}, {0, 0, 0}, 3)};
    scene.meshes[0].vertices[2].colour = scene.meshes[0].vertices[3].colour = glm::vec3(0.5F);

    const Picture picture = renderer.draw(scene, width, height);

    double last = -1;
    for (const float z : {2.0F, 0.0F, -3.0F, -6.0F}) {
        const std::size_t at = pixel_of(scene.camera, {0, -1, z});
        const double light = test::decoded(picture.rgba[4 * at] / 255.0);
        const double depth = picture.depth[at];  // says which place this pixel shows
        const double share = (8 - (10 - depth)) / 16;
        const double lit = 0.35 + 0.65 * 0.6 / std::sqrt(0.4 * 0.4 + 0.6 * 0.6 + 0.7 * 0.7);
        CHECK(light == Approx(0.5 * share * lit).margin(0.01));
        CHECK(depth == Approx(10 - z).epsilon(0.02));
        CHECK(light > last);
        last = light;
    }
    test::check_silent(device);
}

TEST_CASE("meshes across the picture's edge and the near plane are cut there",
          "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    // Larger than the picture every way; and a floor from behind the camera.
    scene.meshes = {test::plane_mesh({0, 0, -5}, {90, 0, 0}, {0, 90, 0}, {1, 0, 0}, 1),
                    test::plane_mesh({0, -1, 0}, {90, 0, 0}, {0, 0, -90}, {0, 1, 0}, 2),
                    test::sphere_mesh(scene.camera.eye, 3, {0, 0, 1}, 4, 16)};
    scene.meshes[2].is_closed = true;

    const Picture from_inside = renderer.draw(scene, width, height);
    scene.meshes.pop_back();
    const Picture picture = renderer.draw(scene, width, height);

    // The camera stands in the sphere: nothing but its inner side, 3 Å away, up to the floor.
    CHECK(from_inside.picks[0] == 4);
    CHECK(count(from_inside, 1) == 0);
    CHECK(count(picture, Picture::nothing_seen) == 0);
    CHECK(picture.picks[0] == 1);
    CHECK(picture.depth[width * height / 3] == Approx(15).margin(1e-3));
    CHECK(picture.picks[width * (height - 1) + width / 2] == 2);
    test::check_silent(device);
}

TEST_CASE("meshes of nothing are nothing, and indices of no vertex a sentence",
          "[render][mesh][gpu]") {
    GpuDevice device(test::validated(GENERATE(false, true)));
    Renderer renderer(device);
    FrameScene scene;
    scene.meshes = {{}, test::plane_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, 3)};
    scene.meshes[1].indices.clear();
    CHECK(count(renderer.draw(scene, width, height), Picture::nothing_seen) == width * height);

    scene.meshes[1].indices = {0, 1, 4};
    CHECK_THROWS_WITH(renderer.draw(scene, width, height),
                      "mesh 1 has index 4; expected less than its 4 vertices");
    scene.meshes[1].indices = {0, 1};
    CHECK_THROWS_WITH(renderer.draw(scene, width, height),
                      "mesh 1 has 2 indices; expected three for each triangle");

    scene.meshes[1].indices = {0, 1, 2, 0, 0, 0};  // and one without area
    scene.meshes[1].opacity = GENERATE(0.0F, 1.0F);
    CHECK((count(renderer.draw(scene, width, height), 3) > 0) == (scene.meshes[1].opacity > 0));
    test::check_silent(device);
}
