// The components of one type, packed without holes in the order of their entities.
#pragma once
#include "ecs/entity.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace palpa {

// The interface of a pool that does not depend on the component type.
class AnyPool {
public:
    virtual ~AnyPool() = default;

    virtual std::unique_ptr<AnyPool> clone() const = 0;
    // Removes the entity's component, if it has one.
    virtual void remove(Entity entity) = 0;

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

// There are only hundreds of entities (molecules, hands, marks), so they are found by bisection.
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

    std::unique_ptr<AnyPool> clone() const override { return std::make_unique<Pool>(*this); }

private:
    std::vector<Component> components_;
};

}  // namespace palpa
