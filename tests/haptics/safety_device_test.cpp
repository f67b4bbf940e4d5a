// The safety chain on the emulated device, with faults.
#include "haptics/safety.h"

#include "devices/emulated_omni.h"
#include "devices/faulty_device.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <vector>

using namespace palpa;
using Fault = DeviceFault;

namespace {

const Vec3 no_force = Vec3::Zero();

// A hand that follows its path into a wall of 200 N/m at x = 0, on a device with faults.
struct WallRun {
    struct Row {
        double now_s = 0;
        SafetyResult result;
    };

    std::vector<FaultPeriod> faults;
    int ending_tick = std::numeric_limits<int>::max();
    int simulation_dies_tick = std::numeric_limits<int>::max();

    std::vector<Row> run(int ticks) const {
        EmulatedOmniSettings device;
        device.hand = hand_model(HandGrip::Medium);
        device.script.path = {{0, 0}, {0.4, 0.02}};
        EmulatedOmni omni(device);
        FaultyDevice faulty(omni, faults);
        const SafetySettings settings;
        SafetyState state;
        Vec3 last = no_force, model = no_force;
        double model_s = 0;
        std::vector<Row> rows;
        for (int i = 0; i < ticks; ++i) {
            SafetyInput input;
            input.now_s = faulty.now_s();
            input.reading = faulty.read();
            input.velocity_m_per_s = (input.reading.position_m - last) / servo_tick_s;
            if (!input.velocity_m_per_s.allFinite() || !input.reading.valid) {
                input.velocity_m_per_s = no_force;
            }
            last = input.reading.position_m;
            if (i < simulation_dies_tick) {
                const double x = input.reading.position_m.x();
                model = Vec3(x > 0 ? -200 * x : 0, 0, 0);
                model_s = input.now_s;
            }
            input.wanted_newton = model;
            input.model_age_s = input.now_s - model_s;
            input.period_s = 0.014;
            input.is_ending = i >= ending_tick;
            const SafetyResult result = guard_force(settings, state, input);
            rows.push_back({input.now_s, result});
            faulty.write(result.newton);
        }
        return rows;
    }
};

// The last tick with a force.
int last_force(const std::vector<WallRun::Row>& rows) {
    int last = -1;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i].result.newton != no_force) last = static_cast<int>(i);
    }
    return last;
}

}  // namespace

TEST_CASE("no hand on the emulated device that holds still is taken for a frozen reading",
          "[haptics][safety][coupling]") {
    const HandGrip grip = GENERATE(HandGrip::None, HandGrip::Light, HandGrip::Slack,
                                   HandGrip::Medium, HandGrip::Firm, HandGrip::FirmGrip);
    const double place_m = GENERATE(0.0, 0.079);  // in the middle, at the stop
    const unsigned seed = GENERATE(1U, 2U);
    EmulatedOmniSettings device;
    device.hand = hand_model(grip);
    device.script.path = {{0, place_m}};
    EmulatedOmni omni(device);
    SafetySettings settings;
    settings.thermal_limit_newton = 3;  // or the force would soon stay below the threshold
    settings.farthest_jump_m = 0.1;     // a handle that nobody holds is thrown about
    SafetyState state;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> component(-3, 3);
    std::uniform_int_distribution<int> ticks(5, 400);
    const bool is_along_x = seed == 2;
    const int half_ms = GENERATE(0, 12, 25, 40);  // of a force that alternates; 0: at random
    Vec3 wanted = no_force;
    int next = 0;
    bool tripped = false;
    double largest = 0;

    for (int i = 0; i < (half_ms > 0 ? 6'000 : 60'000); ++i) {
        if (i == next) {
            wanted = Vec3(component(random), component(random), component(random));
            if (is_along_x) wanted = Vec3(wanted.x(), 0, 0);
            next += ticks(random);
        }
        if (half_ms > 0) wanted = Vec3(i / half_ms % 2 == 0 ? 2.95 : -2.95, 0, 0);
        SafetyInput input;
        input.wanted_newton = wanted;
        input.now_s = i * servo_tick_s;
        input.reading = omni.read();
        const SafetyResult result = guard_force(settings, state, input);
        tripped = tripped || result.stage > SafetyStage::ThermalLimit;
        largest = std::max(largest, result.newton.norm());
        omni.write(result.newton);
    }

    INFO("grip " << grip_names[static_cast<std::size_t>(grip)] << " at " << place_m << " m");
    CHECK_FALSE(tripped);
    CHECK(largest > 2.9);
}

