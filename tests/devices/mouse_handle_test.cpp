#include "devices/mouse_handle.h"

#include "haptics/hand.h"
#include "haptics/local_field.h"
#include "haptics/safety.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

using namespace palpa;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double K = 200, B = 4;  // the medium grip's

// The handle in a molecule's hand: a spring about the middle, played a tick late as the servo does.
struct SpringLoop {
    explicit SpringLoop(double stiffness) : spring_N_per_m(stiffness) {}

    void lead_to(double x_m, int ticks) {
        orders.post({Vec3(x_m, 0, 0)});
        for (int i = 0; i < ticks; ++i) step();
    }
    void step() {
        const double next = -spring_N_per_m * handle.read().position_m.x();
        handle.write(Vec3(force, 0, 0));
        force = next;
    }
    double x_m() { return handle.read().position_m.x(); }

    double spring_N_per_m;
    HandOrders orders;
    MouseHandle handle{MouseHandleSettings{.orders = &orders}};
    double force = 0;
};

// The largest pole of that loop, of x' = a x - (1 - a) K_f/K x_before, by a companion matrix.
double largest_pole(double spring_N_per_m) {
    const double a = std::exp(-K * 1e-3 / B);
    Eigen::Matrix2d loop;
    loop << a, -(1 - a) * spring_N_per_m / K, 1, 0;
    return Eigen::EigenSolver<Eigen::Matrix2d>(loop).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("the stiffer the molecule, the less the handle follows the mouse", "[devices][mouse]") {
    const double spring = GENERATE(0.0, 50.0, 200.0, 600.0);
    CAPTURE(spring);
    SpringLoop loop(spring);

    loop.lead_to(0.004, 3000);
    const double before = loop.x_m();
    loop.lead_to(0.006, 3000);

    CHECK_THAT((loop.x_m() - before) / 0.002, WithinRel(K / (K + spring), 1e-9));
}

TEST_CASE("the gap between mouse and handle shows the force", "[devices][mouse]") {
    const double newton = GENERATE(-2.0, 0.3, 1.5);
    HandOrders orders;
    MouseHandle handle({.orders = &orders});
    orders.post({Vec3(0.01, -0.02, 0.03)});

    for (int i = 0; i < 3000; ++i) handle.write(Vec3(0, newton, 0));

    const Vec3 gap = handle.read().position_m - Vec3(0.01, -0.02, 0.03);
    CHECK((gap - Vec3(0, newton / K, 0)).norm() < 1e-9);
    CHECK((handle.wish_m() - Vec3(0.01, -0.02, 0.03)).norm() < 1e-9);
}

TEST_CASE("the handle comes to rest as an exponential, whatever the tick", "[devices][mouse]") {
    MouseHandle handle({});

    for (int i = 0; i < 20; ++i) handle.write(Vec3(0, 0, 1));

    const double expected = 1 / K * (1 - std::exp(-0.020 * K / B));
    CHECK_THAT(handle.read().position_m.z(), WithinRel(expected, 1e-9));
    CHECK_THAT(handle.read().time_s, WithinAbs(0.020, 1e-12));
}

TEST_CASE("the handle shakes from the stiffness on at which the poles say so", "[devices][mouse]") {
    const double limit = K / (1 - std::exp(-K * 1e-3 / B));
    CHECK_THAT(largest_pole(limit), WithinAbs(1, 1e-9));
    CHECK(limit > 10 * K);
    const double spring = limit * GENERATE(0.5, 0.9, 1.1);
    SpringLoop loop(spring);
    loop.force = 0.001;

    for (int i = 0; i < 300; ++i) loop.step();
    double late = 0;
    for (int i = 0; i < 100; ++i) {
        loop.step();
        late = std::max(late, std::abs(loop.x_m()));
    }

    const double at_first = 0.001 / K;
    CAPTURE(spring, late, largest_pole(spring));
    CHECK((late < at_first) == (largest_pole(spring) < 1));
}

TEST_CASE("the cap of the mouse is half of the stiffness that shakes it, for every delay",
          "[devices][mouse]") {
    const int delay = GENERATE(0, 1, 2, 3, 7);
    const double grip_K = GENERATE(200.0, 500.0);
    MouseHandleSettings settings{.stiffness_N_per_m = grip_K, .delay_ticks = delay};
    const double limit = calm_mouse_stiffness(settings);
    CHECK(MouseHandle(settings).spec().cap_N_per_m == 0.5 * limit);
    // The poles of x' = a x - (1 - a) K_f/K x_(-delay), by a companion matrix.
    const auto pole_of = [&](double felt) {
        const double a = std::exp(-grip_K * 1e-3 / settings.damping_N_s_per_m);
        Eigen::MatrixXd loop = Eigen::MatrixXd::Zero(delay + 1, delay + 1);
        loop(0, 0) = a;
        loop(0, delay) -= (1 - a) * felt / grip_K;
        for (int i = 0; i < delay; ++i) loop(i + 1, i) = 1;
        return Eigen::EigenSolver<Eigen::MatrixXd>(loop).eigenvalues().cwiseAbs().maxCoeff();
    };
    CAPTURE(delay, grip_K, limit);
    CHECK(pole_of(0.999 * limit) < 1);
    CHECK(pole_of(1.001 * limit) > 1);
}

TEST_CASE("a mouse has no end, and goes back to its middle under the clutch", "[devices][mouse]") {
    HandOrders orders;
    MouseHandle handle({.orders = &orders});
    CHECK(handle.spec().half_workspace_m == Vec3::Zero());
    double target_m = 0;
    for (int i = 0; i < 20'000; ++i) {
        orders.post({Vec3(target_m += 2e-4, 0, 0)});
        handle.write(Vec3::Zero());
    }
    CHECK(handle.read().position_m.x() > 3.9);
    CHECK_FALSE(is_at_stop(handle.read(), handle.spec().half_workspace_m));
    CHECK_FALSE(is_pressed(handle.read().buttons, Button::Clutch));

    HandOrder released;
    released.target_m = Vec3(target_m, 0, 0);
    released.is_clutched = true;
    orders.post(released);
    for (int i = 0; i < 20'000; ++i) {
        handle.write(Vec3::Zero());
        REQUIRE(is_pressed(handle.read().buttons, Button::Clutch));
    }
    CHECK(handle.read().position_m.norm() < 1e-6);
}

TEST_CASE("a person at the mouse who sees the molecule wait goes on no farther",
          "[devices][mouse]") {
    HandOrders orders;
    MouseHandle handle({.orders = &orders});
    orders.post({Vec3(0.01, 0.01, 0)});
    const auto play = [&](const Vec3& waiting_m) {
        for (int i = 0; i < 500; ++i) {
            handle.show({}, waiting_m);
            handle.write(Vec3::Zero());
        }
        return handle.read().position_m;
    };
    CHECK((play({0.5 * MouseHandle::waits_from_m, 0, 0}) - Vec3(0.01, 0.01, 0)).norm() < 1e-6);
    // Along the waiting travel it waits; aside and back it goes.
    orders.post({Vec3(0.02, 0.02, 0)});
    const Vec3 aside = play({MouseHandle::waits_from_m, 0, 0});
    CHECK((aside - Vec3(0.01, 0.02, 0)).norm() < 1e-6);
    orders.post({Vec3::Zero()});
    CHECK(play({MouseHandle::waits_from_m, 0, 0}).norm() < 1e-6);
}

TEST_CASE("a hand pulls no harder than it can, and a mouse that leaps is no hand that does",
          "[devices][mouse]") {
    HandOrders orders;
    MouseHandle handle({.orders = &orders});
    orders.post({Vec3(0.4, 0, 0)});

    double before = 0, fastest = 0;
    for (int i = 0; i < 1000; ++i) {
        handle.write(Vec3::Zero());
        const double now = handle.read().position_m.x();
        fastest = std::max(fastest, (now - before) / servo_tick_s);
        before = now;
    }
    CHECK(fastest < live_hand_m_per_s * (1 + 1e-9));
    CHECK(fastest > 0.9 * live_hand_m_per_s);

    for (int i = 0; i < 1000; ++i) handle.write(Vec3(-live_hand_newton - 0.1, 0, 0));
    const double held = handle.read().position_m.x();
    for (int i = 0; i < 100; ++i) handle.write(Vec3(-live_hand_newton - 0.1, 0, 0));
    CHECK(handle.read().position_m.x() < held);  // it gives way
}

TEST_CASE("a mouse that nobody moves holds the handle in the middle", "[devices][mouse]") {
    HandOrders orders;
    MouseHandle led({.orders = &orders}), alone({});

    for (int i = 0; i < 500; ++i) {
        led.write(Vec3::Zero());
        alone.write(Vec3::Zero());
    }

    CHECK(led.read().position_m == Vec3::Zero());
    CHECK(alone.read().position_m == Vec3::Zero());
    CHECK(alone.read().valid);
}

TEST_CASE("a frozen mouse handle goes on for as many ticks as it is granted", "[devices][mouse]") {
    HandOrders orders;
    MouseHandle handle({.orders = &orders});
    HandOrder order{.target_m = Vec3(0.1, 0, 0), .frozen = true, .granted_ticks = 14};
    orders.post(order);
    for (int i = 0; i < 50; ++i) handle.write(Vec3::Zero());
    CHECK(handle.read().time_s == 0);

    ++order.grants;
    orders.post(order);
    for (int i = 0; i < 50; ++i) handle.write(Vec3::Zero());
    CHECK_THAT(handle.read().time_s, WithinAbs(0.014, 1e-12));
}

TEST_CASE("the grip of a scene is the mouse's spring and damper", "[devices][mouse]") {
    const MouseHandleSettings firm = mouse_handle_of(hand_model(HandGrip::Firm));
    CHECK(firm.stiffness_N_per_m == 500);
    CHECK(firm.damping_N_s_per_m == 10);
    CHECK(mouse_handle_of(hand_model(HandGrip::FirmGrip)).stiffness_N_per_m == Approx(1000.0 / 3));
    CHECK(mouse_handle_of(hand_model(HandGrip::None)).stiffness_N_per_m == K);
}

TEST_CASE("a mouse that pulls for a minute has no warm motors", "[devices]") {
    MouseHandle mouse{MouseHandleSettings{}};
    SafetySettings settings;
    limit_to(mouse.spec(), settings);
    SafetyState state;
    SafetyResult result;

    for (int i = 0; i < 60'000; ++i) {
        SafetyInput input;
        input.wanted_newton = Vec3(2.4, 0, 0);
        input.reading = mouse.read();
        input.now_s = input.reading.time_s;
        result = guard_force(settings, state, input);
        mouse.write(result.newton);
    }

    CHECK(result.newton.x() == 2.4);
    CHECK(result.stage == SafetyStage::None);
}
