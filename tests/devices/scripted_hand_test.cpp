#include "devices/scripted_hand.h"

#include "devices/emulated_omni.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace palpa;

namespace {

constexpr double tick = 1e-3;

}  // namespace

TEST_CASE("a path inside the workspace is followed without the clutch", "[devices][hand]") {
    const HandScript script{.path = {{0.1, 0.05}, {1.1, -0.05}}};
    ScriptedHand hand(script, omni_half_workspace_m);
    double fastest = 0;

    CHECK(hand.start_m().x() == 0.05);
    ScriptedHand::Wish wish;
    for (int i = 0; i < 1500; ++i) {
        wish = hand.step(tick);
        CHECK(wish.buttons == 0);
        fastest = std::max(fastest, std::abs(wish.m_per_s.x()));
    }
    CHECK(wish.place_m.x() == -0.05);
    // Minimum jerk peaks at 15/8 of the mean speed.
    CHECK(fastest == Approx(0.1 * 15 / 8).epsilon(1e-3));
}

TEST_CASE("a path longer than the workspace is walked in pieces, clutching between them",
          "[devices][hand]") {
    const double length = GENERATE(0.2, 0.5, -0.4);
    const HandScript script{.path = {{0.1, 0.02}, {2.1, 0.02 + length}}};
    ScriptedHand hand(script, omni_half_workspace_m);
    double before = hand.start_m().x(), travelled = 0, widest = 0;
    int clutched_ticks = 0;

    for (int i = 0; i < 12'000; ++i) {
        const ScriptedHand::Wish wish = hand.step(tick);
        const bool clutched = is_pressed(wish.buttons, Button::Clutch);
        if (!clutched) travelled += wish.place_m.x() - before;
        if (clutched) ++clutched_ticks;
        widest = std::max(widest, std::abs(wish.place_m.x()));
        before = wish.place_m.x();
    }

    CHECK(travelled == Approx(length).epsilon(1e-9));
    CHECK(widest < 0.08);
    CHECK(clutched_ticks > 0);
}

TEST_CASE("a hand with a new path follows it from where it is", "[devices][hand]") {
    ScriptedHand hand({.path = {{0, 0}, {1, 0.02}, {5, 0.04}}}, omni_half_workspace_m);
    for (int i = 0; i < 1000; ++i) (void)hand.step(tick);
    CHECK(hand.step(tick).place_m.x() == Approx(0.02).margin(1e-6));

    hand.go_on({{1, -0.03}});
    double largest_step = 0, before = 0.02;
    ScriptedHand::Wish wish;
    for (int i = 0; i < 1100; ++i) {
        wish = hand.step(tick);
        largest_step = std::max(largest_step, std::abs(wish.place_m.x() - before));
        before = wish.place_m.x();
    }
    CHECK(wish.place_m.x() == -0.03);
    CHECK(largest_step < 0.05 * 15 / 8 * tick * 1.01);
}

TEST_CASE("a hand that takes something else leads that from where it was taken",
          "[devices][hand]") {
    ScriptedHand hand({.path = {{0, 0}}, .leads = true}, omni_half_workspace_m);
    Vec3 molecule_m(5e-10, 0, 0);
    std::uint32_t start = 1;
    const auto go = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) {
            hand.see({molecule_m, 1e8, Vec3(hand.start_m()), start});
            const double before = hand.start_m().x();
            molecule_m.x() += (hand.step(tick).place_m.x() - before) / 1e8;
        }
    };
    go(100);
    CHECK(molecule_m.x() == Approx(5e-10).margin(1e-14));

    hand.go_on({{1, 2e-10}}, true);
    go(5);
    molecule_m = Vec3(-3e-10, 0, 0);
    start = 2;
    go(4000);
    CHECK(molecule_m.x() == Approx(-1e-10).margin(2e-12));
}

TEST_CASE("a kick gives its impulse within ten milliseconds after one second", "[devices][hand]") {
    HandScript script;
    script.kick_N_s = 0.005;
    const ScriptedHand hand(script, omni_half_workspace_m);
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
    ScriptedHand hand(script, omni_half_workspace_m);

    CHECK(hand.start_m().x() == Approx(0.075));
    ScriptedHand::Wish wish;
    for (int i = 0; i < 4000; ++i) {
        wish = hand.step(tick);
        CHECK(wish.buttons == 0);
    }
    CHECK(wish.place_m.x() == Approx(0.075 - 0.1));
}

