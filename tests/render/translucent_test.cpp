// Translucent meshes: colours by hand, layer over layer.
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
#include <glm/geometric.hpp>
#include <vector>

using namespace palpa;
using test::count, test::height, test::pixel_of, test::width;

namespace {

using Light = std::array<double, 3>;

struct Layer {
    glm::vec3 normal;
    glm::vec3 colour;
    double opacity;
};

// Seen along `ray`, with the light and the glass that renderer.h and frame_scene.h speak of.
Light lit(const Layer& layer, const glm::vec3& ray) {
    const glm::vec3 light = glm::normalize(glm::vec3(-0.4F, 0.6F, 0.7F));
    const glm::vec3 normal = glm::dot(layer.normal, ray) > 0 ? -layer.normal : layer.normal;
    const double cosine = std::max(glm::dot(normal, light), 0.0F);
    const glm::vec3 mirrored = 2 * glm::dot(normal, light) * normal - light;
    const double shine =
        0.15 * cosine * std::pow(std::max(glm::dot(mirrored, -glm::normalize(ray)), 0.0F), 32);
    Light sum{};
    for (int c = 0; c < 3; ++c) {
        sum[static_cast<std::size_t>(c)] = layer.colour[c] * (0.35 + 0.65 * cosine) + shine;
    }
    return sum;
}

double coverage(const Layer& layer, const glm::vec3& ray) {
    const double cosine = std::abs(glm::dot(layer.normal, glm::normalize(ray)));
    return 1 - std::pow(1 - layer.opacity, 1 / std::max(cosine, 0.25));
}

// From back to front over what is behind.
Light compose(const std::vector<Layer>& layers, const glm::vec3& ray, Light behind) {
    for (const Layer& layer : layers) {
        const double a = coverage(layer, ray);
        for (std::size_t c = 0; c < 3; ++c) {
            behind[c] = a * lit(layer, ray)[c] + (1 - a) * behind[c];
        }
    }
    return behind;
}

void check_light(const Picture& picture, std::size_t at, const Light& expected) {
    for (std::size_t c = 0; c < 3; ++c) {
        CHECK(std::abs(picture.rgba[4 * at + c] - 255 * test::encoded(expected[c])) < 2);
    }
}

// The ray through a pixel's middle, for a camera at (0, 0, 10) that looks along -z.
glm::vec3 ray_through(const FrameCamera& camera, std::size_t pixel) {
    const float scale = std::tan(camera.vertical_angle / 2) / (0.5F * height);
    return {scale * (static_cast<float>(pixel % width) + 0.5F - 0.5F * width),
            -scale * (static_cast<float>(pixel / width) + 0.5F - 0.5F * height), -1};
}

const glm::vec3 red(0.9F, 0.1F, 0.1F), blue(0.1F, 0.2F, 0.9F), green(0.1F, 0.8F, 0.2F);

}  // namespace

TEST_CASE("translucent planes that cross are composed in the order of each pixel",
          "[render][mesh][gpu]") {
    GpuDevice device(test::validated(GENERATE(false, true)));
    Renderer renderer(device);
    FrameScene scene;
    scene.background = {0.2F, 0.3F, 0.4F};
    // They cross in the line x = z = 0.
    const glm::vec3 slope(2, 0, 1);
    const Layer a{glm::normalize(glm::cross(slope, {0, 1, 0})), red, 0.4}, b{{0, 0, 1}, blue, 0.6};
    scene.meshes = {test::plane_mesh({0, 0, 0}, slope, {0, 1.5F, 0}, red, 1, 0.4F),
                    test::plane_mesh({0, 0, 0}, {2, 0, 0}, {0, 1.5F, 0}, blue, 2, 0.6F)};
    if (GENERATE(false, true)) std::swap(scene.meshes[0], scene.meshes[1]);

    const Picture picture = renderer.draw(scene, width, height);

    const Light background{0.2, 0.3, 0.4};
    const auto check_at = [&](float x, const std::vector<Layer>& layers, std::uint32_t pick) {
        const std::size_t at = pixel_of(scene.camera, {x, 0.5F, 0});
        check_light(picture, at, compose(layers, ray_through(scene.camera, at), background));
        CHECK(picture.picks[at] == pick);
    };
    check_at(-0.05F, {a, b}, 2);  // a is behind on the left
    check_at(-1.2F, {a, b}, 2);
    check_at(0.05F, {b, a}, 1);
    check_at(1.2F, {b, a}, 1);
    check_light(picture, 0, background);
    CHECK(picture.picks[0] == Picture::nothing_seen);
    test::check_silent(device);
}

