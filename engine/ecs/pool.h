// The components of one type, packed without holes in the order of their entities.
#pragma once
#include "ecs/entity.h"

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace palpa {

// A component with parts that can be rebuilt from the rest of the world, such as factors of
// matrices. A transaction keeps the component without them; the caller of roll_back rebuilds them.
template <class Component>
concept HasCaches = requires(const Component& component) {
    { component.without_caches() } -> std::same_as<Component>;
};

// A component that knows how much memory it has beyond its own size.
template <class Component>
concept CountsBytes = requires(const Component& component) {
    { component.count_bytes() } -> std::convertible_to<std::size_t>;
};

// The interface of a pool that does not depend on the component type.
class AnyPool {
public:
    virtual ~AnyPool() = default;

    virtual std::shared_ptr<AnyPool> clone() const = 0;
    virtual std::shared_ptr<AnyPool> clone_without_caches() const = 0;
    virtual bool has_caches() const noexcept = 0;
    // Removes the entity's component, if it has one.
    virtual void remove(Entity entity) = 0;
    // Memory of the components, without what they share with others.
    virtual std::size_t count_bytes() const noexcept = 0;

    bool has(Entity entity) const noexcept { return is_at(place_of(entity), entity); }

    // In the order of their creation.
    std::span<const Entity> entities() const noexcept { return owners_; }

protected:
    // Index of the entity's component in the packed arrays, or where it would be inserted.
    std::size_t place_of(Entity entity) const noexcept {
        return static_cast<std::size_t>(std::lower_bound(owners_.begin(), owners_.end(), entity) -
                                        owners_.begin());
    }
    bool is_at(std::size_t place, Entity entity) const noexcept {
        return place < owners_.size() && owners_[place] == entity;
    }

    std::vector<Entity> owners_;  // owner of each component
};

// Finds entities by bisection; creating them in order appends.
template <class Component>
class Pool final : public AnyPool {
public:
    // Adds the component, or replaces the existing one.
    Component& set(Entity entity, Component component) {
        const std::size_t place = place_of(entity);
        if (is_at(place, entity)) return components_[place] = std::move(component);
        const auto at = static_cast<std::ptrdiff_t>(place);
        owners_.insert(owners_.begin() + at, entity);
        return *components_.insert(components_.begin() + at, std::move(component));
    }

    Component* find(Entity entity) noexcept {
        const std::size_t place = place_of(entity);
        return is_at(place, entity) ? &components_[place] : nullptr;
    }
    const Component* find(Entity entity) const noexcept {
        const std::size_t place = place_of(entity);
        return is_at(place, entity) ? &components_[place] : nullptr;
    }

    void remove(Entity entity) override {
        const std::size_t place = place_of(entity);
        if (!is_at(place, entity)) return;
        const auto at = static_cast<std::ptrdiff_t>(place);
        owners_.erase(owners_.begin() + at);
        components_.erase(components_.begin() + at);
    }

    std::shared_ptr<AnyPool> clone() const override { return std::make_shared<Pool>(*this); }

    std::shared_ptr<AnyPool> clone_without_caches() const override {
        if constexpr (HasCaches<Component>) {
            auto copy = std::make_shared<Pool>();
            copy->owners_ = owners_;
            for (const Component& component : components_)
                copy->components_.push_back(component.without_caches());
            return copy;
        } else {
            return clone();
        }
    }

    bool has_caches() const noexcept override { return HasCaches<Component>; }

    std::size_t count_bytes() const noexcept override {
        std::size_t bytes = owners_.size() * (sizeof(Entity) + sizeof(Component));
        if constexpr (CountsBytes<Component>) {
            for (const Component& component : components_) bytes += component.count_bytes();
        }
        return bytes;
    }

private:
    std::vector<Component> components_;
};

}  // namespace palpa