TEST_CASE("faults of a device in contact take the force away in their time", "[haptics][safety]") {
    WallRun wall;
    const int begin = 1000;
    SECTION("nothing wrong: the wall is felt") {
        const auto rows = wall.run(3000);
        // Hand and wall have 200 N/m each: 20 mm are shared, 2 N, but for friction.
        CHECK(rows.back().result.newton.x() == Approx(-2).margin(0.3));
        for (const WallRun::Row& row : rows) REQUIRE(row.result.stage == SafetyStage::None);
    }
    SECTION("a position that is no number, unplugged: 10 ms") {
        wall.faults = {{GENERATE(Fault::NotANumber, Fault::Invalid), begin, 1500}};
        const auto rows = wall.run(3000);
        // The last good reading is that of tick 999.
        CHECK(rows[begin + 8].result.newton.x() < -1);
        CHECK(rows[begin + 9].result.newton == no_force);
        CHECK(rows[begin + 9].result.stage == SafetyStage::Unplugged);
        // Still in contact when it is back: the force waits.
        CHECK(last_force(rows) == begin + 8);
        CHECK(rows.back().result.reason == SafetyStage::Unplugged);
    }
    SECTION("a jump by 0.3 m: at once") {
        wall.faults = {{Fault::Jump, begin, begin + 1}};
        const auto rows = wall.run(2000);
        CHECK(last_force(rows) == begin - 1);
        CHECK(rows[begin].result.stage == SafetyStage::Jump);
    }
    SECTION("late by 25 ms: in that tick") {
        wall.faults = {{Fault::Late, begin, begin + 1}};
        const auto rows = wall.run(2000);
        CHECK(rows[begin + 1].now_s - rows[begin].now_s == Approx(0.026));
        CHECK(last_force(rows) == begin);
        CHECK(rows[begin + 1].result.stage == SafetyStage::Late);
    }
    SECTION("frozen for long, until the fading of a dead model changes the force") {
        const int early = 300;
        wall.faults = {{Fault::Frozen, early}};
        wall.simulation_dies_tick = early + 1;
        const auto rows = wall.run(2000);
        // The reading, and so the force, stand still for far more than 50 ms before.
        CHECK(rows[early + 99].result.stage == SafetyStage::None);
        CHECK(rows[early + 110].result.newton == no_force);
        CHECK(rows[early + 110].result.stage == SafetyStage::Frozen);
    }
    SECTION("a dead simulation: fades from 100 ms to 200 ms of its last model") {
        wall.simulation_dies_tick = begin;
        const auto rows = wall.run(2000);
        const double before = rows[begin + 98].result.newton.x();
        CHECK(before < -1);
        CHECK(rows[begin + 149].result.newton.x() == Approx(before / 2).epsilon(0.03));
        CHECK(last_force(rows) <= begin + 200);
        CHECK(last_force(rows) >= begin + 195);
        CHECK(rows[begin + 300].result.stage == SafetyStage::Stale);
    }
    SECTION("exit: 10 ms") {
        wall.ending_tick = begin;
        const auto rows = wall.run(2000);
        CHECK(rows[begin].result.newton.x() < -1);
        CHECK(last_force(rows) == begin + 8);
    }
}

TEST_CASE("a device that turns silent and comes back far away is no jump", "[haptics][safety]") {
    WallRun wall;
    wall.faults = {{Fault::Invalid, 100, 200}, {Fault::Jump, 150}};

    for (const WallRun::Row& row : wall.run(1000)) {
        REQUIRE(row.result.stage != SafetyStage::Jump);
    }
}
