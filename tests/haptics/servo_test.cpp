#include "haptics/servo.h"

#include "tests/support/two_held.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <thread>
#include <vector>

using namespace palpa;

namespace {

DeviceReading reading_at(double x, bool clutched = false) {
    return {0, Vec3(x, 0, 0), clutched ? static_cast<std::uint32_t>(Button::Clutch) : 0, true};
}

ContactModel local_contact_of(const Vec3& force_newton) {
    ContactModel contact;
    contact.force_newton = force_newton;
    return contact;
}

struct Servo {
    ServoSettings settings{PrintedForceLaw({}), {.is_full = false}, 0};
    double now_s = 0;
    ServoState state;
    Exchange exchange;

    ServoTick tick(const DeviceReading& reading) {
        return step_servo(settings, state, exchange, reading, now_s += 1e-3);
    }
};

}  // namespace

TEST_CASE("the hand feels eq. 2 of the newest force, along its direction", "[haptics][servo]") {
    Servo servo;
    const Vec3 direction = Vec3(1, -2, 2) / 3;
    servo.exchange.contact.post(local_contact_of({9e-9, 0, 0}));
    servo.exchange.contact.post(local_contact_of(1.5e-9 * direction));

    const ServoTick tick = servo.tick(reading_at(0));

    CHECK(tick.sent_newton.norm() == Approx(1.5744).epsilon(1e-4));
    CHECK((tick.sent_newton.normalized() - direction).norm() < 1e-14);
    CHECK_FALSE(tick.clamped);
    // Without a new model the last one stays in force.
    CHECK(servo.tick(reading_at(0)).sent_newton == tick.sent_newton);
}

TEST_CASE("nothing is felt before the first contact model", "[haptics][servo]") {
    Servo servo;

    CHECK(servo.tick(reading_at(0.01)).sent_newton == Vec3(Vec3::Zero()));
}

TEST_CASE("the norm of the force is clamped at 3 N", "[haptics][servo]") {
    Servo servo;
    servo.settings.force_law = ConstantForceLaw{5.1e9};
    servo.exchange.contact.post(local_contact_of({3e-9, 4e-9, 0}));

    const ServoTick tick = servo.tick(reading_at(0));

    CHECK(tick.clamped);
    CHECK((tick.sent_newton - Vec3(1.8, 2.4, 0)).norm() < 1e-14);
}

TEST_CASE("a force that is no number stops the device within the tick and for good",
          "[haptics][servo]") {
    const double bad =
        GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
    Servo servo;
    servo.settings.force_law = ConstantForceLaw{1e9};
    servo.settings.delay_ticks = GENERATE(0, 2);
    servo.exchange.contact.post(local_contact_of({1e-9, 0, 0}));
    for (int i = 0; i < 4; ++i) CHECK(servo.tick(reading_at(0)).sent_newton.x() == Approx(1));
    servo.exchange.contact.post(local_contact_of({0, bad, 0}));

    const ServoTick tick = servo.tick(reading_at(0));
    servo.exchange.contact.post(local_contact_of({1e-9, 0, 0}));
    const ServoTick later = servo.tick(reading_at(0));

    CHECK(tick.sent_newton == Vec3(Vec3::Zero()));
    CHECK(tick.stopped);
    CHECK(later.sent_newton == Vec3(Vec3::Zero()));
    CHECK(later.stopped);
}

TEST_CASE("a delayed force is sent as many ticks later", "[haptics][servo]") {
    const int delay = GENERATE(0, 1, 3, max_servo_delay_ticks);
    Servo servo;
    servo.settings.force_law = ConstantForceLaw{1e9};
    servo.settings.delay_ticks = delay;

    for (int i = 0; i < 40; ++i) {
        servo.exchange.contact.post(local_contact_of({(i + 1) * 1e-11, 0, 0}));
        const ServoTick tick = servo.tick(reading_at(0));
        CHECK(tick.sent_newton.x() == Approx((std::max(i - delay, 0) + 1) * 0.01));
    }
}

TEST_CASE("travel with the clutch pressed does not reach the molecule", "[haptics][servo]") {
    Servo servo;
    HandPose hand;
    const auto travel_after = [&](const DeviceReading& reading) {
        (void)servo.tick(reading);
        REQUIRE(servo.exchange.hand.read(hand));
        return hand.travel_m.x();
    };

    CHECK(travel_after(reading_at(0.010)) == 0);  // where the handle begins is no travel
    CHECK(travel_after(reading_at(0.014)) == Approx(0.004));
    CHECK(travel_after(reading_at(0.020, true)) == Approx(0.004));
    CHECK(travel_after(reading_at(-0.050, true)) == Approx(0.004));
    CHECK(travel_after(reading_at(-0.051)) == Approx(0.003));
}

