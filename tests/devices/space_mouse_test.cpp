#include "devices/space_mouse.h"

#include "tests/support/hid_reports.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace palpa;
using test::Bytes;

namespace {

constexpr double fastest_push = SpaceMouseProtocol::fastest_m_per_s;
constexpr double fastest_turn = SpaceMouseProtocol::fastest_rad_per_s;

HidInput decoded(const Bytes& report, HidInput input = {}) {
    SpaceMouseProtocol mouse;
    CHECK(mouse.decode(report, input));
    return input;
}

HidPlace place_of(std::uint16_t vendor, std::uint16_t product, std::uint16_t page,
                  std::uint16_t usage) {
    return {"/dev/hidraw0", {vendor, product}, page, usage, false, ""};
}

}  // namespace

TEST_CASE("a pushed cap sends the handle the same way", "[devices][space-mouse]") {
    // 350 of a word's counts is 0x015e, -350 is 0xfea2.
    const Bytes right{1, 0x5e, 0x01, 0, 0, 0, 0};
    const Bytes towards_user{1, 0, 0, 0x5e, 0x01, 0, 0};
    const Bytes down{1, 0, 0, 0, 0, 0x5e, 0x01};
    const Bytes lifted{1, 0, 0, 0, 0, 0xa2, 0xfe};

    CHECK(decoded(right).rate.m_per_s == Vec3(fastest_push, 0, 0));
    CHECK(decoded(towards_user).rate.m_per_s == Vec3(0, 0, fastest_push));
    CHECK(decoded(down).rate.m_per_s == Vec3(0, -fastest_push, 0));
    CHECK(decoded(lifted).rate.m_per_s == Vec3(0, fastest_push, 0));
}

TEST_CASE("a turned cap turns the handle the same way", "[devices][space-mouse]") {
    const Bytes near_side_down{2, 0x5e, 0x01, 0, 0, 0, 0};  // about x, to the right
    const Bytes right_side_up{2, 0, 0, 0x5e, 0x01, 0, 0};   // about the axis towards the user
    const Bytes clockwise{2, 0, 0, 0, 0, 0x5e, 0x01};       // from above

    CHECK(decoded(near_side_down).rate.rad_per_s == Vec3(fastest_turn, 0, 0));
    CHECK(decoded(right_side_up).rate.rad_per_s == Vec3(0, 0, fastest_turn));
    CHECK(decoded(clockwise).rate.rad_per_s == Vec3(0, -fastest_turn, 0));
}

TEST_CASE("two reports of an old one say what one of a new one says", "[devices][space-mouse]") {
    const Bytes both{1, 100, 0, 0x38, 0xff, 50, 0, 120, 0, 0x9c, 0xff, 0x2c, 0x01};
    const Bytes places{1, 100, 0, 0x38, 0xff, 50, 0};
    const Bytes turns{2, 120, 0, 0x9c, 0xff, 0x2c, 0x01};

    const HidInput at_once = decoded(both), one_by_one = decoded(turns, decoded(places));

    CHECK(at_once.rate.m_per_s == one_by_one.rate.m_per_s);
    CHECK(at_once.rate.rad_per_s == one_by_one.rate.rad_per_s);
    // 100/350 of the way, of which the dead zone takes its part.
    constexpr double dead = SpaceMouseProtocol::dead_zone;
    CHECK(at_once.rate.m_per_s.x() == Approx(fastest_push * (100.0 / 350 - dead) / (1 - dead)));
    CHECK(at_once.rate.rad_per_s.z() == Approx(-fastest_turn * (100.0 / 350 - dead) / (1 - dead)));
}

TEST_CASE("a hand at rest on the cap moves nothing", "[devices][space-mouse]") {
    const Bytes trembling{1, 15, 0, 0xf1, 0xff, 20, 0, 0xec, 0xff, 3, 0, 0, 0};

    const HidInput input = decoded(trembling);

    CHECK(input.rate.m_per_s == Vec3::Zero());
    CHECK(input.rate.rad_per_s == Vec3::Zero());
}

TEST_CASE("a light that could not be written is written again", "[devices][space-mouse]") {
    SpaceMouseProtocol mouse;
    const HidOutput lit{.is_lit = true};
    REQUIRE(mouse.encode(lit).size() == 2);
    REQUIRE(mouse.encode(lit).empty());

    mouse.forget();

    const HidBytes again = mouse.encode(lit);
    CHECK(Bytes(again.begin(), again.end()) == Bytes{4, 1});
}

