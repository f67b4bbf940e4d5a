// A step that fails leaves the world as it was, whatever its systems wrote: this program has the
// engine's own step.cpp with a system more that writes anything.
#include "loading/load.h"
#include "scene/read_scene.h"
#include "simulation/grip_queries.h"
#include "simulation/resources.h"
#include "simulation/step.h"
#include "tests/simulation/failing_step/write_anything.h"
#include "tests/support/paths.h"
#include "tests/support/water_scene.h"
#include "tests/support/world_bytes.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr int entities = 100'000;

World with_tags(World world) {
    for (int i = 0; i < entities; ++i) {
        const Entity entity = world.create();
        if (i % 3 != 0) world.set(entity, Tag{i, std::vector<double>(i % 4, 0.5 * i)});
    }
    return world;
}

// Everything but the report of the step and the caches of the mechanics.
std::string bytes_of(const World& world) {
    std::string bytes = test::world_bytes(world);
    const auto add = [&](const auto& value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    const Clock& clock = world.resource<Clock>();
    add(clock.period_s);
    add(clock.steps);
    add(clock.resets);
    add(world.entity_count());
    world.each<Hand>([&](Entity hand, const Hand& at) {
        add(hand);
        for (const double value : at.travel_m) add(value);
    });
    world.each<Tag>([&](Entity entity, const Tag& tag) {
        add(entity);
        add(tag.number);
        for (const double value : tag.values) add(value);
    });
    return bytes;
}

HandPose hand_at(double mm) {
    HandPose hand;
    hand.travel_m = Vec3(1e-3 * mm, 0, 0);
    return hand;
}

bool step(World& world, double mm) {
    return step_world(world, hand_at(mm), contact_at(world, 0).model).finite;
}

}  // namespace

TEST_CASE("a step that fails restores every component and resource", "[simulation][step]") {
    const std::string method = GENERATE("rigid", "second-order", "quasi-static");
    CAPTURE(method);
    std::vector<std::string> settings{"statics.method=" + method};
    if (method == "quasi-static") settings.emplace_back("statics.active=12");
    World world = with_tags(
        load_world(method == "rigid" ? test::water_scene({"mode=4"})
                                     : read_scene(test::test_data("two_peptides"), settings)));
    world.set_resource(Scribbler{{}, false});
    for (int i = 0; i < 3; ++i) REQUIRE(step(world, 0.1 * i));

    for (std::uint32_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        world.set_resource(Scribbler{std::mt19937(seed), true});
        const std::string before = bytes_of(world);
        const World copy = world;

        CHECK_FALSE(step(world, 0.4));

        CHECK(bytes_of(world) == before);
        CHECK(bytes_of(copy) == before);
        CHECK(world.resource<Scribbler>().is_active);
        world.write<Scribbler>().is_active = false;
        CHECK(step(world, 0.4));
        CHECK(bytes_of(copy) == before);
        world = copy;
    }
}
