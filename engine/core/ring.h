// Hands every value from one thread to another in order, without locks, waiting or allocation.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpa {

// One thread pushes, one thread pops. Where the reader falls `Size` values behind, new ones are
// dropped and counted.
template <class Value, std::size_t Size>
class Ring {
public:
    bool push(const Value& value) noexcept {
        const std::uint64_t at = pushed_.load(std::memory_order_relaxed);
        if (at - popped_.load(std::memory_order_acquire) == Size) {
            dropped_.fetch_add(1, std::memory_order_relaxed);
            return false;
        }
        values_[at % Size] = value;
        pushed_.store(at + 1, std::memory_order_release);
        return true;
    }

    // Pushes all values or none.
    bool push(std::span<const Value> values) noexcept {
        const std::uint64_t at = pushed_.load(std::memory_order_relaxed);
        if (at - popped_.load(std::memory_order_acquire) + values.size() > Size) {
            dropped_.fetch_add(values.size(), std::memory_order_relaxed);
            return false;
        }
        for (std::size_t i = 0; i < values.size(); ++i) values_[(at + i) % Size] = values[i];
        pushed_.store(at + values.size(), std::memory_order_release);
        return true;
    }

    // Returns false and leaves `value` unchanged if the ring is empty.
    bool pop(Value& value) noexcept {
        const std::uint64_t at = popped_.load(std::memory_order_relaxed);
        if (at == pushed_.load(std::memory_order_acquire)) return false;
        value = values_[at % Size];
        popped_.store(at + 1, std::memory_order_release);
        return true;
    }

    std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

private:
    std::array<Value, Size> values_{};
    alignas(64) std::atomic<std::uint64_t> pushed_{0};
    alignas(64) std::atomic<std::uint64_t> popped_{0};
    std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace palpa