TEST_CASE("a reading that is not valid moves nothing", "[haptics][servo]") {
    Servo servo;
    HandPose hand;
    (void)servo.tick(reading_at(0.01));
    DeviceReading bad = reading_at(std::numeric_limits<double>::quiet_NaN());

    (void)servo.tick(bad);
    bad = reading_at(0.5);
    bad.valid = false;
    (void)servo.tick(bad);
    (void)servo.tick(reading_at(0.02));

    REQUIRE(servo.exchange.hand.read(hand));
    CHECK(hand.travel_m.x() == Approx(0.01));
    CHECK(std::isfinite(servo.state.hand_energy_J));
}

TEST_CASE("a handle that is too fast gets no force in the paper's coupling either",
          "[haptics][servo]") {
    const bool is_mad = GENERATE(false, true);
    Servo servo;
    servo.settings.force_law = ConstantForceLaw{1e9};
    servo.settings.safety.is_full = true;
    servo.exchange.contact.post(local_contact_of({1e-9, 0, 0}));
    for (int i = 0; i < 10; ++i) CHECK(servo.tick(reading_at(0.01)).sent_newton.x() > 0);

    double x_m = 0.01;
    ServoTick tick;
    if (is_mad) {
        (void)servo.tick(reading_at(1e308));
        tick = servo.tick(reading_at(-1e308));
    } else {
        for (int i = 0; i < 5; ++i) tick = servo.tick(reading_at(x_m += 2e-3));
        CHECK(tick.stage == SafetyStage::TooFast);
    }
    CHECK(tick.sent_newton == Vec3::Zero());

    // Once it is slow the force comes back.
    servo.exchange.contact.post(local_contact_of(Vec3::Zero()));
    for (int i = 0; i < 2100; ++i) {
        if (i % 50 == 0) servo.exchange.contact.post(local_contact_of({i < 50 ? 0 : 1e-9, 0, 0}));
        tick = servo.tick(reading_at(x_m));
    }
    CHECK(tick.sent_newton.x() > 0.9);
}

TEST_CASE("the safety chain begins to watch where the paper's coupling left off",
          "[haptics][servo]") {
    Servo servo;
    servo.settings.force_law = ConstantForceLaw{1e9};
    servo.exchange.contact.post(local_contact_of({2e-9, 0, 0}));
    double last = 0;
    for (int i = 0; i < 500; ++i) last = servo.tick(reading_at(0.01)).sent_newton.x();
    CHECK(last == Approx(2));

    servo.settings.safety.is_full = true;
    servo.settings.safety.starts_engaged = false;
    servo.exchange.contact.post(local_contact_of({2e-9, 0, 0}));
    for (int i = 0; i < 20; ++i) {
        const ServoTick tick = servo.tick(reading_at(0.01));
        CHECK(tick.stage == SafetyStage::None);
        CHECK(tick.sent_newton.x() == Approx(2));
    }
}

TEST_CASE("the energy observer sums the force sent times the way it went", "[haptics][servo]") {
    Servo servo;
    servo.settings.force_law = ConstantForceLaw{1e9};
    servo.settings.delay_ticks = GENERATE(0, 2);
    double work = 0, x = 0;
    Vec3 sent = Vec3::Zero();

    for (int i = 0; i < 50; ++i) {
        const double before = x;
        x = 0.01 * std::sin(0.3 * i);
        if (i > 0) work += sent.x() * (x - before);
        servo.exchange.contact.post(local_contact_of({1e-9 * std::cos(0.2 * i), 0, 0}));
        const ServoTick tick = servo.tick(reading_at(x));
        CHECK(tick.hand_energy_J == Approx(work).margin(1e-15));
        sent = tick.sent_newton;
    }
}

TEST_CASE("servo and simulation meet in the exchange without a race", "[haptics][servo]") {
    Servo servo;
    std::atomic<bool> done = false;
    std::atomic<int> answered = 0;

    std::thread simulation([&] {
        HandPose hand;
        while (!done) {
            if (!servo.exchange.hand.read(hand)) continue;
            servo.exchange.contact.post(local_contact_of({-1e-8 * hand.travel_m.x(), 0, 0}));
            ++answered;
        }
    });
    bool finite = true;
    for (int i = 0; i < 20'000 || answered < 100; ++i) {
        finite =
            finite && servo.tick(reading_at(0.05 * std::sin(0.01 * i))).sent_newton.allFinite();
    }
    done = true;
    simulation.join();

    CHECK(finite);
}

