// The world: entities with their components, and resources. Systems are functions that take a
// World.
#pragma once
#include "core/assertion.h"
#include "core/shared_vector.h"
#include "ecs/entity.h"
#include "ecs/pool.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace palpa {

// Components and resources are found by their C++ type. find, each and resource read; write and set
// change. A copy of a world is independent of it and cheap: both share the components of a type
// until one of them writes that type. Pointers and references to components of a type are good
// until the world is copied, begins a transaction, or adds or removes one of that type.
// Not for several threads at once: one thread owns a world; another may own a copy.
class World {
public:
    World() = default;
    World(const World& other) : now_(other.now_) {}
    World(World&&) noexcept = default;
    World& operator=(const World& other) { return *this = World(other); }
    World& operator=(World&& other) noexcept {
        now_ = std::move(other.now_);
        return *this;
    }
    ~World() = default;

    Entity create();

    // Destroys the entity and its components; its handle is dead from then on. A dead handle is
    // ignored.
    void destroy(Entity entity);

    bool is_alive(Entity entity) const noexcept {
        return std::binary_search(now_.entities.begin(), now_.entities.end(), entity);
    }

    std::size_t entity_count() const noexcept { return now_.entities.size(); }

    // Adds or replaces a component. The entity must be alive.
    template <class Component>
    Component& set(Entity entity, Component component) {
        PALPA_ASSERT(is_alive(entity));
        return set_in_pool(entity, std::move(component));
    }

    template <class Component>
    void remove(Entity entity) {
        if (entity != no_one) remove_from_pool(type_number<Component>(), entity);
    }

    // The entity's component, or null if it has none or is dead.
    template <class Component>
    const Component* find(Entity entity) const noexcept {
        const Pool<Component>* const pool = find_pool<Component>();
        return pool && entity != no_one ? pool->find(entity) : nullptr;
    }
    // The same for writing.
    template <class Component>
    Component* write(Entity entity) {
        return entity != no_one && find<Component>(entity) ? write_pool<Component>()->find(entity)
                                                           : nullptr;
    }

    // Calls visit(entity, first, rest...) for every entity that has all the components named, in
    // the order of creation. `visit` must not add or remove components, nor write these.
    template <class First, class... Rest, class Visit>
    void each(Visit&& visit) const {
        visit_all(visit, std::tuple(find_pool<First>(), find_pool<Rest>()...));
    }
    // The same, with the first component for writing.
    template <class First, class... Rest, class Visit>
    void write_each(Visit&& visit) {
        visit_all(visit, std::tuple(write_pool<First>(), find_pool<Rest>()...));
    }

    // Resources exist once per type: a clock, settings, tables.
    template <class Resource>
    Resource& set_resource(Resource resource) {
        return set_in_pool(no_one, std::move(resource));
    }
    template <class Resource>
    void remove_resource() {
        remove_from_pool(type_number<Resource>(), no_one);
    }
    // Null if there is none.
    template <class Resource>
    const Resource* find_resource() const noexcept {
        const Pool<Resource>* const pool = find_pool<Resource>();
        return pool ? pool->find(no_one) : nullptr;
    }
    // The resource of this type, which must exist.
    template <class Resource>
    const Resource& resource() const noexcept {
        const Resource* const found = find_resource<Resource>();
        PALPA_ASSERT(found);
        return *found;
    }
    // The same two for writing.
    template <class Resource>
    Resource* write_if() {
        return find_resource<Resource>() ? write_pool<Resource>()->find(no_one) : nullptr;
    }
    template <class Resource>
    Resource& write() {
        Resource* const found = write_if<Resource>();
        PALPA_ASSERT(found);
        return *found;
    }

    // Returns a copy in which components with caches (pool.h) lack them. Another thread may be
    // filling the caches meanwhile, and this world goes on with them at the same address.
    World without_caches() const;

    // Begins a transaction: roll_back makes the world what it is now, commit keeps the changes.
    // Components with caches that were written come back without them. The transaction is this
    // variable's: copies are not in it, and assignment does not end it.
    void begin() { before_ = std::make_unique<Content>(now_); }
    void commit() noexcept { before_.reset(); }
    void roll_back() noexcept;

    // The memory of these worlds together, bytes; counts once what they share.
    static std::size_t count_bytes(std::span<const World* const> worlds);

private:
    struct Content {
        Entity last;                    // entity created last
        SharedVector<Entity> entities;  // alive, in the order of creation
        std::vector<std::shared_ptr<AnyPool>> pools;
    };

    template <class Visit, class... Pools>
    static void visit_all(Visit& visit, const std::tuple<Pools*...>& pools) {
        if (!(std::get<Pools*>(pools) && ...)) return;
        const std::array<const AnyPool*, sizeof...(Pools)> all{std::get<Pools*>(pools)...};
        const AnyPool& smallest =
            **std::min_element(all.begin(), all.end(), [](const AnyPool* a, const AnyPool* b) {
                return a->entities().size() < b->entities().size();
            });
        for (const Entity entity : smallest.entities()) {
            if (entity == no_one) continue;
            const std::tuple found(std::get<Pools*>(pools)->find(entity)...);
            std::apply(
                [&](auto*... components) {
                    if ((components && ...)) visit(entity, *components...);
                },
                found);
        }
    }

    static std::size_t next_type_number() noexcept;

    // Component types are numbered in the order in which a program first uses them.
    template <class Component>
    static std::size_t type_number() noexcept {
        static const std::size_t number = next_type_number();
        return number;
    }

    bool has_pool(std::size_t number) const noexcept {
        return number < now_.pools.size() && now_.pools[number];
    }
    // The pool, first copied if another world shares it.
    AnyPool& write_pool(std::size_t number);
    void remove_from_pool(std::size_t number, Entity entity);

    template <class Component>
    const Pool<Component>* find_pool() const noexcept {
        const std::size_t number = type_number<Component>();
        return has_pool(number) ? static_cast<const Pool<Component>*>(now_.pools[number].get())
                                : nullptr;
    }
    template <class Component>
    Pool<Component>* write_pool() {
        const std::size_t number = type_number<Component>();
        return has_pool(number) ? static_cast<Pool<Component>*>(&write_pool(number)) : nullptr;
    }
    template <class Component>
    Component& set_in_pool(Entity entity, Component component) {
        const std::size_t number = type_number<Component>();
        if (number >= now_.pools.size()) now_.pools.resize(number + 1);
        std::shared_ptr<AnyPool>& pool = now_.pools[number];
        // A component that is replaced is not copied if it is the only one.
        const bool is_replaced =
            pool && pool.use_count() > 1 && pool->entities().size() == 1 && pool->has(entity);
        if (!pool || is_replaced) pool = std::make_shared<Pool<Component>>();
        return write_pool<Component>()->set(entity, std::move(component));
    }

    static constexpr Entity no_one{};  // owner of the resources

    Content now_;
    std::unique_ptr<Content> before_;  // at the beginning of the transaction
};

}  // namespace palpa
