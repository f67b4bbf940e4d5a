// Counts what a test program allocates, by operators new and delete that remember sizes: to be
// included by one file of a program.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace palpa::test {

inline std::size_t held_bytes = 0, peak_bytes = 0;

// Before each block its size, in as many bytes as keep the block aligned.
inline constexpr std::size_t block_head = alignof(std::max_align_t);

// Of what `act` allocates at the same time.
template <class Act>
std::size_t peak_of(const Act& act) {
    const std::size_t before = held_bytes;
    peak_bytes = held_bytes;
    act();
    return peak_bytes - before;
}

}  // namespace palpa::test

void* operator new(std::size_t size) {
    void* const block = std::malloc(palpa::test::block_head + size);
    if (!block) throw std::bad_alloc();
    *static_cast<std::size_t*>(block) = size;
    palpa::test::held_bytes += size;
    palpa::test::peak_bytes = std::max(palpa::test::peak_bytes, palpa::test::held_bytes);
    return static_cast<std::byte*>(block) + palpa::test::block_head;
}

void operator delete(void* pointer) noexcept {
    if (!pointer) return;
    void* const block = static_cast<std::byte*>(pointer) - palpa::test::block_head;
    palpa::test::held_bytes -= *static_cast<std::size_t*>(block);
    std::free(block);
}

void operator delete(void* pointer, std::size_t /*size*/) noexcept { operator delete(pointer); }
