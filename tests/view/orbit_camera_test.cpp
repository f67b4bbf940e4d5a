#include "view/orbit_camera.h"

#include "render/renderer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

using namespace palpa;

namespace {

constexpr std::uint32_t view_width = 320, view_height = 180;
constexpr float aspect = 320.0F / 180;

// A long box of spheres, off the origin.
FrameScene long_box() {
    FrameScene scene;
    for (int i = 0; i < 8; ++i) {
        scene.spheres.push_back(
            {{(i & 1) != 0 ? 25 : 5, (i & 2) != 0 ? 3 : 0, i >= 4 ? -9 : 0}, 1.5F});
    }
    return scene;
}

glm::vec3 seen_at(const OrbitCamera& camera, const glm::vec3& place) {
    return project(frame_camera(camera, {}), place, view_width, view_height);
}

}  // namespace

TEST_CASE("without azimuth and elevation the camera looks along -z, y up", "[view][camera]") {
    const OrbitCamera camera{.target = {1, 2, 3}, .distance = 20};

    const FrameCamera built = frame_camera(camera, {});

    CHECK(glm::distance(built.eye, {1, 2, 23}) < 1e-5);
    CHECK(seen_at(camera, {1, 3, 3}).y < 90);  // rows run down
    CHECK(seen_at(camera, {2, 2, 3}).x > 160);
}

TEST_CASE("what is framed fits the room between panels, about the middle of that room",
          "[view][camera]") {
    // A room in the right half of the picture, without its upper third.
    OrbitCamera camera;
    const FrameScene box = long_box();
    frame_all(camera, box, {0.5F * aspect, 2 / 3.0F});
    FrameCamera built = frame_camera(camera, box);
    built.centre = {0.5F, -1 / 3.0F};
    float left = view_width, right = 0, top = view_height, bottom = 0;
    for (const SphereShape& sphere : box.spheres) {
        for (const glm::vec3& off :
             {glm::vec3{1.5F, 0, 0}, {-1.5F, 0, 0}, {0, 1.5F, 0}, {0, -1.5F, 0}}) {
            const glm::vec3 seen = project(built, sphere.centre + off, view_width, view_height);
            left = std::min(left, seen.x);
            right = std::max(right, seen.x);
            top = std::min(top, seen.y);
            bottom = std::max(bottom, seen.y);
        }
    }
    CHECK(left > 160);
    CHECK(right < 320);
    CHECK(top > 60);
    CHECK(bottom < 180);
    CHECK(right - left > 0.75 * 160);  // and fills it
}

TEST_CASE("orbiting takes the camera to its right and up, around a target that stays in the middle",
          "[view][camera]") {
    OrbitCamera camera{.target = {1, 2, 3}, .distance = 20};

    SECTION("a quarter to the right, it looks along -x") {
        orbit(camera, 1.5707963F, 0);
        CHECK(glm::distance(frame_camera(camera, {}).eye, {21, 2, 3}) < 1e-4);
    }
    SECTION("up, but not over the pole") {
        orbit(camera, 0.3F, 5);
        CHECK(frame_camera(camera, {}).eye.y == Approx(22).epsilon(0.001));
        CHECK(std::isfinite(seen_at(camera, {4, 2, 3}).x));
        orbit(camera, 0, -9);
        CHECK(frame_camera(camera, {}).eye.y == Approx(-18).epsilon(0.001));
    }

    const glm::vec3 middle = seen_at(camera, camera.target);
    CHECK(middle.x == Approx(160).epsilon(0.001));
    CHECK(middle.y == Approx(90).epsilon(0.001));
    CHECK(middle.z == Approx(20).epsilon(0.001));
}

TEST_CASE("what is at the target follows a pan by as many pixels", "[view][camera]") {
    OrbitCamera camera{.target = {1, 2, 3}, .distance = 20, .azimuth = 0.7F, .elevation = -0.4F};
    const glm::vec3 place = camera.target;

    pan(camera, 45, -18, view_height);

    const glm::vec3 there = seen_at(camera, place);
    CHECK(there.x == Approx(160 + 45).epsilon(0.001));
    CHECK(there.y == Approx(90 - 18).epsilon(0.001));
    CHECK(angstrom_per_pixel(camera, camera.target, view_height) ==
          Approx(2 * 20 * std::tan(0.3) / view_height));
}

TEST_CASE("what is seen goes where a hand carries it", "[view][camera]") {
    const OrbitCamera before{.target = {1, 2, 3}, .distance = 20, .azimuth = 0.7F};
    const glm::vec3 place = before.target;
    // In front of the target, so that it shows which way things turn.
    const glm::vec3 front = place + backward(before);
    const auto seen_after = [&](const HandRate& rate, const glm::vec3& what) {
        OrbitCamera camera = before;
        for (int i = 0; i < 10; ++i) carry(camera, rate, 0.1);
        return seen_at(camera, what);
    };

    const glm::vec3 aside = seen_after({Vec3(carried_m / 4, 0, 0), Vec3::Zero()}, place);
    const glm::vec3 lifted = seen_after({Vec3(0, carried_m / 4, 0), Vec3::Zero()}, place);
    OrbitCamera nearer = before;
    carry(nearer, {Vec3(0, 0, carried_m), Vec3::Zero()}, 0.5);

    CHECK(aside.x == Approx(160 + 45).epsilon(0.001));
    CHECK(aside.y == Approx(90).epsilon(0.001));
    CHECK(lifted.x == Approx(160).epsilon(0.001));
    CHECK(lifted.y == Approx(90 - 45).epsilon(0.001));
    CHECK(nearer.distance == Approx(20 * std::exp(-0.5)));
    // By the right hand: its front comes to the right, or down.
    CHECK(seen_after({Vec3::Zero(), Vec3(0, 0.3, 0)}, front).x > 162);
    CHECK(seen_after({Vec3::Zero(), Vec3(0.3, 0, 0)}, front).y > 92);
}

