#include "view/signs.h"

#include "loading/load.h"
#include "render/renderer.h"
#include "simulation/grip_queries.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "tests/support/gpu.h"
#include "tests/support/held_scene.h"
#include "tests/support/water_scene.h"
#include "view/build_frame.h"
#include "view/orbit_camera.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// A ball in hand at the origin, alone or with one of others on the x axis.
struct Stage {
    HeldMolecule held{.atoms = {0, 1}};
    FrameScene frame{.spheres = {{{0, 0, 0}, 0.5F}}};
    std::vector<ViewLabel> labels;

    void add_other(float x) { frame.spheres.push_back({{x, 0, 0}, 0.5F, glm::vec3(1), 1}); }
};

// From the tail of the arrow to its tip.
glm::vec3 arrow_of(const FrameScene& frame) {
    const ConeShape& shaft = frame.cones.at(0);
    const ConeShape& head = frame.cones.at(1);
    CHECK(shaft.b == head.a);
    CHECK(head.radius_a > shaft.radius_a);
    CHECK(head.radius_b < 0.1F * head.radius_a);
    return head.b - shaft.a;
}

float arrow_length(float nN) {
    Stage stage;
    add_force({nN, 0, 0}, stage.held, stage.frame, stage.labels);
    return glm::length(arrow_of(stage.frame));
}

std::size_t count(const Picture& picture, std::uint32_t pick) {
    return static_cast<std::size_t>(std::ranges::count(picture.picks, pick));
}

}  // namespace

TEST_CASE("the force's arrow grows by one length for each decade, from 1 pN to beyond 10 nN",
          "[view][signs]") {
    const float decade = arrow_length(0.01F);

    CHECK(decade > 0.5F);
    CHECK(arrow_length(0.1F) == Approx(2 * decade));
    CHECK(arrow_length(0.6F) == Approx((3 + std::log10(0.6F)) * decade));
    CHECK(arrow_length(3) == Approx((3 + std::log10(3.0F)) * decade));
    CHECK(arrow_length(10) == Approx(4 * decade));
    CHECK(arrow_length(50) > arrow_length(10));

    Stage none;
    add_force({9e-4F, 0, 0}, none.held, none.frame, none.labels);
    add_force({0, 0, 0}, none.held, none.frame, none.labels);
    CHECK(none.frame.cones.empty());
    CHECK(none.labels.empty());
}

TEST_CASE("a ring and a label for each decade stand where the arrow would end at that force",
          "[view][signs]") {
    Stage stage;
    add_force({0, 20, 0}, stage.held, stage.frame, stage.labels);

    const glm::vec3 tail = stage.frame.cones.at(0).a;
    std::vector<std::string> texts;
    for (const ViewLabel& label : stage.labels) {
        texts.push_back(label.text);
        if (!label.is_tick) continue;
        CHECK(glm::length(label.place - tail) ==
              Approx(arrow_length(std::stof(label.text))).epsilon(1e-3));
        const auto is_ring = [&](const ConeShape& cone) {
            return cone.a == label.place && cone.radius_a > stage.frame.cones[0].radius_a;
        };
        CHECK(std::ranges::count_if(stage.frame.cones, is_ring) == 2);  // both sides of a disc
    }
    CHECK(texts == std::vector<std::string>{"0.01", "0.1", "1", "20 nN"});
}

TEST_CASE("the arrow begins and ends outside of all atoms, where there is room", "[view][signs]") {
    Stage stage;
    const auto x_of = [&](float nN) {
        stage.frame.cones.clear();
        add_force({nN, 0, 0}, stage.held, stage.frame, stage.labels);
        return std::pair(stage.frame.cones[0].a.x, stage.frame.cones[1].b.x);
    };

    SECTION("alone: away from the molecule, the way it points") {
        const auto [tail, tip] = x_of(1);
        CHECK(tail > 0.5F);
        CHECK(tip > tail);
    }
    SECTION("drawn to another: from behind") {
        stage.add_other(3);
        const auto [tail, tip] = x_of(1);
        CHECK(tip < -0.5F);
        CHECK(tail < tip);
    }
    SECTION("pushed off from another: away") {
        stage.add_other(3);
        const auto [tail, tip] = x_of(-1);
        CHECK(tail < -0.5F);
        CHECK(tip < tail);
    }
    SECTION("between two: where there is more room") {
        stage.add_other(1.8F);
        stage.add_other(-3.8F);
        CHECK(x_of(1).first < -0.5F);
        CHECK(x_of(-1).first < -0.5F);
    }
    SECTION("beyond other atoms of the molecule in hand that stand in the way") {
        stage.held.atoms = {0, 3};
        stage.frame.spheres.push_back({{1.5F, 0.2F, 0}, 0.5F, glm::vec3(1), 1});
        stage.frame.spheres.push_back({{3, 0, 0}, 0.5F, glm::vec3(1), 2});
        CHECK(x_of(1).first > 3.5F);
    }
}

