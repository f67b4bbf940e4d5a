#include "session/statistics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

using namespace palpa;

namespace {

ServoTick tick_with_force(double force, double distance) {
    ServoTick tick;
    tick.sent_newton.x() = force;
    tick.contact.molecule.place_angstrom.x() = distance;
    return tick;
}

}  // namespace

TEST_CASE("the extremes of a run are kept with their signs", "[session][statistics]") {
    Statistics statistics(1e-3);
    for (const auto& [force, distance] :
         {std::pair{0.2, 5.0}, {-0.9, 3.1}, {2.1, 2.5}, {-0.1, -0.4}, {0.0, -6.0}}) {
        statistics.add(tick_with_force(force, distance));
    }

    const Summary summary = statistics.summary();

    CHECK(summary.largest_attraction_N == 0.9);
    CHECK(summary.largest_repulsion_N == 2.1);
    CHECK(summary.largest_felt_N == 2.1);
    CHECK(summary.closest_angstrom == 0.4);
    CHECK(summary.last_angstrom == -6);
    CHECK(summary.went_through);
    CHECK(summary.ticks == 5);
    CHECK_FALSE(summary.ripple.has_value());
}

TEST_CASE("the way of a handle is counted by strokes, without tremor and clutch",
          "[session][statistics]") {
    Statistics statistics(1e-3);
    ServoTick tick;
    tick.reading.valid = true;
    double x_m = 0;
    const auto move = [&](int ticks, double by_m, bool is_clutched) {
        for (int i = 0; i < ticks; ++i) {
            x_m += by_m;
            // Encoder steps to and fro.
            tick.reading.position_m = {x_m, i % 2 == 0 ? 0.055e-3 : 0, 0};
            tick.clutched = is_clutched;
            statistics.add(tick);
        }
    };
    move(200, 1e-4, false);  // 2 cm
    move(100, -2e-4, true);  // back under the clutch
    move(1000, 0, false);    // a rest is no stroke
    move(100, 1e-4, false);  // 1 cm
    tick.contact.is_still = true;
    move(1, 0.07, false);  // to where another device is, with nothing in hand meanwhile
    tick.contact.is_still = false;
    tick.clipped_m = {0, 3e-3, 4e-3};
    tick.is_at_stop = true;
    move(2, 0, false);
    move(1, 0, true);  // under the clutch a stop does not matter

    const HandTravel travel = statistics.summary().travel;

    CHECK(travel.handle_m == Approx(0.03).margin(1.2e-3));
    CHECK(travel.strokes == 2);
    CHECK(travel.lost_m == Approx(3 * 5e-3));
    CHECK(travel.at_stop_s == Approx(0.002));
}

TEST_CASE("in space a felt force is a norm, which neither attracts nor repels",
          "[session][statistics]") {
    Statistics statistics(1e-3);
    ServoTick tick = tick_with_force(1.2, 3);
    tick.sent_newton = {1.2, -0.5, 0};
    tick.contact.active_freedom = 6;
    statistics.add(tick);

    const Summary summary = statistics.summary();

    CHECK(summary.largest_felt_N == Approx(1.3));
    CHECK_FALSE(summary.is_on_axis);
    CHECK(summary.largest_repulsion_N == 0);
}

TEST_CASE("what was clamped, and what was wrong, is a share of all ticks",
          "[session][statistics]") {
    Statistics statistics(1e-3);
    for (int i = 0; i < 8; ++i) {
        ServoTick tick = tick_with_force(0.1, 3);
        tick.clamped = i < 6;
        if (i == 7) tick.stage = SafetyStage::NotFinite;
        statistics.add(tick);
    }

    CHECK(statistics.summary().clamped_share == 0.75);
    CHECK(statistics.summary().safety_share == 0.125);
    CHECK(statistics.summary().gravest == SafetyStage::NotFinite);
    CHECK(Statistics(1e-3).summary().clamped_share == 0);
}

TEST_CASE("what is taken on the other side was not pushed through", "[session][statistics]") {
    Statistics statistics(1e-3);
    const auto add = [&](double distance, std::uint32_t start, bool is_still) {
        ServoTick tick;
        tick.contact.molecule.place_angstrom.x() = distance;
        tick.contact.grip_number = start;
        tick.contact.is_still = is_still;
        statistics.add(tick);
    };
    add(5, 0, false);
    add(-4, 1, false);
    add(0, 2, true);
    CHECK_FALSE(statistics.summary().went_through);
    CHECK(statistics.summary().closest_angstrom == 4);
    add(-1e-8, 3, false);  // measured from where it was
    add(3, 3, false);
    CHECK_FALSE(statistics.summary().went_through);
    add(-3, 4, false);
    add(1, 4, false);
    CHECK(statistics.summary().went_through);
}

TEST_CASE("in space a molecule is as far as it is, and beyond where it was turned from",
          "[session][statistics]") {
    Statistics statistics(1e-3);
    for (const Vec3& place : {Vec3(3, 4, 0), Vec3(0, 0, -2), Vec3(0, 1, 0)}) {
        ServoTick tick;
        tick.contact.molecule.place_angstrom = place;
        statistics.add(tick);
    }

    CHECK(statistics.summary().closest_angstrom == 1);
    CHECK(statistics.summary().last_angstrom == 1);
    CHECK_FALSE(statistics.summary().went_through);
}

TEST_CASE("step times are told to a percent, whatever their size", "[session][statistics]") {
    const double unit = GENERATE(1e-8, 1e-6, 1e-3, 1.0);
    Statistics statistics(1e-3);
    for (int i = 1; i <= 1000; ++i) statistics.add_step(i * unit, i % 10 != 0);

    const Summary summary = statistics.summary();

    CHECK(summary.step_median_us == Approx(500 * unit * 1e6).epsilon(0.01));
    CHECK(summary.step_p99_us == Approx(990 * unit * 1e6).epsilon(0.01));
    CHECK(summary.steps == 1000);
    CHECK(summary.steps_not_finite == 100);
}

TEST_CASE("without steps there is no step time", "[session][statistics]") {
    StepTimes times;
    CHECK(times.quantile_us(0.5) == 0);
    times.add(2e-3);
    CHECK(times.quantile_us(0.5) == Approx(2000).epsilon(0.01));
    CHECK(times.quantile_us(0.99) == times.quantile_us(0.1));
}

TEST_CASE("ripple is that of the last four seconds", "[session][statistics]") {
    Statistics statistics(1e-3);
    for (int i = 0; i < 5000; ++i) statistics.add(tick_with_force(std::sin(0.05 * i), 3));  // 8 Hz
    const double loud = statistics.summary().ripple.value().rms;
    for (int i = 0; i < 4000; ++i) statistics.add(tick_with_force(0.5, 3));

    CHECK(loud == Approx(std::sqrt(0.5)).epsilon(0.05));
    CHECK(statistics.summary().ripple.value().rms < 1e-12);
}
