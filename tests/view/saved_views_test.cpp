#include "view/saved_views.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

using namespace palpa;

namespace {

const std::vector<glm::vec3> places{{0, 0, 0}, {4, 0, 0}, {4, 6, 0}, {100, 0, 0}};
const std::vector<bool> first_three{true, true, true, false};

}  // namespace

TEST_CASE("a saved view frames what it selects, shifted and nearer as it says", "[view][saved]") {
    const float slope = std::tan(OrbitCamera().vertical_angle / 2);
    const SavedView plain{.name = "plain"};
    const OrbitCamera camera = saved_camera(plain, places, first_three, 1.0F);

    // The middle of 0 to 4 and 0 to 6; the distance is that of the height, 3 Å and a radius.
    CHECK(glm::distance(camera.target, {2, 3, 0}) < 1e-5);
    CHECK(camera.distance == Approx(1.7 + 1.12 * (3 + 1.7) / slope));
    CHECK(camera.azimuth == 0);

    const SavedView moved{.name = "moved", .camera = {90, 0, 4}, .shift = {1, -2, 0.5}};
    const OrbitCamera other = saved_camera(moved, places, first_three, 1.0F);
    CHECK(glm::distance(other.target, {3, 1, 0.5F}) < 1e-5);
    // Along x: 2 Å nearer to the eye are the atoms of the one side.
    CHECK(other.distance == Approx((2 + 1.7 + 1.12 * (3 + 1.7) / slope) / 4));
    CHECK(glm::distance(backward(other), {1, 0, 0}) < 1e-6);

    // Nothing selected is all.
    CHECK(saved_camera(plain, places, {}, 1.0F).target.x == Approx(50));
    CHECK(saved_camera(plain, places, std::vector<bool>(4, false), 1.0F).target.x == Approx(50));
}

TEST_CASE("a view that is saved from a camera sees as that one did", "[view][saved]") {
    OrbitCamera camera{.target = {3, -1, 7}, .distance = 31, .azimuth = 11, .elevation = -0.6F};
    SavedView saved{.name = "here"};

    set_camera(saved, camera, places, first_three, {1.2F, 0.7F});

    const OrbitCamera again = saved_camera(saved, places, first_three, {1.2F, 0.7F});
    CHECK(glm::distance(again.target, camera.target) < 0.01);
    CHECK(again.distance == Approx(31).epsilon(0.01));
    CHECK(glm::distance(backward(again), backward(camera)) < 2e-3);
    CHECK(std::abs(saved.camera[0]) <= 180);
    SavedView twice = saved;
    set_camera(twice, again, places, first_three, {1.2F, 0.7F});
    CHECK(twice.camera == saved.camera);
}

TEST_CASE("a far view keeps its distance to a per cent", "[view][saved]") {
    for (const float distance : {200.0F, 700.0F, 1100.0F}) {
        const OrbitCamera camera{.target = {2, 3, 0}, .distance = distance};
        SavedView saved{.name = "far"};
        set_camera(saved, camera, places, first_three, 1.0F);
        CHECK(saved_camera(saved, places, first_three, 1.0F).distance ==
              Approx(distance).epsilon(0.006));
    }
}

TEST_CASE("saved views are found by their names, and new ones get a free one", "[view][saved]") {
    const std::vector<SavedView> views{{.name = "view 1"}, {.name = "flaps"}, {.name = "view 3"}};
    CHECK(find_saved_view(views, "flaps") == &views[1]);
    CHECK(find_saved_view(views, "Flaps") == nullptr);
    CHECK(find_free_view_name(views) == "view 2");
    CHECK(find_free_view_name({}) == "view 1");
}
