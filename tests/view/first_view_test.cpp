#include "view/first_view.h"

#include "loading/load.h"
#include "render/renderer.h"
#include "simulation/resources.h"
#include "tests/support/water_scene.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

using namespace palpa;

TEST_CASE("a scene without [view] is shown whole, few atoms as balls and sticks",
          "[view][first-view]") {
    World world = load_world(test::water_scene());

    const ViewSettings settings = first_settings({}, world);

    CHECK(settings.representation == Representation::BallAndStick);
    CHECK(settings.colouring == Colouring::Chain);
    CHECK(framed_atoms({}, world).count == 0);
    const FrameScene frame = build_frame(world, settings);
    OrbitCamera all;
    frame_all(all, frame, 1.5F);
    const OrbitCamera camera = first_camera({}, frame, {}, 1.5F);
    CHECK(camera.target == all.target);
    CHECK(camera.distance == all.distance);
    CHECK((camera.azimuth == 0 && camera.elevation == 0));
}

TEST_CASE("a scene's [view] says how it is shown at first", "[view][first-view]") {
    const SceneDescription scene =
        test::water_scene({"view.representation=licorice", "view.colour=element",
                           "view.camera=[90, 30, 2]", "view.look_at=fixed"});
    World world = load_world(scene);

    const ViewSettings settings = first_settings(scene.view, world);
    const AtomRange framed = framed_atoms(scene.view, world);
    const FrameScene frame = build_frame(world, settings);
    const OrbitCamera camera = first_camera(scene.view, frame, framed, 1.5F);

    CHECK(settings.representation == Representation::Licorice);
    CHECK(settings.colouring == Colouring::Element);
    REQUIRE(framed.count == 3);
    for (std::uint32_t i = 0; i < 3; ++i)
        CHECK(world.resource<AtomTable>().names[framed.first + i].segment == "FIX");
    OrbitCamera at_fixed;
    orbit(at_fixed, std::acos(0.0F), std::acos(-1.0F) / 6);
    frame_shapes(at_fixed, shapes_of(frame, framed), 1.5F);
    CHECK(glm::distance(camera.target, at_fixed.target) < 1e-4);
    CHECK(camera.distance == Approx(at_fixed.distance / 2));
    CHECK(glm::distance(backward(camera), backward(at_fixed)) < 1e-5);
}

TEST_CASE("a camera that was turned is described so that the scene opens as it is seen",
          "[view][first-view]") {
    const SceneDescription scene = test::water_scene({"view.camera=[20, 10, 1]"});
    World world = load_world(scene);
    const FrameScene frame = build_frame(world, first_settings(scene.view, world));
    OrbitCamera camera = first_camera(scene.view, frame, {}, 1.5F);
    CHECK(describe_camera(camera, scene.view, frame, {}, 1.5F) == scene.view.camera);
    orbit(camera, 4 * std::acos(-1.0F) + 0.5F, 0.25F);  // twice around, and on
    zoom(camera, 0.4F);

    ViewDescription described = scene.view;
    described.camera = describe_camera(camera, scene.view, frame, {}, 1.5F);
    const OrbitCamera again = first_camera(described, frame, {}, 1.5F);

    CHECK(described.camera[0] == Approx(20 + 0.5 * 180 / std::acos(-1.0)).margin(0.06));
    CHECK(glm::distance(backward(again), backward(camera)) < 2e-3);
    CHECK(again.distance == Approx(camera.distance).epsilon(0.005));
}
