// Pictures in tiles against the same in one piece.
#include "render/renderer.h"

#include "tests/render/meshes.h"
#include "tests/render/pixels.h"
#include "tests/support/gpu.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

using namespace palpa;
using test::count, test::height, test::width;

namespace {

// Crevices and outlines everywhere, some near enough that occlusion looks 64 pixels around.
FrameScene crowded_scene() {
    FrameScene scene;
    scene.camera.eye = {0, 1, 7};
    scene.camera.centre = {0.15F, -0.2F};
    scene.camera.fog_from = 6;
    scene.camera.fog_length = 8;
    const glm::vec3 grey(0.6F, 0.5F, 0.4F);
    for (std::uint32_t i = 0; i < 150; ++i) {
        const auto t = static_cast<float>(i);
        const glm::vec3 place(2.5F * std::sin(1.3F * t), 2 * std::cos(2.1F * t),
                              2 * std::sin(0.7F * t));
        scene.spheres.push_back({place, 0.3F, grey, i, i % 40 == 7});
        scene.cones.push_back({place, 0.6F * place, 0.1F, 0.05F, grey, grey, 1000 + i});
    }
    scene.meshes = {test::sphere_mesh({0, 0, 0}, 1, {0.2F, 0.5F, 0.7F}, 2000, 24),
                    test::sphere_mesh({0.3F, 0, 0}, 1.9F, {0.7F, 0.3F, 0.2F}, 2001, 24)};
    scene.meshes[1].opacity = 0.4F;
    return scene;
}

}  // namespace

TEST_CASE("a picture in tiles is the picture in one piece", "[render][tiles][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene = crowded_scene();
    scene.outline = GENERATE(1, 3);
    scene.shadows = scene.outline == 3;
    const Picture whole = renderer.draw(scene, width, height);

    const Picture tiled = renderer.draw_in_tiles(scene, width, height, 200);

    // Rays to a pixel differ in their last bits: at the rims of shapes a pixel may show another.
    REQUIRE(tiled.rgba.size() == whole.rgba.size());
    std::size_t picked_otherwise = 0, unlike = 0, deeper = 0;
    for (std::size_t i = 0; i < whole.picks.size(); ++i) {
        if (tiled.picks[i] != whole.picks[i]) {
            ++picked_otherwise;
            continue;
        }
        if (!(tiled.depth[i] == whole.depth[i] ||
              std::abs(tiled.depth[i] - whole.depth[i]) < 1e-3F)) {
            ++deeper;
        }
        for (std::size_t c = 0; c < 4; ++c) {
            if (std::abs(int{tiled.rgba[4 * i + c]} - int{whole.rgba[4 * i + c]}) > 3) {
                ++unlike;
                break;
            }
        }
    }
    const std::size_t few = whole.picks.size() / 2000;
    CHECK(count(whole, Picture::nothing_seen) < whole.picks.size() * 3 / 4);
    CHECK(picked_otherwise < few);
    CHECK(deeper < few);
    CHECK(unlike < few);
    test::check_silent(device);
}

TEST_CASE("a picture beyond the device's limit is drawn", "[render][tiles][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.outline = 0;
    const std::uint32_t wide = device.limits().maxImageDimension2D + 100;
    // The camera's axis is in the middle: a pixel is as high as wide.
    scene.spheres = {{{0, 0, 0}, 1, {1, 0, 0}, 7}};

    const Picture picture = renderer.draw(scene, wide, 40);

    REQUIRE(picture.picks.size() == std::size_t{wide} * 40);
    const Picture narrow = renderer.draw(scene, 100, 40);
    CHECK(count(picture, 7) == count(narrow, 7));
    CHECK(picture.picks[std::size_t{20} * wide + wide / 2] == 7);
    CHECK_THROWS_AS(renderer.draw_in_tiles(scene, 500, 500, 130), GpuError);
    test::check_silent(device);
}
