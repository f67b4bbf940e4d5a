#include "session/accuracy_report.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

using namespace palpa;
using Catch::Contains;

namespace {

// A scene of 10 ms on the usual device, without damping of the servo's own: a cap of
// 0.5 0.1/(1.5 1 ms) = 100/3 N/m.
AccuracyLog log_of(const std::optional<std::array<double, 2>>& range_pN,
                   const std::optional<double>& within_pN) {
    SceneDescription scene;
    scene.period_ms = 10;
    scene.coupling.feel_pN = range_pN;
    scene.coupling.feel_within_pN = within_pN;
    ServoSettings servo;
    servo.guarded.emplace();
    servo.guarded->damping_N_s_per_m = 0;
    servo.guarded->device_cap_N_per_m = 100.0 / 3;
    servo.guarded->force_law = PerceptualForceLaw::for_range(20e-12, 3e-9);
    return {scene, 0, servo};
}

ServoTick tick_that_felt(double felt_N_per_m, double cap_ratio) {
    ServoTick tick;
    tick.felt_N_per_m = felt_N_per_m;
    tick.cap_ratio = cap_ratio;
    return tick;
}

void add_step(AccuracyLog& log, std::size_t active, std::optional<double> error_pN) {
    RelaxStepReport report;
    report.active = active;
    report.steps = 2;
    report.estimated_error_pN = error_pN;
    log.add_step(report, error_pN);
}

}  // namespace

TEST_CASE("a scene without a range or tolerance has no accuracy report", "[session][accuracy]") {
    AccuracyLog log = log_of({}, {});
    log.add(tick_that_felt(100, 3));

    CHECK_FALSE(log.report(1e3));
}

TEST_CASE("what was felt of a range, and what was not so exact", "[session][accuracy]") {
    AccuracyLog log = log_of(std::array{20.0, 3000.0}, 50.0);
    for (const auto& [felt, cap_ratio] : {std::pair{5.0, 1.0}, {30.0, 4.5}, {10.0, 2.0}})
        log.add(tick_that_felt(felt, cap_ratio));
    ServoTick warm = tick_that_felt(20, 1);
    warm.stage = SafetyStage::ThermalLimit;
    log.add(warm);
    for (int i = 1; i <= 10; ++i) add_step(log, 30 + 2 * i, 10.0 * i);
    add_step(log, 8, {});

    const std::optional<AccuracyReport> report = log.report(25e3);
    REQUIRE(report);
    CHECK(report->ends_newton[0] == Approx(0.3));
    CHECK(report->ends_newton[1] == Approx(2.7));
    CHECK(report->stiffest_share == Approx(0.9));
    CHECK(report->largest_cap_ratio == 4.5);
    CHECK(report->thermal_share == 0.25);
    CHECK(report->estimates == 10);
    CHECK(report->median_pN == 50);
    CHECK(report->ninety_pN == 90);
    CHECK(report->within_share == 0.5);
    CHECK(report->active == Approx((410.0 + 8) / 11));
    CHECK(report->steps == 2);
    const UnmetRequirements unmet = find_unmet(*report);
    CHECK_THAT(unmet.tolerance, Contains("below 90 pN, 1.8 times the limit of 50 pN"));
    CHECK_THAT(unmet.period, Contains("2.5 times"));
    CHECK_THAT(unmet.reach, Contains("up to 4.5 times"));
    CHECK_THAT(unmet.motors, Contains("for 25 % of the time"));
    CHECK(unmet.all().size() == 4);
}

TEST_CASE("where nothing moves by itself the servo's guess is what is looked at",
          "[session][accuracy]") {
    AccuracyLog log = log_of({}, 50.0);
    for (int i = 1; i <= 300; ++i) {
        ServoTick tick;
        tick.contact.force_newton = Vec3(1e-9, 0, 0);
        log.add(tick);
        ContactModel answer;
        answer.force_newton = Vec3(1e-9, (i % 100 == 0 ? 0.1e-12 : 1e-9) * i, 0);
        log.add_model(answer);
    }

    const AccuracyReport report = log.report(0).value_or(AccuracyReport{});
    CHECK(report.estimates == 3);
    CHECK(report.median_pN == Approx(20));
    CHECK(report.ninety_pN == Approx(30));
    CHECK(report.within_share == 1);
}

TEST_CASE("what an error estimate finds stands for the steps before it", "[session][accuracy]") {
    AccuracyLog log = log_of({}, 50.0);
    for (int i = 0; i < 80; ++i) add_step(log, 8, {});
    add_step(log, 8, 60.0);
    for (int i = 0; i < 19; ++i) add_step(log, 8, 1.0);

    const AccuracyReport report = log.report(0).value_or(AccuracyReport{});
    CHECK(report.estimates == 20);
    CHECK(report.within_share == Approx(0.19));
    CHECK(report.median_pN == 60);
    CHECK_FALSE(find_unmet(report).tolerance.empty());
}

TEST_CASE("a tolerance of which no error was estimated does not count as met",
          "[session][accuracy]") {
    AccuracyLog log = log_of({}, 50.0);
    for (int i = 0; i < 20; ++i) add_step(log, 8, {});

    const AccuracyReport report = log.report(0).value_or(AccuracyReport{});
    CHECK(report.estimates == 0);
    CHECK_THAT(find_unmet(report).tolerance, Contains("no error was estimated"));
}

TEST_CASE("no requirement is unmet where everything holds", "[session][accuracy]") {
    AccuracyLog log = log_of(std::array{20.0, 3000.0}, 50.0);
    log.add(tick_that_felt(33, 1));
    for (int i = 1; i <= 9; ++i) add_step(log, 8, 50.0);
    add_step(log, 8, 51.0);

    const std::optional<AccuracyReport> report = log.report(9.9e3);
    REQUIRE(report);
    CHECK(report->within_share == 0.9);
    CHECK(find_unmet(*report).all().empty());
}

TEST_CASE("however many error estimates there are, their shares hold to one in ten thousand",
          "[session][accuracy]") {
    constexpr int estimates = 300'000, stride = 7919;  // prime, so that each comes once
    AccuracyLog log = log_of({}, 0.25 * estimates);
    for (int i = 0; i < estimates; ++i) {
        const auto error = static_cast<double>(std::int64_t{i} * stride % estimates);
        add_step(log, 8, error);
    }

    const AccuracyReport report = log.report(0).value_or(AccuracyReport{});
    CHECK(report.estimates == estimates);
    CHECK(report.median_pN == Approx(0.5 * estimates).margin(1e-4 * estimates));
    CHECK(report.ninety_pN == Approx(0.9 * estimates).margin(1e-4 * estimates));
    CHECK(report.within_share == Approx(0.25).margin(1e-4));
}
