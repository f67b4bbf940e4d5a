#include "ecs/world.h"
#include "simulation/resources.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <span>
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

std::vector<int> numbers_in_order(const World& world) {
    std::vector<int> numbers;
    world.each<Number>([&](Entity, const Number& number) { numbers.push_back(number.value); });
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
    copy.write<Name>(first)->text = "b";
    copy.write<Number>().value = 6;
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
    CHECK(world.resource<Number>().value == 12);
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

    const World& reads = world;
    world.write_each<Number, Name, Mark>(
        [&](Entity entity, Number& number, const Name& name, const Mark&) {
            visited.push_back(entity);
            CHECK(name.text == std::to_string(number.value));
            number.value += 100;
        });

    CHECK(visited == std::vector{entities[3], entities[5]});
    int sum = 0;
    reads.each<Number, Mark>(
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

    world.each<Number, Unused>([&](Entity, const Number&, const Unused&) { ++visits; });
    world.write_each<Unused>([&](Entity, Unused&) { ++visits; });

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

namespace {

// A world, and what it should hold.
struct Checked {
    struct Modelled {
        std::optional<int> number;
        std::optional<std::string> name;
    };
    using Model = std::map<Entity, Modelled>;

    World world;
    Model model, before;
    int resource = 0, resource_before = 0;
};

void check(const Checked& c, const std::vector<Entity>& ever) {
    REQUIRE(c.world.entity_count() == c.model.size());
    REQUIRE(c.world.resource<Number>().value == c.resource);
    std::set<Entity> with_both;
    for (const Entity any : ever) {
        const auto found = c.model.find(any);
        REQUIRE(c.world.is_alive(any) == (found != c.model.end()));
        const Number* const number = c.world.find<Number>(any);
        const Name* const name = c.world.find<Name>(any);
        const Checked::Modelled expected =
            found == c.model.end() ? Checked::Modelled{} : found->second;
        REQUIRE((number ? std::optional(number->value) : std::nullopt) == expected.number);
        REQUIRE((name ? std::optional(name->text) : std::nullopt) == expected.name);
        if (expected.number && expected.name) with_both.insert(any);
    }
    std::vector<Entity> visited;
    c.world.each<Name, Number>([&](Entity visit, const Name& name, const Number& number) {
        visited.push_back(visit);
        REQUIRE(c.model.at(visit).name == name.text);
        REQUIRE(c.model.at(visit).number == number.value);
    });
    REQUIRE(visited == std::vector(with_both.begin(), with_both.end()));
}

// Changes one entity of the world and of its model.
void change(Checked& c, Entity entity, int step, std::mt19937& random) {
    const auto living = c.model.find(entity);
    const bool lives = living != c.model.end();
    switch (random() % 7) {
        case 0:
            c.world.destroy(entity);
            if (lives) c.model.erase(living);
            break;
        case 1:
            c.world.remove<Number>(entity);
            if (lives) living->second.number.reset();
            break;
        case 2:
            c.world.remove<Name>(entity);
            if (lives) living->second.name.reset();
            break;
        case 3:
            if (!lives) break;
            living->second.number = step;
            c.world.set(entity, Number{step});
            break;
        case 4:
            if (!lives) break;
            living->second.name = std::to_string(step);
            c.world.set(entity, Name{std::to_string(step)});
            break;
        case 5:
            c.resource = step;
            random() % 2 == 0 ? (void)c.world.set_resource(Number{step})
                              : (void)(c.world.write<Number>().value = step);
            break;
        default:
            if (Number* const number = c.world.write<Number>(entity)) number->value = -step;
            if (lives && living->second.number) living->second.number = -step;
    }
}

}  // namespace

TEST_CASE("worlds, their copies and transactions do what plain maps of entities would do",
          "[ecs][world]") {
    std::vector<Checked> worlds(1);
    worlds[0].world.set_resource(Number{0});
    std::set<Entity> ever;  // dead ones too
    std::mt19937 random(GENERATE(1, 2, 3, 4));
    std::vector<bool> is_open(8, false);

    for (int step = 0; step < 8000; ++step) {
        Checked& c = worlds[random() % worlds.size()];
        const auto index = static_cast<std::size_t>(&c - worlds.data());
        const auto what = random() % 40;
        if (what < 8 || ever.empty()) {
            const Entity entity = c.world.create();
            REQUIRE(c.model.try_emplace(entity).second);
            ever.insert(entity);
        } else if (what == 8) {
            Checked copy = c;  // in no transaction
            if (worlds.size() < is_open.size()) {
                worlds.push_back(std::move(copy));
            } else if (const std::size_t other = random() % worlds.size(); !is_open[other]) {
                worlds[other] = std::move(copy);
            }
        } else if (what == 9 && !is_open[index]) {
            c.world.begin();
            c.before = c.model;
            c.resource_before = c.resource;
            is_open[index] = true;
        } else if (what == 10 && is_open[index]) {
            c.world.commit();
            is_open[index] = false;
        } else if (what == 11 && is_open[index]) {
            c.world.roll_back();
            c.model = c.before;
            c.resource = c.resource_before;
            is_open[index] = false;
        } else if (what > 11) {
            // Mostly late ones, so that living and dead handles are both met often.
            const auto back = std::min<std::size_t>(1 + random() % 40, ever.size());
            change(c, *std::prev(ever.end(), static_cast<std::ptrdiff_t>(back)), step, random);
        }
        if (step % 100 != 0) continue;
        INFO("step " << step);
        const std::vector<Entity> all(ever.begin(), ever.end());
        for (const Checked& one : worlds) check(one, all);
    }
    CHECK(ever.size() > 100);
}

namespace {

struct Cached {
    int value = 0;
    std::shared_ptr<int> cache;

    Cached without_caches() const { return {value, {}}; }
};

}  // namespace

TEST_CASE("a transaction that is rolled back keeps no caches, and the present keeps its own",
          "[ecs][world]") {
    World world;
    world.set_resource(Cached{1, std::make_shared<int>(5)});
    const Cached* const at = &world.resource<Cached>();

    world.begin();
    world.write<Cached>().value = 2;
    CHECK(&world.resource<Cached>() == at);
    CHECK(world.resource<Cached>().cache);
    world.roll_back();

    CHECK(world.resource<Cached>().value == 1);
    CHECK_FALSE(world.resource<Cached>().cache);
    world.set_resource(Cached{3, std::make_shared<int>(5)});
    world.begin();
    world.roll_back();
    CHECK(world.resource<Cached>().cache);  // nobody wrote it
}

TEST_CASE("a copy that a transaction shares components with keeps their caches", "[ecs][world]") {
    World world;
    world.set_resource(Cached{1, std::make_shared<int>(5)});
    const World copy = world;

    world.begin();
    world.write<Cached>().value = 2;
    CHECK(world.resource<Cached>().cache);
    world.roll_back();

    CHECK(world.resource<Cached>().value == 1);
    CHECK(copy.resource<Cached>().value == 1);
    CHECK(copy.resource<Cached>().cache);
}

TEST_CASE("reading shares, writing copies the components of one type", "[ecs][world]") {
    World world;
    const Entity entity = world.create();
    world.set(entity, Name{"a"});
    world.set(entity, Number{1});
    World copy = world;

    CHECK(copy.find<Name>(entity) == world.find<Name>(entity));
    copy.write<Name>(entity)->text = "b";

    CHECK(copy.find<Name>(entity) != world.find<Name>(entity));
    CHECK(copy.find<Number>(entity) == world.find<Number>(entity));
}

TEST_CASE("memory of worlds counts once what they share", "[ecs][world]") {
    World world;
    world.set(world.create(), Number{1});
    World copy = world;
    const World* const both[] = {&world, &copy};
    const std::size_t one = World::count_bytes(std::span(both).first(1));

    CHECK(one == sizeof(Number) + sizeof(Entity));
    CHECK(World::count_bytes(both) == one);
    copy.write_each<Number>([](Entity, Number& number) { number.value = 2; });
    CHECK(World::count_bytes(both) == 2 * one);
}
