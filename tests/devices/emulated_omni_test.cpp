#include "devices/emulated_omni.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace palpa;

namespace {

// No friction, no encoder step, no hand.
EmulatedOmniSettings bare() {
    EmulatedOmniSettings settings;
    settings.friction_newton = 0;
    settings.encoder_step_m = 0;
    return settings;
}

void play(EmulatedOmni& omni, const Vec3& force, int ticks) {
    for (int i = 0; i < ticks; ++i) omni.write(force);
}

}  // namespace

TEST_CASE("a free handle under a constant force obeys mass and viscosity", "[devices][omni]") {
    EmulatedOmni omni(bare());
    const double M = 0.045, B = 0.1, t = 0.1;
    const Vec3 force(0.05, -0.02, 0.01);

    play(omni, force, 100);

    // x = F/B (t - M/B (1 - exp(-B t/M)))
    const double per_newton = (t - M / B * (1 - std::exp(-B * t / M))) / B;
    CHECK((omni.true_position_m() - per_newton * force).norm() < 1e-12);
    CHECK(omni.read().time_s == Approx(0.1));
    CHECK(omni.read().valid);
}

TEST_CASE("friction holds a handle against less than itself and slows it against more",
          "[devices][omni]") {
    EmulatedOmniSettings settings = bare();
    settings.friction_newton = 0.26;
    settings.dynamics.viscosity_N_s_per_m = 0;
    EmulatedOmni held(settings), pushed(settings);

    play(held, {0.15, 0.15, 0.1}, 1000);
    play(pushed, {0.3, 0.4, 0}, 100);

    CHECK(held.true_position_m().norm() == 0);  // 0.235 N in all
    // (0.5 - 0.26) N on 45 g for 0.1 s along the push.
    const double expected = 0.5 * (0.5 - 0.26) / 0.045 * 0.01;
    CHECK(pushed.true_position_m().norm() == Approx(expected).epsilon(0.02));
    CHECK(pushed.true_position_m().x() / pushed.true_position_m().y() == Approx(0.75));
}

TEST_CASE("the encoder shows whole steps", "[devices][omni]") {
    EmulatedOmniSettings settings = bare();
    settings.encoder_step_m = 0.055e-3;
    EmulatedOmni omni(settings);

    double before = 0;
    int steps_seen = 0;
    for (int i = 0; i < 60; ++i) {
        omni.write({0.1, 0.05, 0});
        const Vec3 seen = omni.read().position_m, is = omni.true_position_m();
        CHECK((seen - is).cwiseAbs().maxCoeff() <= 0.0275e-3 * (1 + 1e-9));
        const double steps = seen.x() / 0.055e-3;
        CHECK(steps == Approx(std::round(steps)).margin(1e-9));
        steps_seen += steps > before + 0.5 ? 1 : 0;
        before = steps;
    }
    // The way that mass and viscosity allow in 60 ms, 3.8 mm: 70 steps, by a few in a tick at last.
    const double M = 0.045, B = 0.1, t = 0.06;
    const double way = 0.1 * (t - M / B * (1 - std::exp(-B * t / M))) / B;
    CHECK(before == Approx(std::round(way / 0.055e-3)));
    CHECK(steps_seen > 40);
}

TEST_CASE("motors give no more than their peak force, in any direction", "[devices][omni]") {
    EmulatedOmni asked(bare()), given(bare());

    play(asked, {30, -40, 0}, 20);
    play(given, {1.98, -2.64, 0}, 20);

    CHECK((asked.true_position_m() - given.true_position_m()).norm() < 1e-14);
}

TEST_CASE("stops keep the handle in the workspace of 160 x 120 x 70 mm", "[devices][omni]") {
    const int axis = GENERATE(0, 1, 2);
    const double sign = GENERATE(1.0, -1.0);
    EmulatedOmni omni(bare());

    // Full force into the stop gives 3.3 N / 20 kN/m = 0.165 mm once at rest.
    play(omni, 3.3 * sign * Vec3::Unit(axis), 3000);

    const double half = omni_half_workspace_m(axis);
    CHECK(sign * omni.true_position_m()(axis) == Approx(half + 0.165e-3).epsilon(1e-3));
    CHECK(omni.spec().half_workspace_m == omni_half_workspace_m);
}

