// A handle of something in a World: an index and how often that index was used before.
#pragma once
#include <compare>
#include <cstdint>

namespace palpa {

// The default value names nothing: generation 0 is never alive.
struct Entity {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;

    friend auto operator<=>(const Entity&, const Entity&) = default;
};

}  // namespace palpa