TEST_CASE("of many buttons the first two count", "[devices][space-mouse]") {
    CHECK(decoded({3, 0}).buttons == 0);
    CHECK(decoded({3, 1}).buttons == 1);
    CHECK(decoded({3, 0xfe, 0xff, 0xff}).buttons == 2);
}

TEST_CASE("what is no report of a cap changes nothing", "[devices][space-mouse]") {
    SpaceMouseProtocol mouse;
    HidInput input;
    REQUIRE(mouse.decode(test::pushed_cap(Vec3(1, 0, 0)), input));
    const Vec3 before = input.rate.m_per_s;

    for (const Bytes& garbage :
         {Bytes{}, Bytes{1}, Bytes{1, 0xff, 0xff, 0xff, 0xff, 0xff}, Bytes{2, 1, 1}, Bytes{3},
          Bytes{0x17, 90}, Bytes{0, 1, 2, 3, 4, 5, 6}, Bytes{200, 1, 2, 3, 4, 5, 6}}) {
        CHECK_FALSE(mouse.decode(garbage, input));
        CHECK(input.rate.m_per_s == before);
        CHECK(input.buttons == 0);
    }
}

TEST_CASE("the light goes on and off with four, and is told once", "[devices][space-mouse]") {
    SpaceMouseProtocol mouse;
    HidLine no_line;
    const auto told = [&](bool is_lit, std::uint8_t force) {
        const HidBytes report = mouse.encode({force, 0, is_lit});
        return Bytes(report.begin(), report.end());
    };

    CHECK(told(false, 0) == Bytes{4, 0});
    CHECK(told(true, 0) == Bytes{4, 1});
    CHECK(told(true, 90).empty());
    CHECK(told(false, 90) == Bytes{4, 0});
    mouse.begin(no_line, {});
    CHECK(told(false, 0) == Bytes{4, 0});  // of a device plugged in anew nothing is known
}

TEST_CASE("caps are told from mice of the same makers, and from their receiver's other faces",
          "[devices][space-mouse]") {
    const SpaceMouseProtocol mouse;

    CHECK(mouse.is_ours(place_of(0x046d, 0xc626, 1, 8)));
    CHECK(mouse.is_ours(place_of(0x256f, 0xc652, 1, 8)));
    CHECK_FALSE(mouse.is_ours(place_of(0x256f, 0xc652, 1, 2)));  // the receiver's mouse
    CHECK_FALSE(mouse.is_ours(place_of(0x256f, 0xc652, 0xff00, 1)));
    CHECK_FALSE(mouse.is_ours(place_of(0x256f, 0xc650, 1, 8)));
    CHECK_FALSE(mouse.is_ours(place_of(0x046d, 0xc62c, 1, 8)));
    CHECK_FALSE(mouse.is_ours(place_of(0x046d, 0xc077, 1, 2)));
    CHECK_FALSE(mouse.is_ours(place_of(0x256f, 0xc626, 1, 8)));  // never sold under that name
    CHECK(mouse.why_not(place_of(0x256f, 0xc650, 1, 2)) == "a mouse or a keyboard");
    CHECK(mouse.why_not(place_of(0x256f, 0xc652, 1, 2)).empty());
    CHECK(mouse.why_not(place_of(0x1234, 0xc650, 1, 2)).empty());
}

TEST_CASE("a million random reports of a cap ask for no more than it can",
          "[devices][space-mouse]") {
    std::mt19937 random(7);
    SpaceMouseProtocol mouse;
    HidInput input;
    int understood = 0;
    double fastest_found = 0;

    for (int i = 0; i < 1'000'000; ++i) {
        std::array<std::uint8_t, 16> bytes{};
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
        bytes[0] %= 5;
        const std::size_t size = random() % (bytes.size() + 1);
        understood += mouse.decode(HidBytes(bytes).first(size), input) ? 1 : 0;
        const double speed = input.rate.m_per_s.cwiseAbs().maxCoeff();
        const double turn = input.rate.rad_per_s.cwiseAbs().maxCoeff();
        if (!(speed <= fastest_push && turn <= fastest_turn && input.buttons < 4))
            FAIL("report " << i);
        fastest_found = std::max(fastest_found, speed);
    }

    CHECK(understood > 300'000);
    CHECK(fastest_found == fastest_push);
}
