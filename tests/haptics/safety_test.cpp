#include "haptics/safety.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
const Vec3 zero = Vec3::Zero();

// Ticks with nothing wrong: the handle trembles by an encoder step, clocks run.
struct Guard {
    SafetySettings settings;
    SafetyState state;
    SafetyInput input;
    int ticks = 0;

    // The force of the tick, from the input as it stands.
    SafetyResult guard(const Vec3& wanted) {
        input.wanted_newton = wanted;
        return guard_force(settings, state, input);
    }
    SafetyResult tick(const Vec3& wanted) {
        ++ticks;
        input.now_s = ticks * servo_tick_s;
        input.reading.valid = true;
        input.reading.time_s = input.now_s;
        input.reading.position_m = Vec3(ticks % 2 == 0 ? 0 : 0.055e-3, 0, 0);
        return guard(wanted);
    }
    SafetyResult tick(double wanted_x, int times = 1) {
        SafetyResult result;
        for (int i = 0; i < times; ++i) result = tick(Vec3(wanted_x, 0, 0));
        return result;
    }
};

// The paper's loop had these lines.
Vec3 papers_force(const Vec3& force) {
    const double norm = force.norm();
    const bool clamped = norm > 3.0;
    return clamped ? Vec3(force * (3.0 / norm)) : force;
}

}  // namespace

TEST_CASE("where nothing is wrong the wanted force is sent to the last bit", "[haptics][safety]") {
    Guard guard;

    for (int i = 0; i < 5000; ++i) {
        const Vec3 wanted(0.6 * std::sin(0.05 * i), 0.3 * std::cos(0.03 * i) - 0.3, 0.1);
        const SafetyResult result = guard.tick(wanted);
        REQUIRE(result.newton == wanted);
        REQUIRE(result.stage == SafetyStage::None);
        REQUIRE(result.share == 1);
    }
}

TEST_CASE("the norm of the force is clamped along its direction", "[haptics][safety]") {
    Guard guard;
    for (int i = 0; i < 10; ++i) (void)guard.tick(Vec3(3, 4, 0));

    const SafetyResult result = guard.tick(Vec3(3, 4, 0));

    CHECK((result.newton - Vec3(1.8, 2.4, 0)).norm() < 1e-14);
    CHECK(result.stage == SafetyStage::Clamped);
    CHECK(result.share == Approx(0.6));
}

TEST_CASE("the force changes by half a newton in a millisecond", "[haptics][safety]") {
    Guard guard;

    for (int i = 1; i <= 5; ++i) {
        const SafetyResult result = guard.tick(2.75);
        CHECK(result.newton.x() == Approx(0.5 * i));
        CHECK(result.stage == SafetyStage::Slewed);
    }
    CHECK(guard.tick(2.75).newton.x() == 2.75);
    CHECK(guard.tick(-2.75).newton.x() == Approx(2.25));
    // A tick that comes late, but not too late, may not change it by more.
    guard.ticks += 10;
    CHECK(guard.tick(-2.75).newton.x() == Approx(1.75));
}

TEST_CASE("a force that is no number is zero at once and until released", "[haptics][safety]") {
    const double bad = GENERATE(-infinite, infinite, no_number);
    Guard guard;
    guard.tick(1, 10);
    CAPTURE(bad);

    const SafetyResult result = guard.tick(Vec3(0, bad, 1));

    CHECK(result.newton == zero);
    CHECK(result.stage == SafetyStage::NotFinite);
    CHECK(is_latched(guard.state));
    CHECK(guard.tick(0, 5000).newton == zero);
    CHECK(guard.tick(1).stage == SafetyStage::NotFinite);

    release(guard.state);
    CHECK_FALSE(is_latched(guard.state));
    CHECK(guard.tick(1, 100).stage == SafetyStage::Waiting);
    CHECK(guard.tick(1).reason == SafetyStage::NotFinite);
    guard.tick(0, 4);
    CHECK(guard.tick(1).newton.x() > 0);
}