TEST_CASE("a clutch ends inside the workspace, from wherever it began", "[devices][hand]") {
    const HandScript script{.path = {{0.1, -0.06}, {0.6, 0.5}, {1.0, 0.5}, {1.6, -0.3}}};
    ScriptedHand hand(script, omni_half_workspace_m);

    for (int i = 0; i < 20'000; ++i) CHECK(std::abs(hand.step(tick).place_m.x()) < 0.08);
}

TEST_CASE("a hand that leads brings a molecule that follows to where its path says, clutching",
          "[devices][hand]") {
    // 30 Å along a diagonal at 0.1e9 are 300 mm of handle, most of them along x.
    constexpr double angstrom = 1e-10, A_d = 0.1e9;
    const HandScript script{.path = {{0.5, 0}, {20, 24 * angstrom, 18 * angstrom}}, .leads = true};
    ScriptedHand hand(script, omni_half_workspace_m);
    const Vec3 begin(7 * angstrom, 0, 0), end(24 * angstrom, 18 * angstrom, 0);
    Vec3 molecule = begin, handle = hand.start_m();
    int clutched_ticks = 0;

    CHECK(hand.start_m().x() < -0.05);
    for (int i = 0; i < 60'000; ++i) {
        hand.see({molecule, A_d, handle});
        const ScriptedHand::Wish wish = hand.step(tick);
        const bool clutched = is_pressed(wish.buttons, Button::Clutch);
        if (!clutched) molecule += (wish.place_m - handle) / A_d;
        if (clutched) ++clutched_ticks;
        handle = wish.place_m;
        REQUIRE((handle.cwiseAbs() - omni_half_workspace_m).maxCoeff() < 0);
    }

    CHECK((molecule - begin - end).norm() < 0.01 * angstrom);
    CHECK(clutched_ticks > 0);
}

TEST_CASE("a hand that leads waits for a molecule that does not come, and goes on where it does",
          "[devices][hand]") {
    constexpr double angstrom = 1e-10, most_ahead_m = 0.012;
    const HandScript script{.path = {{0.5, 0}, {2, 20 * angstrom}}, .leads = true};
    ScriptedHand hand(script, omni_half_workspace_m, most_ahead_m);
    // Handle and molecule are stuck for ten seconds; then they follow.
    Vec3 molecule = Vec3::Zero(), handle = hand.start_m();
    double ahead = 0;
    for (int i = 0; i < 10'000; ++i) {
        hand.see({molecule, 0.02e9, handle});
        ahead = (hand.step(tick).place_m - handle).norm();
        REQUIRE(ahead < most_ahead_m * (1 + 1e-9));
    }
    CHECK(ahead == Approx(most_ahead_m));
    double fastest = 0;
    for (int i = 0; i < 10'000; ++i) {
        hand.see({molecule, 0.02e9, handle});
        const Vec3 wish = hand.step(tick).place_m;
        molecule += (wish - handle) / 0.02e9;
        if (i > 0) fastest = std::max(fastest, (wish - handle).norm() / tick);
        handle = wish;
    }
    CHECK(molecule.x() == Approx(20 * angstrom).epsilon(1e-3));
    CHECK(fastest < 0.081);
}

TEST_CASE("a hand that leads does not clutch for a molecule that heat shakes", "[devices][hand]") {
    // 1 Å is 25 mm of handle: 0.1 Å to and fro carries the hand over the edge where it begins.
    constexpr double angstrom = 1e-10, A_d = 0.25e9;
    const HandScript script{.path = {{1, 0}, {10, 3 * angstrom}}, .leads = true};
    ScriptedHand hand(script, omni_half_workspace_m);
    double place = 0, shaken = 0;
    Vec3 handle = hand.start_m();
    int presses = 0;
    bool was_clutched = false;
    for (int i = 0; i < 12'000; ++i) {
        shaken = 0.1 * angstrom * std::sin(0.02 * i);
        hand.see({{place + shaken, 0, 0}, A_d, handle});
        const ScriptedHand::Wish wish = hand.step(tick);
        const bool is_clutched = is_pressed(wish.buttons, Button::Clutch);
        if (!is_clutched) place += (wish.place_m - handle).x() / A_d;
        if (is_clutched && !was_clutched) ++presses;
        was_clutched = is_clutched;
        handle = wish.place_m;
    }

    CHECK(presses == 0);  // 75 mm of 150
    CHECK(place + shaken == Approx(3 * angstrom).margin(0.2 * angstrom));
}
