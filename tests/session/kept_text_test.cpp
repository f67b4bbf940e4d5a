#include "session/kept_text.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

using namespace palpa;

namespace {

std::string all_of(KeptText& kept) {
    std::string text;
    REQUIRE(kept.hand_to([&](std::string_view piece) { text += piece; }));
    return text;
}

}  // namespace

TEST_CASE("kept text comes back whole, and goes on after that", "[session][kept_text]") {
    KeptText kept(std::size_t{1} << 20);
    std::string expected;
    for (int i = 0; i < 20'000; ++i) {  // more than one piece
        const std::string line = "tick " + std::to_string(i) + "\n";
        kept.add(line);
        expected += line;
    }

    CHECK(all_of(kept) == expected);
    kept.add("end\n");
    CHECK(all_of(kept) == expected + "end\n");
}

TEST_CASE("kept text stays whole where whoever takes it throws on the way",
          "[session][kept_text]") {
    KeptText kept(std::size_t{1} << 20);
    const std::string before(300'000, 'x');  // more than one piece
    kept.add(before);
    int pieces = 0;
    const auto full = [&](std::string_view) {
        if (++pieces == 2) throw std::runtime_error("no space");
    };
    CHECK_THROWS_WITH((void)kept.hand_to(full), "no space");

    kept.add("end\n");
    CHECK(all_of(kept) == before + "end\n");
}

TEST_CASE("of more than the limit nothing is kept", "[session][kept_text]") {
    KeptText kept(10);
    kept.add("12345");
    kept.set_beside(5);

    CHECK(all_of(kept) == "12345");
    SECTION("by text") { kept.add("6"); }
    SECTION("by what is kept beside it") { kept.set_beside(6); }

    CHECK_FALSE(kept.is_whole());
    CHECK_FALSE(kept.hand_to([](std::string_view) { FAIL("nothing is left"); }));
    kept.add("more");
    CHECK_FALSE(kept.is_whole());
}
