#include "core/mailbox.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <thread>
#include <utility>
#include <vector>

namespace {

// A value that shows whether it was copied while being written: all words are equal.
struct Whole {
    std::array<std::uint64_t, 16> words{};

    static Whole of(std::uint64_t word) {
        Whole whole;
        whole.words.fill(word);
        return whole;
    }
    bool is_torn() const {
        for (const std::uint64_t word : words) {
            if (word != words[0]) return true;
        }
        return false;
    }
};

}  // namespace

TEST_CASE("a mailbox hands out each newest value once", "[core][mailbox]") {
    palpa::Mailbox<int> box;
    int value = -1;

    CHECK_FALSE(box.read(value));
    CHECK(value == -1);
    box.post(1);
    box.post(2);
    CHECK(box.read(value));
    CHECK(value == 2);
    CHECK_FALSE(box.read(value));
    box.post(3);
    CHECK(box.read(value));
    CHECK(value == 3);
}

TEST_CASE("a mailbox passes on what owns memory as well", "[core][mailbox]") {
    palpa::Mailbox<std::vector<int>> box;
    box.post({1, 2, 3});
    std::vector<int> value;
    REQUIRE(box.read(value));
    CHECK(value == std::vector{1, 2, 3});
    static_assert(!noexcept(box.post(value)));
    static_assert(noexcept(std::declval<palpa::Mailbox<int>&>().post(1)));
}

TEST_CASE("a mailbox between two threads gives whole values in order, the last one surely",
          "[core][mailbox]") {
    constexpr std::uint64_t last = 200'000;
    palpa::Mailbox<Whole> box;

    std::thread poster([&box] {
        for (std::uint64_t i = 1; i <= last; ++i) box.post(Whole::of(i));
    });
    Whole value;
    std::uint64_t newest = 0, torn = 0, backwards = 0;
    while (newest < last) {
        if (!box.read(value)) continue;
        if (value.is_torn()) ++torn;
        if (value.words[0] <= newest) ++backwards;
        newest = value.words[0];
    }
    poster.join();

    CHECK(torn == 0);
    CHECK(backwards == 0);
}
