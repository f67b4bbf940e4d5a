#include "view/find_room.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace palpa;

namespace {

Vec3 as_double(const glm::vec3& v) { return {v.x, v.y, v.z}; }

// By all pairs.
bool is_free(const std::vector<glm::vec3>& taken, const Newcomer& newcomer, const Vec3& place) {
    for (const Vec3& atom : newcomer.atoms) {
        for (const glm::vec3& other : taken) {
            if ((place + atom - as_double(other)).norm() < newcomer.gap) return false;
        }
    }
    return true;
}

std::vector<glm::vec3> draw_atoms(std::mt19937& random, int count, float reach) {
    std::uniform_real_distribution<float> place(-reach, reach);
    std::vector<glm::vec3> atoms;
    for (int i = 0; i < count; ++i) atoms.emplace_back(place(random), place(random), place(random));
    return atoms;
}

const std::vector<Vec3> alone{Vec3::Zero()};
const std::vector<Vec3> bent{Vec3::Zero(), {2.5, 0, 0}, {0, -3, 1}, {4, 4, -2}};

}  // namespace

TEST_CASE("where nothing is in the way, what is new comes to where one looks", "[view][room]") {
    OrbitCamera camera;
    camera.target = {1, -2, 3};

    CHECK(find_room({}, {alone}, camera) == Vec3(1, -2, 3));
    const std::vector<glm::vec3> far{{1, -2, 6.01F},
                                     {std::numeric_limits<float>::quiet_NaN(), 0, 0}};
    CHECK(find_room(far, {alone}, camera) == Vec3(1, -2, 3));
}

TEST_CASE("the nearest free place of the grid is found, whatever is there", "[view][room]") {
    const unsigned seed = GENERATE(range(0U, 12U));
    std::mt19937 random(seed);
    const std::vector<glm::vec3> taken = draw_atoms(random, 40 + 60 * static_cast<int>(seed), 8);
    OrbitCamera camera;
    camera.target = {0.3F, -0.2F, 0.1F};
    orbit(camera, 0.5F * static_cast<float>(seed), 0.1F * static_cast<float>(seed));
    const Newcomer newcomer{seed % 2 == 0 ? alone : bent, seed % 3 == 0 ? 4.5 : 3.0};

    const std::optional<Vec3> found = find_room(taken, newcomer, camera);

    REQUIRE(found);
    CHECK(is_free(taken, newcomer, *found));
    const Vec3 middle = as_double(camera.target);
    const double distance = (*found - middle).norm();
    // Every place of the grid that is nearer is taken.
    const Vec3 right = as_double(rightward(camera)), up = as_double(upward(camera)),
               back = as_double(backward(camera));
    REQUIRE(distance < 16);
    const int reach = static_cast<int>(distance) + 1;
    int nearer = 0, on_grid = 0;
    for (int x = -reach; x <= reach; ++x) {
        for (int y = -reach; y <= reach; ++y) {
            for (int z = -reach; z <= reach; ++z) {
                const Vec3 place = middle + x * right + y * up + z * back;
                on_grid += (place - *found).norm() < 1e-9 ? 1 : 0;
                if (!((place - middle).norm() < distance - 1e-5)) continue;
                ++nearer;
                CHECK_FALSE(is_free(taken, newcomer, place));
            }
        }
    }
    CHECK(on_grid == 1);
    CHECK((nearer > 0 || distance == 0));
    CHECK(find_room(taken, newcomer, camera) == found);
}

TEST_CASE("of places equally near it is the upper one in the plane of the picture",
          "[view][room]") {
    OrbitCamera camera;
    orbit(camera, 0.7F, 0.4F);
    const std::vector<glm::vec3> taken{camera.target};

    const std::optional<Vec3> found = find_room(taken, {alone}, camera);

    REQUIRE(found);
    CHECK((*found - 3 * as_double(upward(camera))).norm() < 1e-5);
}

TEST_CASE("within a crowd the place is outside of it", "[view][room]") {
    std::vector<glm::vec3> taken;
    for (int x = -22; x <= 22; ++x) {
        for (int y = -22; y <= 22; ++y) {
            for (int z = -22; z <= 22; ++z) {
                if (x * x + y * y + z * z <= 22 * 22) taken.emplace_back(2 * x, 2 * y, 2 * z);
            }
        }
    }
    OrbitCamera camera;
    camera.target = {5, 0, 0};
    const Newcomer newcomer{bent, 3};

    const std::optional<Vec3> found = find_room(taken, newcomer, camera);

    REQUIRE(found);
    CHECK(is_free(taken, newcomer, *found));
    // The ball has a radius of 44 Å; its surface is 39 Å away, and the shell's grid has 4 Å.
    CHECK((*found - Vec3(5, 0, 0)).norm() < 39 + 3 + 3 * 4);
}

TEST_CASE("beyond the places that an edit may name there is none", "[view][room]") {
    OrbitCamera camera;
    camera.target = {3e4F, 0, 0};
    const std::vector<glm::vec3> taken{{3e4F, 0, 0}};
    const std::optional<Vec3> found = find_room(taken, {alone}, camera);

    // Far away, but one that can be named; or none.
    if (found) CHECK(found->cwiseAbs().maxCoeff() <= 1e4);
    camera.target = {1e9F, 0, 0};
    CHECK_FALSE(find_room(taken, {alone}, camera));
}
