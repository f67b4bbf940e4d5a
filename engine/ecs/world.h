// The world: entities with their components, and resources. Systems are functions that take a
// World.
#pragma once
#include "core/assertion.h"
#include "ecs/entity.h"
#include "ecs/pool.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace palpa {

// Components and resources are found by their C++ type, and can be copied: a copy of a world is
// independent of it. Not for several threads at once: one thread owns a world.
class World {
public:
    World() = default;
    World(const World& other);
    World(World&&) noexcept = default;
    World& operator=(const World& other);
    World& operator=(World&&) noexcept = default;
    ~World() = default;

    Entity create();

    // Destroys the entity and its components; its handle is dead from then on. A dead handle is
    // ignored.
    void destroy(Entity entity);

    // Revives a destroyed entity without components, at its old place in the order.
    void restore(Entity entity);

    bool is_alive(Entity entity) const noexcept {
        return std::binary_search(entities_.begin(), entities_.end(), entity);
    }

    std::size_t entity_count() const noexcept { return entities_.size(); }

    // The entity must be alive. References stay good until the pool of that type grows or shrinks.
    template <class Component>
    Component& set(Entity entity, Component component) {
        PALPA_ASSERT(is_alive(entity));
        return get_pool<Component>().set(entity, std::move(component));
    }

    template <class Component>
    void remove(Entity entity) {
        if (entity == no_one) return;
        if (Pool<Component>* const pool = find_pool<Component>()) pool->remove(entity);
    }

    // The entity's component, or null if it has none or is dead.
    template <class Component>
    Component* find(Entity entity) noexcept {
        Pool<Component>* const pool = find_pool<Component>();
        return pool && entity != no_one ? pool->find(entity) : nullptr;
    }
    template <class Component>
    const Component* find(Entity entity) const noexcept {
        const Pool<Component>* const pool = find_pool<Component>();
        return pool && entity != no_one ? pool->find(entity) : nullptr;
    }

    // Calls visit(entity, first, rest...) for every entity that has all the components named, in
    // the order of creation. `visit` must not add or remove components.
    template <class First, class... Rest, class Visit>
    void each(Visit&& visit) {
        visit_all(visit, std::tuple(find_pool<First>(), find_pool<Rest>()...));
    }
    template <class First, class... Rest, class Visit>
    void each(Visit&& visit) const {
        visit_all(visit, std::tuple(find_pool<First>(), find_pool<Rest>()...));
    }

    // Resources exist once per type: a clock, settings, tables.
    template <class Resource>
    Resource& set_resource(Resource resource) {
        return get_pool<Resource>().set(no_one, std::move(resource));
    }
    template <class Resource>
    Resource* find_resource() noexcept {
        Pool<Resource>* const pool = find_pool<Resource>();
        return pool ? pool->find(no_one) : nullptr;
    }
    template <class Resource>
    const Resource* find_resource() const noexcept {
        const Pool<Resource>* const pool = find_pool<Resource>();
        return pool ? pool->find(no_one) : nullptr;
    }
    template <class Resource>
    void remove_resource() {
        if (Pool<Resource>* const pool = find_pool<Resource>()) pool->remove(no_one);
    }
    // The resource of this type, which must exist.
    template <class Resource>
    Resource& resource() noexcept {
        Resource* const found = find_resource<Resource>();
        PALPA_ASSERT(found);
        return *found;
    }
    template <class Resource>
    const Resource& resource() const noexcept {
        const Resource* const found = find_resource<Resource>();
        PALPA_ASSERT(found);
        return *found;
    }

private:
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

    template <class Component>
    Pool<Component>& get_pool() {
        const std::size_t number = type_number<Component>();
        if (number >= pools_.size()) pools_.resize(number + 1);
        if (!pools_[number]) pools_[number] = std::make_unique<Pool<Component>>();
        return static_cast<Pool<Component>&>(*pools_[number]);
    }
    template <class Component>
    Pool<Component>* find_pool() const noexcept {
        const std::size_t number = type_number<Component>();
        if (number >= pools_.size()) return nullptr;
        return static_cast<Pool<Component>*>(pools_[number].get());
    }

    static constexpr Entity no_one{};  // owner of the resources

    Entity last_;                   // entity created last
    std::vector<Entity> entities_;  // alive, in the order of creation
    std::vector<std::unique_ptr<AnyPool>> pools_;
};

}  // namespace palpa
