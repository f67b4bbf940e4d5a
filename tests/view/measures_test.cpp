#include "view/measures.h"

#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "simulation/select_in_world.h"
#include "tests/support/held_scene.h"
#include "tests/support/load_error_of.h"
#include "tests/support/water_scene.h"
#include "view/build_frame.h"
#include "view/palette.h"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

using namespace palpa;
using Catch::Contains;
using test::load_error_of;

namespace {

struct Drawn {
    FrameScene frame;
    std::vector<ViewLabel> labels;
};

Drawn draw(const std::vector<Vec3>& places) {
    Drawn drawn;
    add_measure(places, drawn.frame, drawn.labels);
    return drawn;
}

// Ends of the arc's pieces, all as far from its centre.
std::vector<glm::vec3> arc_of(const Drawn& drawn, const glm::vec3& centre) {
    std::vector<glm::vec3> places;
    for (const SphereShape& ball : drawn.frame.spheres) {
        CHECK(ball.pick == measure_pick);
        CHECK(glm::distance(ball.centre, centre) ==
              Approx(glm::distance(drawn.frame.spheres[0].centre, centre)));
        places.push_back(ball.centre);
    }
    return places;
}

}  // namespace

TEST_CASE("two places have dashes from one to the other, and the distance in their middle",
          "[view][measures]") {
    const Drawn drawn = draw({{1, 2, 3}, {1, 5, 7}});  // 3, 4, 5

    REQUIRE(drawn.labels.size() == 1);
    CHECK(drawn.labels[0].text == "5.00 Å");
    CHECK(drawn.labels[0].place == glm::vec3(1, 3.5F, 5));
    REQUIRE(drawn.frame.cones.size() > 8);
    CHECK(drawn.frame.spheres.empty());
    CHECK(drawn.frame.cones.front().a == glm::vec3(1, 2, 3));
    CHECK(glm::distance(drawn.frame.cones.back().b, {1, 5, 7}) < 1e-5F);
    float dashed = 0;
    for (const ConeShape& cone : drawn.frame.cones) {
        CHECK(cone.pick == measure_pick);
        CHECK(cone.colour_a == measure_colour);
        CHECK(cone.is_on_top);
        dashed += glm::distance(cone.a, cone.b);
    }
    CHECK(dashed > 2.5F);
    CHECK(dashed < 3.2F);  // the rest is gaps
}

TEST_CASE("three places have an arc about the second, and their angle beside its middle",
          "[view][measures]") {
    const Drawn drawn = draw({{2, 1, 0}, {0, 1, 0}, {0, 4, 0}});

    REQUIRE(drawn.labels.size() == 1);
    CHECK(drawn.labels[0].text == "90.0°");
    const std::vector<glm::vec3> arc = arc_of(drawn, {0, 1, 0});
    REQUIRE(arc.size() >= 7);
    for (const glm::vec3& place : arc) {
        CHECK(place.x > -1e-5F);  // on the inner side
        CHECK(place.y > 1 - 1e-5F);
        CHECK(place.z == 0);
    }
    const glm::vec3 middle = drawn.labels[0].place - glm::vec3(0, 1, 0);
    CHECK(middle.x == Approx(middle.y));
    CHECK(glm::length(middle) > 0.5F);
    CHECK(draw({{1, 0, 0}, {0, 0, 0}, {-1, 1, 0}}).labels[0].text == "135.0°");
}

TEST_CASE("four places have an arc about the axis, whose sign is IUPAC's", "[view][measures]") {
    // Looking along the axis from the second to the third, +z: the fourth is clockwise from the
    // first by 60°, or the other way.
    const double sign = GENERATE(1, -1);
    const Drawn drawn =
        draw({{1, 0, 0}, {0, 0, 0}, {0, 0, 1.5}, {0.5, sign * std::sqrt(0.75), 1.5}});

    REQUIRE(drawn.labels.size() == 1);
    CHECK(drawn.labels[0].text == (sign > 0 ? "+60.0°" : "-60.0°"));
    for (const glm::vec3& place : arc_of(drawn, {0, 0, 0.75F})) {
        CHECK(place.x > 0.499F * 0.6F);
        CHECK(place.y * static_cast<float>(sign) > -1e-5F);
        CHECK(place.z == Approx(0.75F));
    }
    const glm::vec3 last = drawn.frame.spheres.back().centre;
    CHECK(last.x == Approx(0.3));
    CHECK(last.y == Approx(sign * 0.6 * std::sqrt(0.75)));
}

TEST_CASE("places in line or at one place have a number without an arc", "[view][measures]") {
    CHECK(draw({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).labels[0].text == "180.0°");
    CHECK(draw({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).frame.spheres.empty());
    CHECK(draw({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}}).frame.spheres.empty());
    const Drawn none = draw({{1, 1, 1}, {1, 1, 1}});
    CHECK(none.labels[0].text == "0.00 Å");
    CHECK(none.frame.cones.empty());
}

TEST_CASE("measures of a view follow the atoms, and stand for centres of their atoms",
          "[view][measures]") {
    World world = load_world(test::water_scene());
    ViewSettings settings{.force_arrow = false, .hydrogen_bonds = ShownBonds::None};
    settings.marks.measures = {
        "segment FIX and name OH2; segment MOV and name OH2",
        "segment MOV and name H1;segment MOV and name OH2;segment MOV and name H2",
        "segment FIX; segment MOV"};
    const auto words = [&] {
        std::vector<ViewLabel> labels;
        (void)build_frame(world, settings, &labels);
        std::vector<std::string> texts;
        for (const ViewLabel& label : labels) texts.push_back(label.text);
        return texts;
    };
    const auto centre = [&](const char* name) {
        const AtomRange range = test::range_called(world, name);
        Vec3 sum = Vec3::Zero();
        for (std::uint32_t i = 0; i < 3; ++i)
            sum += world.resource<AtomTable>().positions[range.first + i];
        return Vec3(sum / 3);
    };

    for (const double distance : {2.9, 3.25}) {
        move_grabbed(world, distance);
        const std::vector<std::string> texts = words();
        REQUIRE(texts.size() == 3);
        CHECK(texts[0] == fmt::format("{:.2f} Å", distance));
        CHECK(texts[1] == "104.5°");  // of TIP3P
        CHECK(texts[2] == fmt::format("{:.2f} Å", (centre("fixed") - centre("moved")).norm()));
    }
    settings.marks.measures = {"segment FIX; name XX"};
    CHECK(words().empty());
    ViewDescription view;
    view.marks.measures = settings.marks.measures;
    const std::vector<std::string> empty = find_empty_selections(view, world);
    REQUIRE(empty.size() == 1);
    CHECK_THAT(empty[0], Contains("2nd of view.measure") && Contains("name XX"));
}

TEST_CASE("a measure that is none is refused, with what would be right", "[view][measures]") {
    const World world = load_world(test::water_scene());
    const auto error = [&](const std::string& text) {
        ViewSettings settings;
        settings.marks.measures = {text};
        return load_error_of([&] { (void)build_frame(world, settings); });
    };
    CHECK_THAT(error("name OH2"),
               Contains("view.measure") && Contains("'name OH2'") && Contains("1 selection") &&
                   Contains("two for a distance, three for an angle or four for a dihedral"));
    CHECK_THAT(error("all; all; all; all; all"), Contains("5 selections"));
    CHECK_THAT(error("all; protien"), Contains("view.measure, column 6") && Contains("protein"));
    CHECK_THAT(error("all;"), Contains("view.measure, column 5"));
}
