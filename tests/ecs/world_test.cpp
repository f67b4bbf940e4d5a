#include "ecs/world.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace palpa;

namespace {

struct Number {
    int value = 0;
};
struct Name {
    std::string text;
};
struct Mark {};

std::vector<int> numbers_in_order(World& world) {
    std::vector<int> numbers;
    world.each<Number>([&](Entity, Number& number) { numbers.push_back(number.value); });
    return numbers;
}

}  // namespace

TEST_CASE("the default handle names nothing", "[ecs][world]") {
    World world;

    CHECK_FALSE(world.is_alive({}));
    const Entity first = world.create();
    CHECK_FALSE(world.is_alive({}));
    CHECK(world.is_alive(first));
    CHECK(first != Entity{});
}

TEST_CASE("a handle dies with its entity, even when its index is used again", "[ecs][world]") {
    World world;
    const Entity old = world.create();
    world.set(old, Number{1});

    world.destroy(old);
    const bool alive_between = world.is_alive(old);
    const Entity young = world.create();

    CHECK_FALSE(alive_between);
    REQUIRE(young.index == old.index);
    CHECK(young.generation != old.generation);
    CHECK(world.is_alive(young));
    CHECK_FALSE(world.is_alive(old));
    // The component went with the old entity.
    CHECK(world.find<Number>(young) == nullptr);
    CHECK(world.find<Number>(old) == nullptr);
}

TEST_CASE("a handle of the next generation is dead until it is handed out", "[ecs][world]") {
    World world;
    const Entity old = world.create();
    const Entity other_index{old.index + 1, 1};
    const Entity next{old.index, old.generation + 1};

    CHECK_FALSE(world.is_alive(next));
    CHECK_FALSE(world.is_alive(other_index));
    world.destroy(old);
    CHECK(world.entity_count() == 0);
    CHECK(world.create() == next);
}

TEST_CASE("what is done to a dead handle does not touch the one that has its index now",
          "[ecs][world]") {
    World world;
    const Entity old = world.create();
    world.destroy(old);
    const Entity young = world.create();
    world.set(young, Number{7});

    world.remove<Number>(old);
    world.destroy(old);
    world.destroy(old);

    CHECK(world.is_alive(young));
    CHECK(world.entity_count() == 1);
    REQUIRE(world.find<Number>(young));
    CHECK(world.find<Number>(young)->value == 7);
    CHECK(world.find<Number>(old) == nullptr);
}

TEST_CASE("setting a component again replaces it", "[ecs][world]") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Number{1});

    world.set(entity, Number{2}).value += 10;

    CHECK(numbers_in_order(world) == std::vector{12});
    world.remove<Number>(entity);
    world.remove<Number>(entity);
    CHECK(world.find<Number>(entity) == nullptr);
    CHECK(world.is_alive(entity));
}

TEST_CASE("components stay packed: the last one fills the gap of a removed one", "[ecs][pool]") {
    World world;
    std::vector<Entity> entities;
    for (int i = 0; i < 5; ++i) {
        entities.push_back(world.create());
        world.set(entities.back(), Number{i});
    }

    world.remove<Number>(entities[1]);
    CHECK(numbers_in_order(world) == std::vector{0, 4, 2, 3});
    world.destroy(entities[3]);
    CHECK(numbers_in_order(world) == std::vector{0, 4, 2});
    world.destroy(entities[0]);
    CHECK(numbers_in_order(world) == std::vector{2, 4});

    CHECK(world.find<Number>(entities[4])->value == 4);
    CHECK(world.find<Number>(entities[2])->value == 2);
    CHECK(world.entity_count() == 3);
}

TEST_CASE("components may own what cannot be copied, and let go of it", "[ecs][pool]") {
    World world;
    const auto shared = std::make_shared<int>(3);
    const Entity first = world.create(), second = world.create();
    world.set(first, std::make_unique<std::shared_ptr<int>>(shared));
    world.set(second, std::make_unique<std::shared_ptr<int>>(shared));
    REQUIRE(shared.use_count() == 3);

    world.destroy(first);

    CHECK(shared.use_count() == 2);
    CHECK(***world.find<std::unique_ptr<std::shared_ptr<int>>>(second) == 3);
}