TEST_CASE("a jump of more than five millimetres takes the force away in its tick",
          "[haptics][safety]") {
    const double jump_m = GENERATE(0.0049, 0.0051, -0.3, 1e300);
    Guard guard;
    guard.tick(2, 100);
    ++guard.ticks;
    guard.input.now_s = guard.ticks * servo_tick_s;
    guard.input.reading.position_m += Vec3(0, jump_m, 0);

    const SafetyResult result = guard.guard(Vec3(2, 0, 0));

    const bool is_jump = std::abs(jump_m) > 0.005;
    CHECK(result.newton.x() == (is_jump ? 0 : 2));
    CHECK(result.stage == (is_jump ? SafetyStage::Jump : SafetyStage::None));
}

TEST_CASE("a handle may go five millimetres for each tick that could not be read",
          "[haptics][safety]") {
    Guard guard;
    guard.tick(2, 100);
    for (int i = 0; i < 4; ++i) {
        ++guard.ticks;
        guard.input.now_s = guard.ticks * servo_tick_s;
        guard.input.reading.valid = false;
        CHECK(guard.guard(Vec3(2, 0, 0)).newton.x() == 2);
    }
    ++guard.ticks;
    guard.input.now_s = guard.ticks * servo_tick_s;
    guard.input.reading.valid = true;

    SECTION("24 mm in five ticks are none") {
        guard.input.reading.position_m.y() = 0.024;
        CHECK(guard.guard(Vec3(2, 0, 0)).stage == SafetyStage::None);
    }
    SECTION("26 mm are a jump") {
        guard.input.reading.position_m.y() = 0.026;
        CHECK(guard.guard(Vec3(2, 0, 0)).stage == SafetyStage::Jump);
    }
}

TEST_CASE("a handle faster than the limit gets no force, and engages again", "[haptics][safety]") {
    const double speed = GENERATE(1.49, 1.51, no_number, infinite);
    Guard guard;
    guard.tick(1, 10);
    guard.input.velocity_m_per_s = Vec3(0, 0, speed);

    const SafetyResult result = guard.tick(1);
    guard.input.velocity_m_per_s.setZero();
    const SafetyResult after = guard.tick(1);

    if (speed < 1.5) {
        CHECK(result.newton.x() == 1);
        CHECK(after.newton.x() == 1);
        return;
    }
    CHECK(result.newton == zero);
    CHECK(result.stage == SafetyStage::TooFast);
    CHECK(after.newton == zero);
    CHECK(after.stage == SafetyStage::Waiting);
    CHECK(after.reason == SafetyStage::TooFast);
}

TEST_CASE("the force comes back after four quiet ticks, in two seconds", "[haptics][safety]") {
    Guard guard;
    guard.settings.starts_engaged = GENERATE(true, false);
    const SafetyStage reason =
        guard.settings.starts_engaged ? SafetyStage::Unplugged : SafetyStage::None;
    if (guard.settings.starts_engaged) {
        guard.input.reading.valid = false;
        CHECK(guard.guard(Vec3(1, 0, 0)).stage == SafetyStage::Unplugged);  // never read
    }

    CHECK(guard.tick(1, 1000).newton == zero);  // in contact it waits
    CHECK(guard.tick(0.19, 3).stage == SafetyStage::Waiting);
    CHECK(guard.tick(0.21).stage == SafetyStage::Waiting);  // not in a row
    CHECK(guard.tick(0.19, 3).stage == SafetyStage::Waiting);
    const SafetyResult first = guard.tick(0.19);
    CHECK(first.stage == SafetyStage::Engaging);
    CHECK(first.reason == reason);
    CHECK(first.newton.x() == Approx(0.19 / 2000));
    const SafetyResult middle = guard.tick(1, 999);
    CHECK(middle.newton.x() == Approx(0.5));
    CHECK(middle.share == Approx(0.5));
    CHECK(guard.tick(1, 999).reason == reason);
    const SafetyResult last = guard.tick(1);
    CHECK(last.newton.x() == 1);
    CHECK(last.stage == SafetyStage::None);
    CHECK(last.reason == SafetyStage::None);
}

