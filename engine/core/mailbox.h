// Hands the newest value from one thread to another, without locks, waiting or allocation.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace palpa {

// A triple buffer: one thread posts, one thread reads. A reader sees whole values only, each at
// least as new as the one before; values that nobody read in time are overwritten. Plain structs
// pass without allocation; what owns memory is copied into what its slot held before.
template <class Value>
class Mailbox {
    static constexpr bool plain = std::is_trivially_destructible_v<Value>;

public:
    void post(const Value& value) noexcept(plain) {
        draft() = value;
        send();
    }

    // To write without a copy: the slot to fill, with an old value in it; then post it.
    Value& draft() noexcept { return slots_[write_]; }
    void send() noexcept {
        // The slot just written becomes the newest; the one that lay there is written next.
        write_ = newest_.exchange(write_ | fresh, std::memory_order_acq_rel) & slot_mask;
    }

    // Reads the newest value. Returns false and leaves `value` unchanged if there is none since the
    // last read.
    bool read(Value& value) noexcept(plain) {
        if (!take()) return false;
        value = taken();
        return true;
    }

    // The same without a copy: the value taken stays valid for the reader until the next call.
    bool take() noexcept {
        if ((newest_.load(std::memory_order_relaxed) & fresh) == 0) return false;
        read_ = newest_.exchange(read_, std::memory_order_acq_rel) & slot_mask;
        return true;
    }
    const Value& taken() const noexcept { return slots_[read_]; }

private:
    static constexpr std::uint32_t fresh = 4, slot_mask = 3;

    std::array<Value, 3> slots_{};
    alignas(64) std::atomic<std::uint32_t> newest_{1};
    alignas(64) std::uint32_t write_ = 0;  // the poster's own
    alignas(64) std::uint32_t read_ = 2;   // the reader's own
};

}  // namespace palpa