namespace {

// Two guarded hands, each with an ion, 5 Å from each other along x; every mm of the handle moves
// its ion by 0.1 Å.
struct TwoServos {
    test::TwoHeld pair{{test::sphere_body(0.5), test::sphere_body(-0.5)}, {}, {false, false}};
    std::vector<ServoHand> hands = std::vector<ServoHand>(2);
    std::array<MoleculePose, 2> poses;
    double now_s = 0;

    TwoServos() {
        poses[1].place_angstrom.x() = 5;
        for (std::size_t i = 0; i < 2; ++i) {
            GuardedSettings& guarded = hands[i].settings.guarded.emplace();
            guarded.force_law = ConstantForceLaw{1e9};
            guarded.displacement_law = ConstantDisplacementLaw{1e8};
            hands[i].exchange.contact.post(pair.contact(i, poses));
            hands[i].reading.valid = true;
        }
    }
    // Both handles went by so many mm along x.
    void tick(double first_mm, double second_mm) {
        hands[0].reading.position_m.x() += first_mm * 1e-3;
        hands[1].reading.position_m.x() += second_mm * 1e-3;
        step_servos(hands, now_s += 1e-3);
        for (std::size_t i = 0; i < 2; ++i) {
            HandPose pose;
            REQUIRE(hands[i].exchange.hand.read(pose));
            poses[i] = pose.molecule.value();
        }
    }
    Vec3 told(std::size_t hand) const { return hands[hand].tick.contact.force_newton; }
};

}  // namespace

TEST_CASE("a hand feels those before it where they are, and those after it where they were",
          "[haptics][servo][held]") {
    TwoServos servos;
    servos.tick(0, 0);
    const std::array<MoleculePose, 2> before = servos.poses;

    servos.tick(0.3, 0.5);

    REQUIRE(servos.poses[0].place_angstrom.x() == Approx(0.03));
    REQUIRE(servos.poses[1].place_angstrom.x() == Approx(5.05));
    const auto within = [](const Vec3& a, const Vec3& b) {
        return (a - b).norm() < 1e-5 * b.norm();
    };
    CHECK(within(servos.told(0), servos.pair.newton(0, {servos.poses[0], before[1]})));
    CHECK(within(servos.told(1), servos.pair.newton(1, servos.poses)));
    CHECK_FALSE(within(servos.told(0), servos.pair.newton(0, servos.poses)));
    // And both, once they rest, at the same places.
    servos.tick(0, 0);
    CHECK(within(servos.told(0), servos.pair.newton(0, servos.poses)));
    CHECK(within(servos.told(0), -servos.told(1)));
}

TEST_CASE("a hand that rests feels another one come, at every tick and not once a step",
          "[haptics][servo][held]") {
    TwoServos servos;
    for (int i = 0; i < 100; ++i) {
        servos.tick(0, i == 0 ? 0 : -0.1);
        // Its neighbour of the last tick is nearer by a hundredth of an Å than in the one before.
        std::array<MoleculePose, 2> then = servos.poses;
        then[1].place_angstrom.x() = 5 - 0.01 * std::max(0, i - 1);
        CHECK(servos.told(0).x() == Approx(servos.pair.newton(0, then).x()).epsilon(1e-5));
    }
    CHECK(servos.poses[0].place_angstrom.x() == 0);
    CHECK(servos.poses[1].place_angstrom.x() == Approx(5 - 0.99));
}

TEST_CASE("of one hand, the servo of several does the same to the bit", "[haptics][servo]") {
    Servo alone;
    alone.settings.guarded.emplace();
    std::vector<ServoHand> hands(1);
    hands[0].settings = alone.settings;
    const LocalContactModel contact = local_contact_of({1e-9, -2e-9, 0.5e-9});
    alone.exchange.contact.post(contact);
    hands[0].exchange.contact.post(contact);
    for (int i = 0; i < 50; ++i) {
        hands[0].reading = reading_at(1e-4 * i, i % 10 == 3);
        const ServoTick expected = alone.tick(hands[0].reading);
        step_servos(hands, alone.now_s);
        CHECK(hands[0].tick.sent_newton == expected.sent_newton);
        CHECK(hands[0].tick.contact.molecule.place_angstrom ==
              expected.contact.molecule.place_angstrom);
    }
}
