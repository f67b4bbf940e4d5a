#include "ecs/world.h"
#include "simulation/resources.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
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

TEST_CASE("a handle dies with its entity, and is never given to another", "[ecs][world]") {
    World world;
    const Entity old = world.create();
    world.set(old, Number{1});

    world.destroy(old);
    world.destroy(old);
    const Entity young = world.create();
    world.set(young, Number{7});

    CHECK(young != old);
    CHECK(world.is_alive(young));
    CHECK_FALSE(world.is_alive(old));
    CHECK(world.entity_count() == 1);
    CHECK(world.find<Number>(old) == nullptr);
    world.remove<Number>(old);
    CHECK(world.find<Number>(young)->value == 7);
}

TEST_CASE("a destroyed entity that is restored has its handle and its place again",
          "[ecs][world]") {
    World world;
    std::vector<Entity> entities;
    for (int i = 0; i < 4; ++i) {
        entities.push_back(world.create());
        world.set(entities.back(), Number{i});
    }
    world.destroy(entities[1]);
    CHECK(numbers_in_order(world) == std::vector{0, 2, 3});

    world.restore(entities[1]);

    CHECK(world.is_alive(entities[1]));
    CHECK(world.entity_count() == 4);
    CHECK(world.find<Number>(entities[1]) == nullptr);
    world.set(entities[1], Number{1});
    CHECK(numbers_in_order(world) == std::vector{0, 1, 2, 3});
    world.restore(entities[1]);  // it is alive: nothing happens
    CHECK(world.find<Number>(entities[1])->value == 1);
    CHECK(world.create() > entities[3]);
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

TEST_CASE("components stand in the order of their entities, whatever came and went",
          "[ecs][pool]") {
    World world;
    std::vector<Entity> entities;
    for (int i = 0; i < 5; ++i) entities.push_back(world.create());
    for (const int i : {3, 0, 4, 1, 2}) world.set(entities[i], Number{i});

    CHECK(numbers_in_order(world) == std::vector{0, 1, 2, 3, 4});
    world.remove<Number>(entities[1]);
    CHECK(numbers_in_order(world) == std::vector{0, 2, 3, 4});
    world.destroy(entities[3]);
    CHECK(numbers_in_order(world) == std::vector{0, 2, 4});
    CHECK(world.find<Number>(entities[4])->value == 4);
    CHECK(world.entity_count() == 4);
}

TEST_CASE("a copy of a world is independent of it", "[ecs][world]") {
    World world;
    const Entity first = world.create(), second = world.create();
    world.set(first, Name{"a"});
    world.set_resource(Number{5});

    World copy = world;
    copy.find<Name>(first)->text = "b";
    copy.resource<Number>().value = 6;
    copy.destroy(second);

    CHECK(world.find<Name>(first)->text == "a");
    CHECK(world.resource<Number>().value == 5);
    CHECK(world.is_alive(second));
    world = copy;
    CHECK(world.find<Name>(first)->text == "b");
    CHECK_FALSE(world.is_alive(second));
    const Entity third = world.create();
    CHECK(copy.create() == third);  // what comes next is the same in both
}

TEST_CASE("a resource is there once, and no entity's", "[ecs][world]") {
    World world;
    CHECK(world.find_resource<Number>() == nullptr);
    world.set_resource(Number{1});
    world.set_resource(Number{2}).value += 10;
    world.set(world.create(), Number{3});

    CHECK(world.resource<Number>().value == 12);
    CHECK(numbers_in_order(world) == std::vector{3});
    CHECK(world.find<Number>(Entity{}) == nullptr);
    world.remove<Number>(Entity{});
    CHECK(std::as_const(world).resource<Number>().value == 12);
    world.remove_resource<Number>();
    CHECK(world.find_resource<Number>() == nullptr);
    CHECK(numbers_in_order(world) == std::vector{3});
}

TEST_CASE("a query visits the entities that have all components, in the order of creation",
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
    int sum = 0;
    std::as_const(world).each<Number, Mark>(
        [&](Entity, const Number& number, const Mark&) { sum += number.value; });
    CHECK(sum == 103 + 1 + 105);
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
        std::vector<Entity> visited;
        world.each<Name, Number>([&](Entity visit, Name& name, Number& number) {
            visited.push_back(visit);
            REQUIRE(model.at(visit).name == name.text);
            REQUIRE(model.at(visit).number == number.value);
        });
        REQUIRE(visited == std::vector(with_both.begin(), with_both.end()));
    }
    CHECK(ever.size() > 500);
    CHECK(model.size() < ever.size());
}
