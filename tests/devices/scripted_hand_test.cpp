#include "devices/scripted_hand.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace palpa;

namespace {

constexpr double tick = 1e-3;

}  // namespace

TEST_CASE("a path inside the workspace is followed without the clutch", "[devices][hand]") {
    const HandScript script{.path = {{0.1, 0.05}, {1.1, -0.05}}};
    ScriptedHand hand(script, 0.08);
    double fastest = 0;

    CHECK(hand.start_m() == 0.05);
    ScriptedHand::Wish wish;
    for (int i = 0; i < 1500; ++i) {
        wish = hand.step(tick);
        CHECK(wish.buttons == 0);
        fastest = std::max(fastest, std::abs(wish.v_m_per_s));
    }
    CHECK(wish.x_m == -0.05);
    // Minimum jerk peaks at 15/8 of the mean speed.
    CHECK(fastest == Approx(0.1 * 15 / 8).epsilon(1e-3));
}

TEST_CASE("a path longer than the workspace is walked in pieces, clutching between them",
          "[devices][hand]") {
    const double length = GENERATE(0.2, 0.5, -0.4);
    const HandScript script{.path = {{0.1, 0.02}, {2.1, 0.02 + length}}};
    ScriptedHand hand(script, 0.08);
    double before = hand.start_m(), travelled = 0, widest = 0;
    int clutched_ticks = 0;

    for (int i = 0; i < 12'000; ++i) {
        const ScriptedHand::Wish wish = hand.step(tick);
        const bool clutched = is_pressed(wish.buttons, Button::Clutch);
        if (!clutched) travelled += wish.x_m - before;
        if (clutched) ++clutched_ticks;
        widest = std::max(widest, std::abs(wish.x_m));
        before = wish.x_m;
    }

    CHECK(travelled == Approx(length).epsilon(1e-9));
    CHECK(widest < 0.08);
    CHECK(clutched_ticks > 0);
}

TEST_CASE("a kick gives its impulse within ten milliseconds after one second", "[devices][hand]") {
    HandScript script;
    script.kick_N_s = 0.005;
    const ScriptedHand hand(script, 0.08);
    double impulse = 0;
    int ticks = 0;

    for (int i = 0; i < 3000; ++i) {
        const double force = hand.kick_newton(i * tick);
        impulse += force * tick;
        if (force != 0) ++ticks;
    }

    CHECK(impulse == Approx(0.005));
    CHECK(ticks == 10);
    CHECK(hand.kick_newton(0.999) == 0);
    CHECK(hand.kick_newton(1.0) == Approx(0.5));
}

TEST_CASE("a path that begins outside of the workspace is begun at its edge", "[devices][hand]") {
    const HandScript script{.path = {{0.5, 0.2}, {2.5, 0.1}}};
    ScriptedHand hand(script, 0.08);

    CHECK(hand.start_m() == Approx(0.075));
    ScriptedHand::Wish wish;
    for (int i = 0; i < 4000; ++i) {
        wish = hand.step(tick);
        CHECK(wish.buttons == 0);
    }
    CHECK(wish.x_m == Approx(0.075 - 0.1));
}

TEST_CASE("a clutch ends inside the workspace, from wherever it began", "[devices][hand]") {
    const HandScript script{.path = {{0.1, -0.06}, {0.6, 0.5}, {1.0, 0.5}, {1.6, -0.3}}};
    ScriptedHand hand(script, 0.08);

    for (int i = 0; i < 20'000; ++i) CHECK(std::abs(hand.step(tick).x_m) < 0.08);
}
