// Large scenes: what is hidden is left out, and what is smaller than a pixel thinned out.
#include "render/drawn_shapes.h"

#include "render/renderer.h"
#include "tests/render/pixels.h"
#include "tests/support/gpu.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

using namespace palpa;
using test::height, test::width;

namespace {

constexpr float extent = 10;  // Å, half of the cube in which everything is

// A crowd of bonded spheres in a cube, some on top of all others.
FrameScene crowd(std::size_t spheres, float radius, std::uint32_t seed = 3) {
    FrameScene scene;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-extent, extent), share(0.3F, 1);
    glm::vec3 last(0);
    for (std::uint32_t i = 0; i < spheres; ++i) {
        const glm::vec3 here(place(random), place(random), place(random));
        const glm::vec3 colour(share(random), share(random), share(random));
        scene.spheres.push_back({here, share(random) * radius, colour, i, i % 1000 == 7});
        if (i % 3 == 0) {
            scene.cones.push_back({here, here + 0.1F * (last - here), 0.3F * radius, 0.2F * radius,
                                   colour, colour, 1'000'000 + i, i % 1000 == 9});
        }
        last = here;
    }
    return scene;
}

FrameCamera camera_at(const glm::vec3& eye, const glm::vec2& centre) {
    FrameCamera camera;
    camera.eye = eye;
    camera.centre = centre;
    return camera;
}

}  // namespace

TEST_CASE("shapes that are omitted from a crowd cannot be seen", "[render][large][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene = crowd(8000, 1.2F);  // so few that the renderer takes all
    // From outside, beside the picture's middle, and from within.
    scene.camera = GENERATE(camera_at({0, 3, 45}, {0, 0}), camera_at({30, 0, 30}, {0.3F, -0.2F}),
                            camera_at({1, 2, 8}, {0, 0}));
    DrawnShapes drawn;
    drawn.choose(scene, view_matrix(scene.camera), build_frame_constants(scene, {width, height}));
    FrameScene less = scene;
    less.spheres = drawn.spheres();
    less.cones = drawn.cones();
    CHECK(less.spheres.size() < 0.6 * static_cast<double>(scene.spheres.size()));
    CHECK(less.cones.size() < 0.65 * static_cast<double>(scene.cones.size()));

    const Picture all = renderer.draw(scene, width, height),
                  some = renderer.draw(less, width, height);

    CHECK(all.rgba == some.rgba);
    CHECK(all.picks == some.picks);
    CHECK(all.depth == some.depth);
    test::check_silent(device);
}

TEST_CASE("the renderer shows of a large crowd what it would of all", "[render][large][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    FrameScene scene = crowd(30'000, 0.8F);
    scene.camera.eye = {5, 3, 40};
    const Picture some = renderer.draw(scene, width, height);
    scene.shadows = true;  // for which nothing is left out
    const Picture all = renderer.draw(scene, width, height);

    CHECK(some.picks == all.picks);
    CHECK(some.depth == all.depth);
    test::check_silent(device);
}

TEST_CASE("of very many shapes below a pixel the nearest of 2 x 2 pixels is drawn",
          "[render][large]") {
    FrameScene scene = crowd(160'000, 0.01F);
    for (SphereShape& sphere : scene.spheres) sphere.is_on_top = false;
    scene.camera.eye = {0, 0, 60};
    const GpuFrame frame = build_frame_constants(scene, {width, height});
    const glm::mat4 view = view_matrix(scene.camera);
    DrawnShapes drawn;
    drawn.choose(scene, view, frame);
    CHECK(drawn.spheres().size() == scene.spheres.size());  // too small to hide each other

    scene.is_coarse = true;
    drawn.choose(scene, view, frame);

    // By brute force: who is nearest in each cell, by the projection that signs go by.
    std::vector<float> nearest(std::size_t{width / 2 + 1} * (height / 2 + 1), 1e9F);
    const auto cell_of = [&](const glm::vec3& at) {
        return static_cast<std::size_t>(at.y / 2) * (width / 2 + 1) +
               static_cast<std::size_t>(at.x / 2);
    };
    std::set<std::size_t> cells;
    for (const SphereShape& sphere : scene.spheres) {
        const glm::vec3 at = project(scene.camera, sphere.centre, width, height);
        nearest[cell_of(at)] = std::min(nearest[cell_of(at)], at.z);
        cells.insert(cell_of(at));
    }
    CHECK(drawn.spheres().size() <= cells.size());
    CHECK(static_cast<double>(drawn.spheres().size()) > 0.95 * static_cast<double>(cells.size()));
    std::size_t right = 0;
    const float pixel_per_angstrom = 0.5F * static_cast<float>(height) * frame.projection.y;
    for (const SphereShape& sphere : drawn.spheres()) {
        const glm::vec3 at = project(scene.camera, sphere.centre, width, height);
        right += at.z < nearest[cell_of(at)] + 1e-3F ? 1 : 0;
        CHECK(sphere.radius == Approx(at.z / pixel_per_angstrom).epsilon(1e-3));
    }
    CHECK(static_cast<double>(right) > 0.99 * static_cast<double>(drawn.spheres().size()));
}
