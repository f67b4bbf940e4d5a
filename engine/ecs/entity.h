// A handle of something in a World.
#pragma once
#include <compare>
#include <cstdint>

namespace palpa {

// Counted from 1 in the order of creation, and never given to anything else. The default value
// names nothing.
struct Entity {
    std::uint32_t number = 0;

    friend auto operator<=>(const Entity&, const Entity&) = default;
};

}  // namespace palpa