TEST_CASE("a query visits the entities that have all components, in the smallest pool's order",
          "[ecs][world]") {
    World world;
    std::vector<Entity> entities;
    for (int i = 0; i < 6; ++i) {
        entities.push_back(world.create());
        world.set(entities.back(), Number{i});
    }
    for (const int i : {5, 0, 2, 3}) world.set(entities[i], Name{std::to_string(i)});
    for (const int i : {3, 1, 5}) world.set(entities[i], Mark{});
    std::vector<Entity> visited;

    world.each<Number, Name, Mark>([&](Entity entity, Number& number, const Name& name, Mark&) {
        visited.push_back(entity);
        CHECK(name.text == std::to_string(number.value));
        number.value += 100;
    });

    CHECK(visited == std::vector{entities[3], entities[5]});
    CHECK(world.find<Number>(entities[3])->value == 103);
    CHECK(world.find<Number>(entities[2])->value == 2);
}

TEST_CASE("a query over a type that nothing has visits nothing", "[ecs][world]") {
    struct Unused {};
    World world;
    world.set(world.create(), Number{1});
    int visits = 0;

    world.each<Number, Unused>([&](Entity, Number&, Unused&) { ++visits; });
    world.each<Unused>([&](Entity, Unused&) { ++visits; });

    CHECK(visits == 0);
}

TEST_CASE("two worlds share nothing", "[ecs][world]") {
    World one, two;
    const Entity in_one = one.create(), in_two = two.create();
    REQUIRE(in_one == in_two);

    one.set(in_one, Number{1});

    CHECK(two.find<Number>(in_two) == nullptr);
    one.destroy(in_one);
    CHECK(two.is_alive(in_two));
}

TEST_CASE("a world does what a plain map of entities would do", "[ecs][world]") {
    struct Modelled {
        std::optional<int> number;
        std::optional<std::string> name;
    };
    World world;
    std::map<Entity, Modelled> model;
    std::vector<Entity> ever;  // dead ones too
    std::mt19937 random(GENERATE(1, 2, 3));

    for (int step = 0; step < 4000; ++step) {
        const bool create = ever.empty() || random() % 5 == 0;
        if (create) {
            const Entity entity = world.create();
            REQUIRE(model.try_emplace(entity).second);
            ever.push_back(entity);
            continue;
        }
        // Mostly late ones, so that living and dead handles are both met often.
        const std::size_t back = std::min<std::size_t>(random() % 40, ever.size() - 1);
        const Entity entity = ever[ever.size() - 1 - back];
        const auto living = model.find(entity);
        switch (random() % 5) {
            case 0:
                world.destroy(entity);
                if (living != model.end()) model.erase(living);
                break;
            case 1:
                world.remove<Number>(entity);
                if (living != model.end()) living->second.number.reset();
                break;
            case 2:
                world.remove<Name>(entity);
                if (living != model.end()) living->second.name.reset();
                break;
            case 3:
                if (living == model.end()) break;
                living->second.number = step;
                world.set(entity, Number{step});
                break;
            default:
                if (living == model.end()) break;
                living->second.name = std::to_string(step);
                world.set(entity, Name{std::to_string(step)});
                break;
        }
        if (step % 50 != 0) continue;

        INFO("step " << step);
        REQUIRE(world.entity_count() == model.size());
        std::set<Entity> with_both;
        for (const Entity any : ever) {
            const auto found = model.find(any);
            REQUIRE(world.is_alive(any) == (found != model.end()));
            const Number* const number = world.find<Number>(any);
            const Name* const name = world.find<Name>(any);
            const Modelled expected = found == model.end() ? Modelled{} : found->second;
            REQUIRE((number ? std::optional(number->value) : std::nullopt) == expected.number);
            REQUIRE((name ? std::optional(name->text) : std::nullopt) == expected.name);
            if (expected.number && expected.name) with_both.insert(any);
        }
        std::set<Entity> visited;
        world.each<Name, Number>([&](Entity visit, Name& name, Number& number) {
            REQUIRE(visited.insert(visit).second);
            REQUIRE(model.at(visit).name == name.text);
            REQUIRE(model.at(visit).number == number.value);
        });
        REQUIRE(visited == with_both);
    }
    CHECK(ever.size() > 500);
    CHECK(model.size() < ever.size());
}