TEST_CASE("a zoom changes the distance by its factor, within limits", "[view][camera]") {
    OrbitCamera camera{.distance = 20};

    zoom(camera, 0.5F);
    CHECK(camera.distance == Approx(10));
    zoom(camera, 1e-9F);
    CHECK(camera.distance == Approx(1));
    zoom(camera, 1e9F);
    CHECK(camera.distance == Approx(2000));
}

TEST_CASE("what is under the cursor stays there while the camera comes nearer", "[view][camera]") {
    OrbitCamera camera{.target = {1, 2, 3}, .distance = 20, .azimuth = 0.7F, .elevation = -0.4F};
    const float scale = angstrom_per_pixel(camera, camera.target, view_height);
    const glm::vec3 place =
        camera.target + scale * (50.0F * rightward(camera) - 30.0F * upward(camera));
    const float factor = GENERATE(0.5F, 0.9F, 1.7F, 1e-6F);

    zoom_at(camera, factor, 50, 30, view_height);

    CHECK(camera.distance == Approx(std::max(20 * factor, 1.0F)));  // or as near as it goes
    const glm::vec3 there = seen_at(camera, place);
    CHECK(there.x == Approx(160 + 50).epsilon(0.001));
    CHECK(there.y == Approx(90 + 30).epsilon(0.001));
}

TEST_CASE("between two cameras the way turns the short way round", "[view][camera]") {
    constexpr float degree = 3.14159265F / 180;
    const OrbitCamera from{
        .target = {0, 0, 0}, .distance = 10, .azimuth = 170 * degree, .elevation = 10 * degree};
    const OrbitCamera to{.target = {2, 4, -6},
                         .distance = 40,
                         .azimuth = (-170 + 720) * degree,
                         .elevation = 30 * degree,
                         .vertical_angle = 0.8F};

    const OrbitCamera begin = between(from, to, 0), middle = between(from, to, 0.5F),
                      end = between(from, to, 1);

    CHECK(begin.target == from.target);
    CHECK(begin.distance == 10);
    CHECK(begin.azimuth == from.azimuth);
    CHECK(begin.elevation == from.elevation);
    CHECK(glm::distance(middle.target, {1, 2, -3}) < 1e-5);
    CHECK(middle.distance == Approx(20));  // twice, and twice again
    CHECK(middle.azimuth == Approx(180 * degree));
    CHECK(middle.elevation == Approx(20 * degree));
    CHECK(middle.vertical_angle == Approx(0.7));
    CHECK(glm::distance(end.target, to.target) < 1e-5);
    CHECK(end.distance == Approx(40));
    CHECK(end.azimuth == Approx(190 * degree));
    CHECK(glm::distance(backward(end), backward(to)) < 1e-5);
    CHECK(end.elevation == Approx(to.elevation));
    CHECK(eased(-1) == 0);
    CHECK(eased(0.25F) == Approx(0.15625));
    CHECK(eased(0.5F) == 0.5F);
    CHECK(eased(2) == 1);
}

TEST_CASE("everything that is framed fits, from every side, and not with much to spare",
          "[view][camera]") {
    const FrameScene scene = long_box();
    OrbitCamera camera;
    camera.azimuth = GENERATE(0.0F, 0.9F, 1.57F, 3.0F);
    camera.elevation = GENERATE(-1.2F, 0.0F, 0.5F);

    frame_all(camera, scene, aspect);

    const FrameCamera built = frame_camera(camera, scene);
    float widest = 0;
    for (const SphereShape& sphere : scene.spheres) {
        const glm::vec3 there = project(built, sphere.centre, view_width, view_height);
        const float radius = sphere.radius * 90 / std::tan(0.3F) / there.z;
        widest = std::max({widest, (std::abs(there.x - 160) + radius) / 160,
                           (std::abs(there.y - 90) + radius) / 90});
        CHECK(there.z - sphere.radius > built.near);
        CHECK(there.z + sphere.radius < built.far);
    }
    CHECK(widest < 0.99);
    CHECK(widest > 0.6);

    OrbitCamera same = camera;
    frame_shapes(same, {}, aspect);
    CHECK(same.distance == camera.distance);
    frame_shapes(same, std::vector{scene.spheres[0]}, aspect);
    CHECK(glm::distance(same.target, scene.spheres[0].centre) < 1e-4);
    CHECK(same.distance < camera.distance);
}

TEST_CASE("the near plane is close to what is nearest, and in front of the eye within a molecule",
          "[view][camera]") {
    const FrameScene scene = long_box();  // x from 3.5 to 26.5
    OrbitCamera camera;
    camera.azimuth = 1.570796F;
    camera.target = {15, 0, 0};

    camera.distance = 100;
    const FrameCamera outside = frame_camera(camera, scene);
    const float nearest = seen_at(camera, scene.spheres[1].centre).z - 1.5F;
    CHECK(outside.near == Approx(nearest).epsilon(0.05));

    camera.distance = 2;  // half of the spheres are behind the eye
    const FrameCamera within = frame_camera(camera, scene);
    CHECK(within.near > 0);
    CHECK(within.near < 0.1F);
}
