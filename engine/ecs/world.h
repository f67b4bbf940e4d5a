// All entities and their components. Systems are functions that take a World.
#pragma once
#include "core/assertion.h"
#include "ecs/entity.h"
#include "ecs/pool.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace palpa {

// Components are found by their C++ type. Not for several threads at once: one thread owns a world.
class World {
public:
    Entity create();

    // The entity's components go with it; its handle is dead from now on. A dead handle is ignored.
    void destroy(Entity entity);

    bool is_alive(Entity entity) const noexcept {
        return entity.index < generations_.size() && entity.generation != 0 &&
               generations_[entity.index] == entity.generation;
    }

    std::size_t entity_count() const noexcept { return generations_.size() - free_.size(); }

    // The entity must be alive. References stay good until the pool of that type grows or shrinks.
    template <class Component>
    Component& set(Entity entity, Component component) {
        PALPA_ASSERT(is_alive(entity));
        return pool<Component>().set(entity, std::move(component));
    }

    template <class Component>
    void remove(Entity entity) {
        if (is_alive(entity)) pool<Component>().remove(entity.index);
    }

    // The entity's component, or null if it has none or is dead.
    template <class Component>
    Component* find(Entity entity) noexcept {
        return const_cast<Component*>(std::as_const(*this).template find<Component>(entity));
    }
    template <class Component>
    const Component* find(Entity entity) const noexcept {
        const Pool<Component>* components = find_pool<Component>();
        return components && is_alive(entity) ? components->find(entity.index) : nullptr;
    }

    // Calls visit(entity, first, rest...) for every entity that has all the components named, in
    // the packed order of the smallest pool. `visit` must not add or remove components.
    template <class First, class... Rest, class Visit>
    void each(Visit&& visit) {
        Pool<First>* const first = &pool<First>();
        std::array<const AnyPool*, 1 + sizeof...(Rest)> pools{first, &pool<Rest>()...};
        const AnyPool& smallest =
            **std::min_element(pools.begin(), pools.end(), [](const AnyPool* a, const AnyPool* b) {
                return a->entities().size() < b->entities().size();
            });
        for (const Entity entity : smallest.entities()) {
            visit_if_complete<First, Rest...>(visit, entity, first->find(entity.index),
                                              pool<Rest>().find(entity.index)...);
        }
    }

private:
    template <class... Components, class Visit>
    static void visit_if_complete(Visit& visit, Entity entity, Components*... components) {
        if ((components && ...)) visit(entity, *components...);
    }

    static std::size_t next_type_number() noexcept;

    // Component types are numbered in the order in which a program first uses them.
    template <class Component>
    static std::size_t type_number() noexcept {
        static const std::size_t number = next_type_number();
        return number;
    }

    template <class Component>
    Pool<Component>& pool() {
        const std::size_t number = type_number<Component>();
        if (number >= pools_.size()) pools_.resize(number + 1);
        if (!pools_[number]) pools_[number] = std::make_unique<Pool<Component>>();
        return static_cast<Pool<Component>&>(*pools_[number]);
    }

    template <class Component>
    const Pool<Component>* find_pool() const noexcept {
        const std::size_t number = type_number<Component>();
        if (number >= pools_.size()) return nullptr;
        return static_cast<const Pool<Component>*>(pools_[number].get());
    }

    std::vector<std::uint32_t> generations_;  // by entity index; 1 at first use
    std::vector<std::uint32_t> free_;         // indices of destroyed entities
    std::vector<std::unique_ptr<AnyPool>> pools_;
};

}  // namespace palpa