TEST_CASE("a clock that is late, goes back or is no number takes the force away",
          "[haptics][safety]") {
    const double elapsed_s =
        GENERATE(0.019, 0.021, 3600.0, -0.001, -1e300, 1e300, no_number, infinite);
    Guard guard;
    guard.tick(1, 100);
    guard.input.now_s += elapsed_s;

    const SafetyResult result = guard.guard(Vec3(1, 0, 0));

    if (elapsed_s == 0.019) {
        CHECK(result.newton.x() == 1);
        return;
    }
    CHECK(result.newton == zero);
    CHECK(result.stage == SafetyStage::Late);
    // From there on the clock is good again.
    const double from_s = std::isfinite(elapsed_s) ? guard.input.now_s : 5;
    if (std::abs(from_s) > 1e9) return;  // where a millisecond is less than a step of the clock
    for (int i = 1; i <= 3000; ++i) {
        guard.input.now_s = from_s + i * servo_tick_s;
        guard.input.reading.time_s = i * servo_tick_s;
        const SafetyResult later = guard.guard(Vec3(0.1, 0, 0));
        REQUIRE(later.newton.x() <= 0.1);
        if (i == 3000) CHECK(later.newton.x() == 0.1);
    }
}

TEST_CASE("a clock that stands still stops the force after twenty ticks, and no watch stops",
          "[haptics][safety]") {
    Guard guard;
    guard.tick(1, 100);

    for (int i = 0; i < 19; ++i) REQUIRE(guard.guard(Vec3(1, 0, 0)).newton.x() == 1);
    CHECK(guard.guard(Vec3(1, 0, 0)).stage == SafetyStage::Late);
    for (int i = 0; i < 10'000; ++i) REQUIRE(guard.guard(zero).newton == zero);
    guard.tick(0, 4);
    CHECK(guard.tick(1).newton.x() > 0);
}

TEST_CASE("an old model fades the force, to zero at 0.2 s or two periods", "[haptics][safety]") {
    const auto [period_s, stale_s, dead_s] = GENERATE(table<double, double, double>({
        {0.001, 0.1, 0.2},
        {0.083, 0.1245, 0.2},
        {0.1, 0.15, 0.2},
        {0.15, 0.225, 0.3},
        {1, 1.5, 2},
        {no_number, 0.1, 0.2},
        {infinite, 0.1, 0.2},
        {-1, 0.1, 0.2},
    }));
    CAPTURE(period_s);
    Guard guard;
    guard.settings.thermal_limit_newton = infinite;
    guard.input.period_s = period_s;
    guard.tick(2, 100);
    guard.input.model_age_s = stale_s - 1e-6;
    CHECK(guard.tick(2, 3000).newton.x() == 2);

    SECTION("an age that grows") {
        while (guard.input.model_age_s < (stale_s + dead_s) / 2) {
            guard.input.model_age_s += servo_tick_s;
            (void)guard.tick(2);
        }
        CHECK(guard.tick(2).newton.x() == Approx(1).margin(0.1));  // a tick or two of 50
        CHECK(guard.tick(2).stage == SafetyStage::Stale);
        while (guard.input.model_age_s < dead_s) {
            guard.input.model_age_s += servo_tick_s;
            (void)guard.tick(2);
        }
        CHECK(guard.tick(2).newton == zero);
        CHECK(guard.tick(2).reason == SafetyStage::Stale);
    }
    SECTION("a new one that comes in time brings it back") {
        guard.input.model_age_s = stale_s + 0.001;
        const double half = guard.tick(2, 20).newton.x();
        guard.input.model_age_s = 0;
        CHECK(half < 2);
        CHECK(guard.tick(2, 21).newton.x() == Approx(2));
        CHECK(guard.tick(2).stage == SafetyStage::None);
    }
    SECTION("else through quiet cycles and ramp") {
        guard.input.model_age_s = GENERATE(3.0, 1e300, infinite, no_number);
        CHECK(guard.tick(2, 501).newton == zero);
        guard.input.model_age_s = 0;
        CHECK(guard.tick(2, 1000).stage == SafetyStage::Waiting);
        CHECK(guard.tick(2).reason == SafetyStage::Stale);
        guard.tick(0, 4);
        CHECK(guard.tick(2, 1999).newton.x() == Approx(2));
    }
}

TEST_CASE("ticks that are slow on average take the force away within half a second",
          "[haptics][safety]") {
    const auto tick_us = GENERATE(1000, 1900, 2100, 5000, 19'900);
    CAPTURE(tick_us);
    Guard guard;
    guard.tick(1, 1000);
    double now_s = guard.input.now_s;
    double off_s = -1;

    for (double s = 0; s < 3; s += 1e-6 * tick_us) {
        now_s += 1e-6 * tick_us;
        guard.input.now_s = guard.input.reading.time_s = now_s;
        guard.input.reading.position_m.x() += 1e-5;
        const SafetyResult result = guard.guard(Vec3(1, 0, 0));
        if (result.newton == zero && off_s < 0) off_s = s;
        if (off_s >= 0) REQUIRE(result.newton == zero);
    }

    if (tick_us < 2000) {
        CHECK(off_s < 0);
    } else {
        CHECK(off_s >= 0);
        CHECK(off_s <= 0.53);  // what came before was quick
    }
}

TEST_CASE("some ticks of 19 ms are none of a slow loop", "[haptics][safety]") {
    Guard guard;
    double now_s = 0;

    for (int i = 0; i < 5000; ++i) {
        now_s += i % 100 == 0 ? 0.019 : 0.001;
        guard.input.now_s = guard.input.reading.time_s = now_s;
        guard.input.reading.valid = true;
        guard.input.reading.position_m.x() += 1e-5;
        REQUIRE(guard.guard(Vec3(1, 0, 0)).stage <= SafetyStage::Slewed);
    }
}

TEST_CASE("what fades keeps to the slew at long ticks", "[haptics][safety]") {
    const int cause = GENERATE(0, 1, 2);
    const SafetyStage stage =
        std::vector{SafetyStage::Ending, SafetyStage::Stale, SafetyStage::CoolDown}[cause];
    Guard guard;
    guard.tick(3, 20);
    if (cause == 0) guard.input.is_ending = true;
    if (cause == 1) guard.input.model_age_s = 10;
    if (cause == 2) guard.input.reading.trouble = DeviceTrouble::WarmMotors;
    double last = 3;

    for (int i = 0; i < 13; ++i) {
        guard.ticks += 14;
        const SafetyResult result = guard.tick(3);
        CHECK(last - result.newton.x() <= 0.5 + 1e-12);
        CHECK(result.stage >= stage);
        last = result.newton.x();
    }
    CHECK(last == 0);
}

TEST_CASE("three newtons are felt for 2.7 s, then 0.88 N for as long as wanted",
          "[haptics][safety]") {
    Guard guard;
    std::vector<double> sent;
    for (int i = 0; i < 600'000; ++i) sent.push_back(guard.tick(3).newton.x());

    // mean = 9 (1 - exp(-t / 30 s)) reaches 0.7744 at t = -30 s ln(1 - 0.7744 / 9). Slewing cost
    // less than 6 ms.
    const double hot_s = -30 * std::log(1 - 0.7744 / 9);
    CHECK(hot_s == Approx(2.70).margin(0.005));
    const auto at = [&](double s) { return sent[static_cast<std::size_t>(s / servo_tick_s)]; };
    CHECK(at(hot_s - 0.005) == 3);
    CHECK(at(hot_s + 0.5) == Approx(3 - 0.5 * 2.12).margin(0.015));
    CHECK(at(hot_s + 1.01) == Approx(0.88));
    CHECK(*std::min_element(sent.begin() + 2, sent.end()) == Approx(0.88));
    CHECK(guard.tick(3).stage == SafetyStage::ThermalLimit);
    CHECK(guard.tick(0.5).stage == SafetyStage::None);  // it does not act on less

    // At rest the mean falls from 0.7744 to 0.8 of it in 30 s ln(1 / 0.8) = 6.69 s.
    guard.tick(0, 6600);
    CHECK(guard.tick(3).newton.x() == 0.5);
    CHECK(guard.tick(3).newton.x() == Approx(0.88));
    guard.tick(0, 200);
    CHECK(guard.tick(0, 1100).stage == SafetyStage::None);
    CHECK(guard.tick(3, 6).newton.x() == Approx(3));
}

TEST_CASE("a force below the heat limit is never limited", "[haptics][safety]") {
    Guard guard;
    bool acted = false;

    for (int i = 0; i < 200'000; ++i) acted = acted || guard.tick(0.87).share < 1;

    CHECK_FALSE(acted);
}

TEST_CASE("exit takes the force away within ten milliseconds", "[haptics][safety]") {
    Guard guard;
    guard.tick(3, 100);
    guard.input.is_ending = true;

    for (int i = 1; i < 10; ++i) {
        const SafetyResult result = guard.tick(3);
        CHECK(result.newton.x() == Approx(3 * (1 - 0.1 * i)));
        CHECK(result.stage == SafetyStage::Ending);
    }
    CHECK(guard.tick(3).newton == zero);
    CHECK(guard.tick(3, 1000).newton == zero);
}

TEST_CASE("a reading that stands still with its time stamp takes the force away after 50 ms",
          "[haptics][safety]") {
    Guard guard;
    guard.tick(1, 100);
    const auto hung_tick = [&](double wanted) {
        guard.input.now_s += servo_tick_s;
        return guard.guard(Vec3(wanted, 0, 0));
    };

    SECTION("while the force changes") {
        for (int i = 0; i < 49; ++i) REQUIRE(hung_tick(1 + 1e-3 * i).newton.x() >= 1);
        CHECK(hung_tick(1).stage == SafetyStage::Frozen);
        for (int i = 0; i < 100; ++i) REQUIRE(hung_tick(0).newton == zero);
        guard.ticks += 152;
        CHECK(guard.tick(1).stage == SafetyStage::Waiting);
        CHECK(guard.tick(1).reason == SafetyStage::Frozen);
    }
    SECTION("not while it stays the same") {
        for (int i = 0; i < 1000; ++i) REQUIRE(hung_tick(1).newton.x() == 1);
    }
    SECTION("not on a device that has no time stamp") {
        Guard other;
        for (int i = 0; i < 1000; ++i) {
            other.input.now_s += servo_tick_s;
            other.input.reading.valid = true;
            REQUIRE(other.guard(Vec3(1e-3 * i, 0, 0)).stage == SafetyStage::None);
        }
    }
}

TEST_CASE("a position that withstands a change of two newtons for 50 ms is that of no device",
          "[haptics][safety]") {
    const double change = GENERATE(1.9, 2.1);
    Guard guard;
    guard.tick(0.5, 100);
    const Vec3 held = guard.input.reading.position_m;
    const auto still_tick = [&](double wanted) {
        ++guard.ticks;
        guard.input.now_s = guard.input.reading.time_s = guard.ticks * servo_tick_s;
        guard.input.reading.position_m = held;
        return guard.guard(Vec3(wanted, 0, 0));
    };
    for (int i = 0; i < 51; ++i) (void)still_tick(0.5);
    SafetyResult result;
    int ticks = 0;

    while (ticks < 1000 && result.stage != SafetyStage::Frozen) {
        result = still_tick(0.5 + change);
        ++ticks;
    }

    if (change < 2) {
        CHECK(ticks == 1000);
        return;
    }
    // 5 ticks of slew until 2 N are passed, 50 ms, and one tick to see the first force.
    CHECK(ticks == 55);
    CHECK(result.newton == zero);
    for (int i = 0; i < 100; ++i) REQUIRE(still_tick(0).stage == SafetyStage::Frozen);
    guard.tick(0);  // one of two ticks moves by a step
    CHECK(guard.tick(0).stage == SafetyStage::Waiting);
}

TEST_CASE("a position that withstands a force that alternates is that of no device",
          "[haptics][safety]") {
    const int half_ms = GENERATE(15, 20, 40, 49, 100);
    CAPTURE(half_ms);
    Guard guard;
    guard.settings.thermal_limit_newton = infinite;
    guard.tick(0, 100);
    const Vec3 held = guard.input.reading.position_m;
    int ticks = 0;
    SafetyResult result;

    while (ticks < 2000 && result.stage != SafetyStage::Frozen) {
        ++guard.ticks;
        guard.input.now_s = guard.input.reading.time_s = guard.ticks * servo_tick_s;
        guard.input.reading.position_m = held;
        result = guard.guard(Vec3(ticks / half_ms % 2 == 0 ? 2.9 : -2.9, 0, 0));
        ++ticks;
    }

    CHECK(ticks <= 400);
    CHECK(result.newton == zero);
}

TEST_CASE("a time stamp that is no number does not keep the force", "[haptics][safety]") {
    const double stamp_s = GENERATE(no_number, infinite);
    Guard guard;
    guard.tick(1, 100);
    const DeviceReading last = guard.input.reading;
    SafetyResult result;

    for (int i = 0; i < 10; ++i) {
        guard.input.now_s += servo_tick_s;
        guard.input.reading = last;
        guard.input.reading.time_s = stamp_s;
        result = guard.guard(Vec3(1 + 0.01 * i, 0, 0));
    }

    CHECK(result.newton == zero);
    CHECK(result.stage == SafetyStage::Unplugged);
}

TEST_CASE("a handle whose turn is no number is unplugged", "[haptics][safety]") {
    Guard guard;
    guard.tick(1, 100);

    guard.input.reading.orientation.x() = no_number;

    CHECK(guard.tick(1, 10).stage == SafetyStage::Unplugged);
}

TEST_CASE("disengaged, the force goes within the slew and stays away whatever happens",
          "[haptics][safety]") {
    Guard guard;
    guard.tick(2, 100);
    disengage(guard.state);

    CHECK(guard.tick(2).newton.x() == Approx(1.5));
    CHECK(guard.tick(2, 3).newton.x() == Approx(0).margin(1e-12));
    CHECK(guard.tick(0, 5000).stage == SafetyStage::Disengaged);
    // A pause: the device stands still, the clock jumps.
    guard.input.now_s += 100;
    CHECK(guard.guard(zero).stage == SafetyStage::Disengaged);
    for (int i = 0; i < 100; ++i) CHECK(guard.guard(zero).stage == SafetyStage::Disengaged);

    engage(guard.state);
    CHECK(guard.tick(2).stage == SafetyStage::Waiting);
    CHECK(guard.tick(2).reason == SafetyStage::None);
    guard.tick(0, 4);
    CHECK(guard.tick(2, 1999).newton.x() == Approx(2));
    engage(guard.state);
    CHECK(guard.tick(2).newton.x() == 2);
}

TEST_CASE("the paper's loop knows clamp and non-finite only, to the last bit",
          "[haptics][safety]") {
    SafetySettings settings;
    settings.is_full = false;
    settings.starts_engaged = false;
    SafetyState state;
    std::mt19937 random(7);
    std::normal_distribution<double> component(0, 2);
    SafetyInput input;
    input.now_s = no_number;
    input.reading = {no_number, Vec3::Constant(no_number), 0, false};
    input.model_age_s = infinite;
    input.velocity_m_per_s = Vec3::Constant(no_number);
    input.is_ending = true;
    disengage(state);

    int clamped = 0;
    for (int i = 0; i < 10'000; ++i) {
        input.wanted_newton = Vec3(component(random), component(random), component(random));
        if (i % 100 == 0) input.wanted_newton *= 1e200;
        const SafetyResult result = guard_force(settings, state, input);
        REQUIRE(result.newton == papers_force(input.wanted_newton));
        const bool is_clamped = input.wanted_newton.norm() > 3;
        REQUIRE(result.stage == (is_clamped ? SafetyStage::Clamped : SafetyStage::None));
        if (is_clamped) ++clamped;
    }
    CHECK(clamped > 1000);
    CHECK(clamped < 9000);

    input.wanted_newton = Vec3(0, infinite, 0);
    CHECK(guard_force(settings, state, input).newton == zero);
    input.wanted_newton = Vec3(1, 0, 0);
    const SafetyResult after = guard_force(settings, state, input);
    CHECK(after.newton == zero);
    CHECK(after.stage == SafetyStage::NotFinite);
    CHECK(is_latched(state));
}

TEST_CASE("whatever comes in, the force is finite, clamped and slewed, or zero",
          "[haptics][safety]") {
    SafetySettings settings;
    const int rarity = GENERATE(1, 100);  // of what takes the force away
    settings.ramp_s = rarity == 1 ? 0.01 : 2;
    settings.starts_engaged = GENERATE(true, false);
    SafetyState state;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto dice = [&](int sides) {
        return std::uniform_int_distribution<int>(1, sides)(random) == 1;
    };
    const std::vector<double> odd{no_number, infinite, -infinite, 1e300, -1e300,
                                  1e-300,    0,        -0.0,      1e6,   -5};
    // Now and then something odd instead of what is sane.
    const auto sprinkled = [&](double sane) {
        if (!dice(500 * rarity)) return sane;
        return odd[std::uniform_int_distribution<std::size_t>(0, odd.size() - 1)(random)];
    };
    Vec3 wanted = zero, last = zero;
    double now_s = 0;
    int with_force = 0;
    std::set<SafetyStage> stages;

    for (int i = 0; i < 100'000; ++i) {
        if (dice(50)) {
            const double size = dice(2) ? 0.1 : 8;
            wanted = size * Vec3(unit(random), unit(random), unit(random));
        }
        now_s += 1e-3 * (1 + 0.5 * unit(random));
        SafetyInput input;
        for (int axis = 0; axis < 3; ++axis) {
            input.wanted_newton(axis) = dice(20) ? sprinkled(wanted(axis)) : wanted(axis);
            input.reading.position_m(axis) = sprinkled(0.01 + 1e-4 * unit(random));
            input.velocity_m_per_s(axis) = sprinkled(0.1 * unit(random));
        }
        input.reading.time_s = sprinkled(now_s);
        input.reading.valid = !dice(100);
        input.now_s = sprinkled(now_s);
        input.model_age_s = sprinkled(0.01);
        input.period_s = sprinkled(0.014);
        input.is_ending = dice(1000 * rarity);
        if (dice(100)) release(state);
        if (dice(1000 * rarity)) disengage(state);
        if (dice(50)) engage(state);

        const SafetyResult result = guard_force(settings, state, input);

        const Vec3& force = result.newton;
        REQUIRE(force.allFinite());
        REQUIRE(force.norm() <= 3 + 1e-12);
        REQUIRE((force == zero || (force - last).norm() <= 0.5 + 1e-12));
        REQUIRE(result.share >= 0);
        REQUIRE(result.share <= 1);
        if (force != zero) ++with_force;
        stages.insert(result.stage);
        last = force;
    }

    CHECK(with_force > (rarity == 1 ? 20'000 : 50'000));
    CHECK(stages.size() >= 10);
}

TEST_CASE("every stage has a sentence for the user", "[haptics][safety]") {
    std::set<std::string> sentences;

    for (int i = 1; i <= static_cast<int>(SafetyStage::NotFinite); ++i) {
        const std::string sentence(describe(static_cast<SafetyStage>(i)));
        INFO(i << ": " << sentence);
        REQUIRE_FALSE(sentence.empty());
        CHECK(sentence.back() == '.');
        CHECK(sentences.insert(sentence).second);
    }
    CHECK(describe(SafetyStage::None).empty());
}

TEST_CASE("motors that are warm by their own word rest, and then stay below what they stand",
          "[haptics][safety]") {
    Guard guard;
    (void)guard.tick(2, 100);
    guard.input.reading.trouble = DeviceTrouble::WarmMotors;
    const SafetyResult half = guard.tick(2, 50);
    const SafetyResult gone = guard.tick(2, 51);
    guard.input.reading.trouble = DeviceTrouble::None;
    (void)guard.tick(0, 10);  // quiet cycles
    const SafetyResult back = guard.tick(2, 2200);
    (void)guard.tick(0, 8000);  // 30 s * ln(1 / 0.8) is 6.7 s
    const SafetyResult cooled = guard.tick(2, 1100);

    CHECK(half.stage == SafetyStage::CoolDown);
    CHECK(half.newton.x() == Approx(1).margin(0.05));
    CHECK(gone.newton == zero);
    CHECK(gone.reason == SafetyStage::CoolDown);
    CHECK(back.newton.x() == Approx(guard.settings.thermal_limit_newton));
    CHECK(back.stage == SafetyStage::ThermalLimit);
    CHECK(cooled.newton.x() == Approx(2));
}

TEST_CASE("a device that refuses the force gets none, then quiet cycles and the ramp",
          "[haptics][safety]") {
    Guard guard;
    (void)guard.tick(2, 100);
    guard.input.reading.trouble = DeviceTrouble::ForceRefused;
    const SafetyResult refused = guard.tick(2);
    guard.input.reading.trouble = DeviceTrouble::None;
    const SafetyResult waiting = guard.tick(2, 100);
    (void)guard.tick(0, 10);
    const SafetyResult rising = guard.tick(2, 1000);
    const SafetyResult back = guard.tick(2, 1100);

    CHECK(refused.newton == zero);
    CHECK(refused.stage == SafetyStage::Refused);
    CHECK(waiting.newton == zero);
    CHECK(waiting.reason == SafetyStage::Refused);
    CHECK(rising.newton.x() == Approx(1).margin(0.02));
    CHECK(back.newton.x() == Approx(2));
}

TEST_CASE("a device's limits are taken over, but none above what a scene allows",
          "[haptics][safety]") {
    SafetySettings weak, strong, without_motors;
    DeviceSpec device;

    limit_to(device, without_motors);
    device.peak_force_newton = 1.5;
    device.continuous_force_newton = 0.4;
    limit_to(device, weak);
    device.peak_force_newton = 30;
    limit_to(device, strong);

    CHECK(weak.clamp_newton == 1.5);
    CHECK(weak.thermal_limit_newton == 0.4);
    CHECK(strong.clamp_newton == SafetySettings{}.clamp_newton);
    CHECK(weak.frozen_s == SafetySettings{}.frozen_s);
    CHECK(without_motors.clamp_newton == SafetySettings{}.clamp_newton);
    CHECK(without_motors.frozen_s == std::numeric_limits<double>::infinity());
    CHECK(without_motors.frozen_newton == std::numeric_limits<double>::infinity());
    Guard guard;
    guard.settings = without_motors;
    (void)guard.tick(2.9, 60'000);  // a minute
    CHECK(guard.tick(2.9).newton.x() == Approx(2.9));
}