TEST_CASE("the torque is an arc about its axis, right-handed, longer by 60° for each decade",
          "[view][signs]") {
    Stage stage;
    const glm::vec3 axis = glm::normalize(glm::vec3(1, 2, -0.5F));
    // The angle from the arc's first piece to the tip of its head, going round with the torque.
    const auto sweep = [&](float angstrom_nN) {
        stage.frame = {.spheres = {{{0, 0, 0}, 0.5F}}};
        add_torque(angstrom_nN * axis, stage.held, stage.frame, stage.labels);
        double turned = 0;
        glm::vec3 centre(0);
        for (std::size_t i = 1; i < stage.frame.cones.size(); ++i) {
            const ConeShape& piece = stage.frame.cones[i];
            centre = glm::dot(piece.a, axis) * axis;
            CHECK(glm::length(piece.a) > 0.5F);
            const glm::vec3 from = glm::normalize(piece.a - centre);
            const glm::vec3 to = glm::normalize(piece.b - glm::dot(piece.b, axis) * axis);
            turned += std::atan2(glm::dot(glm::cross(from, to), axis), glm::dot(from, to));
        }
        CHECK(glm::dot(centre, axis) > 0.5F);  // beyond the ball
        return turned * 180 / 3.14159265;
    };

    // The head is straight, so it turns a little less than its arc would.
    CHECK(sweep(0.01F) == Approx(60).margin(8));
    CHECK(sweep(1) == Approx(180).margin(8));
    CHECK(sweep(1e6F) == Approx(330).margin(8));
    CHECK(sweep(10) == Approx(240).margin(8));
    CHECK(stage.labels.back().text == "10 nN Å");
    stage.frame.cones.clear();
    add_torque({0, 0, 5e-4F}, stage.held, stage.frame, stage.labels);
    CHECK(stage.frame.cones.empty());
}

TEST_CASE("the wish of a hand is a dashed thread to a ring that faces the eye", "[view][signs]") {
    FrameScene frame;
    add_wish({1, 2, 3}, {1, 2, 3.05F}, {0, 0, 1}, frame);
    CHECK((frame.spheres.empty() && frame.cones.empty()));

    add_wish({1, 2, 3}, {1, 6, 3}, {0, 0, 1}, frame);

    std::vector<float> ends;  // of the dashes, along the thread
    for (const ConeShape& cone : frame.cones) {
        CHECK(cone.pick == wish_pick);
        if (cone.a.x == 1 && cone.b.x == 1 && cone.a.z == 3) {
            ends.insert(ends.end(), {cone.a.y, cone.b.y});
        } else {
            CHECK(cone.a.z == Approx(3));
            CHECK(glm::distance(cone.a, {1, 6, 3}) == Approx(0.5));
        }
    }
    REQUIRE(ends.size() >= 10);
    CHECK(ends.front() == Approx(2));
    CHECK(ends.back() == Approx(5.5));
    for (std::size_t i = 2; i < ends.size(); i += 2) CHECK(ends[i] > ends[i - 1] + 0.05F);
}

TEST_CASE("hydrogen bonds are dashes between the atoms as drawn, with their lengths in Å",
          "[view][signs]") {
    World world = load_world(test::water_scene());
    move_grabbed(world, 2.9);
    std::vector<ViewLabel> labels;
    const FrameScene frame =
        build_frame(world, std::array{contact_at(world, 0).model}, {.force_arrow = false}, &labels);

    REQUIRE(labels.size() == 1);
    const auto places_of = [&](const char* name) {
        return points_of(world.resource<AtomTable>(), test::range_called(world, name)).positions;
    };
    const auto moved = places_of("moved"), fixed = places_of("fixed");
    const double length = std::min((moved[1] - fixed[0]).norm(), (moved[2] - fixed[0]).norm());
    CHECK(length == Approx(2.9 - 0.957).margin(0.01));
    CHECK(labels[0].text == fmt::format("{:.2f} Å", length));
    std::size_t dashes = 0;
    for (const ConeShape& cone : frame.cones) {
        if (cone.pick != hydrogen_bond_pick) continue;
        ++dashes;
        for (const SphereShape& atom : frame.spheres) {
            CHECK(glm::distance(cone.a, atom.centre) > atom.radius);
            CHECK(glm::distance(cone.b, atom.centre) > atom.radius);
        }
    }
    CHECK(dashes >= 3);
    const FrameScene without =
        build_frame(world, {.force_arrow = false, .hydrogen_bonds = ShownBonds::None});
    CHECK(without.cones.size() == 4);
}

TEST_CASE("in attraction and in repulsion the arrow is plain to see, and repulsion is longer",
          "[view][signs][gpu]") {
    GpuDevice device(test::validated());
    Renderer renderer(device);
    World world = load_world(test::water_scene());
    const auto pixels = [&](double distance) {
        move_grabbed(world, distance);
        FrameScene frame = build_frame(world, {});
        OrbitCamera camera;
        frame_all(camera, frame, 1280.0F / 720);
        frame.camera = frame_camera(camera, frame);
        return count(renderer.draw(frame, 1280, 720), arrow_pick);
    };

    const std::size_t drawn_in = pixels(3.1), pushed_off = pixels(2.5);
    CHECK(drawn_in > 150);
    CHECK(pushed_off > drawn_in);
    test::check_silent(device);
}
