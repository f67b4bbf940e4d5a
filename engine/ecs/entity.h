// The handle of an entity in a World.
#pragma once
#include <compare>
#include <cstdint>

namespace palpa {

// Numbered from 1 in the order of creation, never reused. The default value is no entity.
struct Entity {
    std::uint32_t number = 0;

    friend auto operator<=>(const Entity&, const Entity&) = default;
};

}  // namespace palpa