TEST_CASE("a hand pulls the handle along its path", "[devices][omni]") {
    const auto grip = GENERATE(HandGrip::Light, HandGrip::Slack, HandGrip::Medium, HandGrip::Firm,
                               HandGrip::FirmGrip);
    EmulatedOmniSettings settings = bare();
    settings.hand = hand_model(grip);
    settings.script.path = {{0.2, 0.04}, {2.2, -0.03}};
    EmulatedOmni omni(settings);

    CHECK(omni.read().position_m.x() == 0.04);
    play(omni, Vec3::Zero(), 12'000);
    CHECK(omni.true_position_m().x() == Approx(-0.03).margin(1e-5));
    play(omni, {0.5, 0, 0}, 12'000);
    CHECK(omni.true_position_m().x() ==
          Approx(-0.03 + 0.5 / static_stiffness(*settings.hand)).margin(1e-5));
}

TEST_CASE("a kick moves a free handle by its impulse", "[devices][omni]") {
    EmulatedOmniSettings settings = bare();
    settings.script.kick_N_s = 0.005;
    settings.dynamics.viscosity_N_s_per_m = 0;
    EmulatedOmni omni(settings);

    play(omni, Vec3::Zero(), 1000);
    CHECK(omni.true_position_m().norm() == 0);
    play(omni, Vec3::Zero(), 110);
    // 5 mN s on 45 g: 0.111 m/s, from the middle of the kick on.
    CHECK(omni.true_position_m().x() == Approx(0.005 / 0.045 * (0.110 - 0.005)));
}

TEST_CASE("the same settings give the same motion to the last bit", "[devices][omni]") {
    EmulatedOmniSettings settings;
    settings.hand = hand_model(HandGrip::Medium);
    settings.script.path = {{0.1, 0.06}, {0.6, -0.3}};
    EmulatedOmni a(settings), b(settings);

    for (int i = 0; i < 4000; ++i) {
        const Vec3 force(std::sin(0.01 * i), 0.1, 0);
        a.write(force);
        b.write(force);
        REQUIRE(a.true_position_m() == b.true_position_m());
        REQUIRE(a.read().buttons == b.read().buttons);
    }
}

TEST_CASE("stops hold the lightest and the heaviest handle that a scene may have",
          "[devices][omni]") {
    const double inertia = GENERATE(0.001, 0.002, 0.01, 10.0);
    EmulatedOmniSettings settings = bare();
    settings.dynamics.inertia_kg = inertia;
    settings.script.kick_N_s = 0.1;
    EmulatedOmni omni(settings);

    double widest = 0;
    for (int i = 0; i < 5000; ++i) {
        omni.write(Vec3::Zero());
        widest = std::max(widest, std::abs(omni.true_position_m().x()));
    }

    // 100 m/s, at worst, go 25 mm in a sub-step; the stop turns them within a few.
    CHECK(widest < 0.5);
    CHECK(std::abs(omni.true_position_m().x()) < 0.09);
}

TEST_CASE("a live hand takes the handle where the mouse is, in three dimensions",
          "[devices][omni]") {
    HandOrders orders;
    EmulatedOmniSettings settings = bare();
    settings.hand = hand_model(HandGrip::Medium);
    settings.orders = &orders;
    settings.driver = HandDriver::Mouse;
    settings.half_workspace_m = Vec3::Constant(0.5);
    EmulatedOmni omni(settings);
    const Vec3 target(0.2, -0.1, 0.15);

    CHECK(omni.read().position_m.isZero());
    orders.post({target});
    play(omni, Vec3::Zero(), 1);
    CHECK(omni.true_position_m().norm() < 1e-3);  // goes there, does not jump
    play(omni, Vec3::Zero(), 4000);
    CHECK((omni.true_position_m() - target).norm() < 1e-5);

    // A force bends the hand by its spring alone.
    play(omni, Vec3(0, 1, 0), 4000);
    CHECK(omni.true_position_m().y() - target.y() ==
          Approx(1 / settings.hand->stiffness_N_per_m).epsilon(1e-3));

    orders.post({Vec3(9, 0, 0)});
    play(omni, Vec3::Zero(), 4000);
    CHECK(omni.true_position_m().x() == Approx(0.5).epsilon(0.01));
}

TEST_CASE("however far the mouse is, a live hand pulls less than the clamp, and is no faster",
          "[devices][omni]") {
    HandOrders orders;
    EmulatedOmniSettings settings = bare();
    settings.hand = hand_model(HandGrip::Medium);
    settings.orders = &orders;
    settings.driver = HandDriver::Mouse;
    settings.half_workspace_m = Vec3::Constant(0.5);
    EmulatedOmni omni(settings);
    orders.post({Vec3(1, 0, 0)});

    double fastest = 0;
    for (int tick = 0; tick < 1000; ++tick) {
        const double before = omni.true_position_m().x();
        play(omni, Vec3::Zero(), 1);
        fastest = std::max(fastest, (omni.true_position_m().x() - before) / 1e-3);
    }
    CHECK(fastest < 1.6 * live_hand_m_per_s);  // it swings over a little on setting out
    const double there = omni.true_position_m().x();
    play(omni, Vec3(-1.1 * live_hand_newton, 0, 0), 1000);  // what a wall gives
    CHECK(omni.true_position_m().x() < there);

    // Back again it answers at once, from wherever the mouse had gone.
    play(omni, Vec3(-0.9 * live_hand_newton, 0, 0), 1000);
    const double held = omni.true_position_m().x();
    orders.post({Vec3(held - 0.05, 0, 0)});
    play(omni, Vec3(-0.9 * live_hand_newton, 0, 0), 100);
    CHECK(omni.true_position_m().x() < held - 0.005);
}

TEST_CASE("a frozen hand stands still with its device, but for the ticks that are granted",
          "[devices][omni]") {
    HandOrders orders;
    EmulatedOmniSettings settings = bare();
    settings.hand = hand_model(HandGrip::Medium);
    settings.script.path = {{0, 0.01}, {1, -0.02}};
    settings.orders = &orders;
    EmulatedOmni omni(settings);
    play(omni, Vec3::Zero(), 500);
    HandOrder order;
    order.frozen = true;
    orders.post(order);
    const DeviceReading before = omni.read();
    play(omni, Vec3(3, 0, 0), 1000);
    CHECK(omni.read().position_m == before.position_m);
    CHECK(omni.read().time_s == before.time_s);

    order.grants = 1;
    order.granted_ticks = 14;
    orders.post(order);
    play(omni, Vec3::Zero(), 100);
    CHECK(omni.read().time_s == Approx(before.time_s + 0.014));

    order.frozen = false;
    ++order.restarts;  // the script from its beginning
    orders.post(order);
    play(omni, Vec3::Zero(), 2500);
    CHECK(omni.true_position_m().x() == Approx(-0.02).margin(1e-4));
    CHECK(omni.read().time_s == Approx(before.time_s + 0.014 + 2.5));
}

TEST_CASE("a hand that lets go wants no place any more, its mass and damping stay",
          "[devices][omni]") {
    EmulatedOmniSettings settings = bare();
    settings.hand = hand_model(HandGrip::Medium);
    settings.script.path = {{0, 0}, {0.2, 0.02}};
    settings.script.release_s = 0.1;
    EmulatedOmni omni(settings);

    play(omni, Vec3::Zero(), 99);
    const double before = omni.true_position_m().x();
    play(omni, Vec3::Zero(), 1);
    const double released = omni.true_position_m().x(), v = (released - before) / 1e-3;
    play(omni, Vec3(0.5, 0, 0), 100);

    // From speed v at the release, as one mass with both dampings under a constant force.
    const double M = 0.045 + 0.15, B = 0.1 + 4, t = 0.1, fade = 1 - std::exp(-B * t / M);
    const double expected = v * M / B * fade + 0.5 / B * (t - M / B * fade);
    CHECK(omni.true_position_m().x() - released == Approx(expected).epsilon(0.01));
}

TEST_CASE("a hand that lets go behind a grip follows the handle, and pulls it nowhere",
          "[devices][omni]") {
    EmulatedOmniSettings settings = bare();
    settings.hand = hand_model(HandGrip::FirmGrip);
    settings.script.path = {{0, 0.03}};
    settings.script.release_s = 0.1;
    EmulatedOmni omni(settings);

    play(omni, Vec3::Zero(), 1000);
    CHECK(omni.true_position_m().x() == Approx(0.03));
    play(omni, Vec3(-1, 0, 0), 500);
    play(omni, Vec3::Zero(), 3000);
    CHECK(omni.true_position_m().x() < 0);
}

TEST_CASE("an operator's hand wants the place it is told at once, as a script's does",
          "[devices][omni]") {
    EmulatedOmniSettings settings = bare();
    settings.hand = hand_model(HandGrip::Medium);
    settings.script.path = {{0, 0}, {0.3, 0.05}};
    EmulatedOmni scripted(settings);
    HandOrders orders;
    settings.driver = HandDriver::Operator;
    settings.orders = &orders;
    EmulatedOmni operated(settings);

    double widest = 0;
    for (int tick = 0; tick < 500; ++tick) {
        // What the script wants by the end of the tick that begins.
        orders.post({find_target(settings.script.path, tick * servo_tick_s).place_m});
        play(scripted, Vec3(-0.5, 0, 0), 1);
        play(operated, Vec3(-0.5, 0, 0), 1);
        widest = std::max(widest, (scripted.true_position_m() - operated.true_position_m()).norm());
    }

    CHECK(widest < 1e-12);
    CHECK(operated.true_position_m().x() > 0.04);
}
