// How many hands a scene may have.
#pragma once
#include <cstddef>

namespace palpa {

inline constexpr std::size_t most_hands = 4;

}  // namespace palpa
