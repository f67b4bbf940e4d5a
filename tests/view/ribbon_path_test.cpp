#include "view/ribbon_path.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

using namespace palpa;

namespace {

std::vector<glm::vec3> bent_guides() {
    return {{0, 0, 0}, {3, 1, 0}, {4, 4, 1}, {3, 5, 4}, {0, 4, 5}, {-1, 1, 7}};
}

RibbonPath straight(std::size_t count) {
    std::vector<glm::vec3> guides;
    for (std::size_t i = 0; i < count; ++i) guides.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    return RibbonPath(guides);
}

constexpr glm::vec3 unknown{0}, y{0, 1, 0}, z{0, 0, 1};

}  // namespace

TEST_CASE("a path goes through its guides, without steps of slope or bend", "[view][ribbon]") {
    const std::vector<glm::vec3> guides = bent_guides();
    const RibbonPath path(guides);
    constexpr float h = 0.01F;
    const auto bend = [&](float u) { return (path.slope(u + h) - path.slope(u - h)) / (2 * h); };

    for (std::size_t i = 0; i < guides.size(); ++i)
        CHECK(glm::distance(path.place(static_cast<float>(i)), guides[i]) < 1e-5F);
    for (const float u : {0.3F, 0.99F, 1.01F, 2.5F, 3.0F, 4.7F}) {
        const glm::vec3 difference = (path.place(u + h) - path.place(u - h)) / (2 * h);
        CHECK(glm::distance(difference, path.slope(u)) < 0.01F);
        CHECK(glm::length(path.along(u)) == Approx(1));
    }
    for (const float u : {1.0F, 2.0F, 3.0F, 4.0F})
        CHECK(glm::distance(bend(u - 2 * h), bend(u + 2 * h)) < 0.5F);
    CHECK(glm::length(bend(h)) < 0.2F);  // a natural spline is straight at its ends
    CHECK(glm::length(bend(path.end() - h)) < 0.2F);
}

TEST_CASE("frames are at right angles, and outside of the path those of its ends",
          "[view][ribbon]") {
    RibbonPath path(bent_guides());
    path.turn(std::vector<glm::vec3>(path.size(), z));

    for (float u = 0; u <= path.end(); u += 0.1F) {
        const RibbonFrame frame = path.frame(u);
        CHECK(glm::length(frame.aside) == Approx(1));
        CHECK(glm::dot(frame.aside, frame.along) == Approx(0).margin(1e-5));
        CHECK(glm::length(frame.up()) == Approx(1));
    }
    CHECK(path.frame(-1).place == path.frame(0).place);
    CHECK(path.frame(path.end() + 1).place == path.frame(path.end()).place);
}

TEST_CASE("a ribbon takes directions with the sign that turns it less", "[view][ribbon]") {
    RibbonPath path = straight(6);
    path.turn(std::array{y, -y, y, unknown, -y, -y});

    for (float u = 0; u <= 5; u += 0.25F) CHECK(path.frame(u).aside.y > 0.999F);
}

TEST_CASE("what a ribbon has to turn is shared out where its direction is not known",
          "[view][ribbon]") {
    RibbonPath path = straight(8);

    SECTION("a quarter turn over five steps") {
        path.turn(std::array{unknown, y, unknown, unknown, unknown, unknown, z, unknown});

        const auto turned_deg = [&](float u) {
            const glm::vec3 aside = path.frame(u).aside;
            return glm::degrees(std::atan2(aside.z, aside.y));
        };
        CHECK(turned_deg(0) == Approx(0).margin(1e-3));
        for (int i = 1; i <= 6; ++i)
            CHECK(turned_deg(static_cast<float>(i)) == Approx(18 * (i - 1)).margin(6));
        CHECK(turned_deg(7) == Approx(90).margin(1e-3));
    }
    SECTION("nothing is known") {
        path.turn(std::vector<glm::vec3>(8, unknown));
        for (float u = 0; u < 7; u += 0.5F)
            CHECK(glm::dot(path.frame(u).aside, path.frame(u + 0.5F).aside) > 0.999F);
    }
    SECTION("what is known is along the path, so of no use") {
        path.turn(std::vector<glm::vec3>(8, glm::vec3(1, 0, 0)));
        for (float u = 0; u < 7; u += 0.5F) CHECK(glm::length(path.frame(u).aside) == Approx(1));
    }
}