TEST_CASE("three layers, what is opaque between them and behind them", "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.occlusion = false;
    scene.outline = 0;
    scene.background = {1, 1, 1};
    const glm::vec3 u(2, 0, 0), v(0, 1.5F, 0), facing(0, 0, 1), grey(0.5F);
    scene.meshes = {test::plane_mesh({0, 0, 0}, u, v, green, 2, 0.5F),
                    test::plane_mesh({0, 0, 2}, u, v, blue, 3, 0.3F),
                    test::plane_mesh({0, 0, -2}, u, v, red, 1, 0.7F)};
    const Layer first{facing, red, 0.7}, second{facing, green, 0.5}, third{facing, blue, 0.3},
        wall{facing, grey, 1};
    const std::size_t at = pixel_of(scene.camera, {0.3F, 0.2F, 0});
    const glm::vec3 ray = ray_through(scene.camera, at);

    const Picture alone = renderer.draw(scene, width, height);
    check_light(alone, at, compose({first, second, third}, ray, {1, 1, 1}));
    CHECK(alone.picks[at] == 3);
    CHECK(alone.depth[at] == Approx(8).margin(1e-3));

    scene.meshes.push_back(test::plane_mesh({0, 0, -3}, u, v, grey, 9));
    const Picture behind = renderer.draw(scene, width, height);
    check_light(behind, at, compose({wall, first, second, third}, ray, {1, 1, 1}));
    CHECK(behind.picks[at] == 9);
    CHECK(behind.depth[at] == Approx(13).margin(1e-3));

    scene.meshes.back() = test::plane_mesh({0, 0, 1}, u, v, grey, 9);
    const Picture between = renderer.draw(scene, width, height);
    check_light(between, at, compose({wall, third}, ray, {1, 1, 1}));

    scene.meshes.back() = test::plane_mesh({0, 0, 3}, u, v, grey, 9);
    const Picture front = renderer.draw(scene, width, height);
    check_light(front, at, compose({wall}, ray, {1, 1, 1}));

    scene.meshes.pop_back();
    scene.spheres = {{{0.3F, 0.2F, -6}, 1, grey, 8, true}};  // on top of all
    const Picture on_top = renderer.draw(scene, width, height);
    scene.meshes.clear();
    const Picture sphere = renderer.draw(scene, width, height);
    CHECK(std::equal(&on_top.rgba[4 * at], &on_top.rgba[4 * at] + 4, &sphere.rgba[4 * at]));
    CHECK(on_top.picks[at] == 8);
    test::check_silent(device);
}

TEST_CASE("a glass ball is denser towards its rim, and what shines through is the rest",
          "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.clear_background = true;
    scene.meshes = {test::sphere_mesh({0, 0, 0}, 2, {0.5F, 0.5F, 0.5F}, 1, 48)};
    scene.meshes[0].opacity = 0.2F;
    scene.meshes[0].is_closed = GENERATE(false, true);  // its far side is seen all the same

    const Picture picture = renderer.draw(scene, width, height);

    for (const float share : {0.0F, 0.3F, 0.6F, 0.8F}) {
        // A ray that passes the centre at p meets the ball, going in and coming out, under the
        // angle whose sine is p / 2.
        const std::size_t at = pixel_of(scene.camera, {share * 2 * 10 / std::sqrt(96.0F), 0, 0});
        const glm::vec3 ray = glm::normalize(ray_through(scene.camera, at));
        const double passing = 10 * std::sqrt(1 - ray.z * ray.z);
        const double cosine = std::sqrt(1 - std::pow(passing / 2, 2));
        const double through = std::pow(std::pow(0.8, 1 / std::max(cosine, 0.25)), 2);
        CHECK(std::abs(picture.rgba[4 * at + 3] - 255 * (1 - through)) < 2);
    }
    CHECK(picture.rgba[3] == 0);
    test::check_silent(device);
}

TEST_CASE("a clear background leaves colours as they are, and alpha as what covers it",
          "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.outline = 0;
    scene.meshes = {test::plane_mesh({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, green, 2, 0.5F),
                    test::plane_mesh({0, 0, -1}, {1, 0, 0}, {0, 1, 0}, red, 3)};
    const Picture on_white = renderer.draw(scene, width, height);
    scene.clear_background = true;

    const Picture clear = renderer.draw(scene, width, height);

    CHECK(clear.picks == on_white.picks);
    const std::size_t alone = pixel_of(scene.camera, {1.5F, 0, 0}),
                      before = pixel_of(scene.camera, {0.5F, 0.1F, 0});
    const Layer layer{{0, 0, 1}, green, 0.5};
    const glm::vec3 ray = ray_through(scene.camera, alone);
    CHECK(std::abs(clear.rgba[4 * alone + 3] - 255 * coverage(layer, ray)) < 1);
    check_light(clear, alone, lit(layer, ray));
    CHECK(clear.rgba[4 * before + 3] == 255);
    CHECK(std::equal(&clear.rgba[4 * before], &clear.rgba[4 * before] + 4,
                     &on_white.rgba[4 * before]));
    CHECK(clear.rgba[3] == 0);
    test::check_silent(device);
}

TEST_CASE("more layers than there was room for are drawn all the same", "[render][mesh][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene;
    scene.background = {0, 0, 0};
    // 30 layers over the whole picture are 30 times its 76,800 pixels.
    const Layer layer{{0, 0, 1}, {0.2F, 0.3F, 0.4F}, 0.05};
    for (int i = 0; i < 30; ++i) {
        scene.meshes.push_back(test::plane_mesh({0, 0, -0.1F * static_cast<float>(i)}, {9, 0, 0},
                                                {0, 9, 0}, layer.colour, 1, 0.05F));
    }

    const Picture picture = renderer.draw(scene, width, height);
    scene.meshes.resize(1);
    const Picture fewer = renderer.draw(scene, width, height);

    for (const std::size_t at : {std::size_t{0}, pixel_of(scene.camera, {0, 0, 0})}) {
        const glm::vec3 ray = ray_through(scene.camera, at);
        check_light(picture, at, compose(std::vector<Layer>(30, layer), ray, {}));
        check_light(fewer, at, compose({layer}, ray, {}));
    }
    test::check_silent(device);
}
