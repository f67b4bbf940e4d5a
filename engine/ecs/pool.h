// The components of one type, packed without holes, found by entity in constant time.
#pragma once
#include "ecs/entity.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace palpa {

// What a World needs of every pool, whatever its component type.
class AnyPool {
public:
    AnyPool() = default;
    AnyPool(const AnyPool&) = delete;
    AnyPool& operator=(const AnyPool&) = delete;
    virtual ~AnyPool() = default;

    // Nothing happens if the entity has no component here. The last component fills the gap.
    virtual void remove(std::uint32_t entity_index) = 0;

    std::span<const Entity> entities() const noexcept { return owners_; }

protected:
    static constexpr std::uint32_t none = UINT32_MAX;

    // Place of the entity's component in the packed arrays, or `none`.
    std::uint32_t slot(std::uint32_t entity_index) const noexcept {
        return entity_index < slots_.size() ? slots_[entity_index] : none;
    }

    std::vector<std::uint32_t> slots_;  // by entity index
    std::vector<Entity> owners_;        // packed, beside the components
};

// A sparse set. Components stand in the order they were added until one is removed.
template <class Component>
class Pool final : public AnyPool {
public:
    // Adds the component, or replaces the one that the entity has.
    Component& set(Entity entity, Component component) {
        if (const std::uint32_t old = slot(entity.index); old != none) {
            return components_[old] = std::move(component);
        }
        if (entity.index >= slots_.size()) slots_.resize(entity.index + std::size_t{1}, none);
        slots_[entity.index] = static_cast<std::uint32_t>(components_.size());
        owners_.push_back(entity);
        return components_.emplace_back(std::move(component));
    }

    Component* find(std::uint32_t entity_index) noexcept {
        const std::uint32_t at = slot(entity_index);
        return at == none ? nullptr : &components_[at];
    }
    const Component* find(std::uint32_t entity_index) const noexcept {
        const std::uint32_t at = slot(entity_index);
        return at == none ? nullptr : &components_[at];
    }

    void remove(std::uint32_t entity_index) override {
        const std::uint32_t at = slot(entity_index);
        if (at == none) return;
        slots_[owners_.back().index] = at;
        slots_[entity_index] = none;
        if (at + std::size_t{1} != components_.size()) {
            components_[at] = std::move(components_.back());
            owners_[at] = owners_.back();
        }
        components_.pop_back();
        owners_.pop_back();
    }

private:
    std::vector<Component> components_;
};

}  // namespace palpa
