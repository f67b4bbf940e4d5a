#include "session/feel.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <optional>
#include <utility>

using namespace palpa;
using Catch::Contains;

namespace {

// A scene of 10 ms on the usual device, without damping of the servo's own: a cap of
// 0.5 0.1/(1.5 1 ms) = 100/3 N/m.
FeelLog log_of(const std::optional<std::array<double, 2>>& range_pN,
               const std::optional<double>& within_pN) {
    SceneDescription scene;
    scene.period_ms = 10;
    scene.coupling.feel_pN = range_pN;
    scene.coupling.feel_within_pN = within_pN;
    ServoSettings servo;
    servo.guarded.emplace();
    servo.guarded->damping_N_s_per_m = 0;
    servo.guarded->force_law = PerceptualForceLaw::for_range(20e-12, 3e-9);
    return {scene, servo};
}

ServoTick tick_of(double felt_N_per_m, double raised) {
    ServoTick tick;
    tick.felt_N_per_m = felt_N_per_m;
    tick.raised = raised;
    return tick;
}

SettleReport step_of(std::size_t active, std::optional<double> audited_pN) {
    SettleReport report;
    report.active = active;
    report.steps = 2;
    report.audited_pN = audited_pN;
    return report;
}

}  // namespace

TEST_CASE("a scene that says nothing of what must be felt is told nothing", "[session][feel]") {
    FeelLog log = log_of({}, {});
    log.add(tick_of(100, 3));

    CHECK_FALSE(log.feel(1e3));
}

TEST_CASE("what was felt of a range, and what was not so exact", "[session][feel]") {
    FeelLog log = log_of(std::array{20.0, 3000.0}, 50.0);
    for (const auto& [felt, raised] : {std::pair{5.0, 1.0}, {30.0, 4.5}, {10.0, 2.0}})
        log.add(tick_of(felt, raised));
    ServoTick warm = tick_of(20, 1);
    warm.stage = SafetyStage::Hot;
    log.add(warm);
    for (int i = 1; i <= 10; ++i) log.add_step(step_of(30 + 2 * i, 10.0 * i));
    log.add_step(step_of(8, {}));

    const std::optional<Feel> feel = log.feel(25e3);
    REQUIRE(feel);
    CHECK(feel->ends_newton[0] == Approx(0.3));
    CHECK(feel->ends_newton[1] == Approx(2.7));
    CHECK(feel->stiffest_share == Approx(0.9));
    CHECK(feel->largest_raise == 4.5);
    CHECK(feel->warm_share == 0.25);
    CHECK(feel->audits == 10);
    CHECK(feel->median_pN == 50);
    CHECK(feel->ninety_pN == 90);
    CHECK(feel->within_share == 0.5);
    CHECK(feel->active == Approx((410.0 + 8) / 11));
    CHECK(feel->steps == 2);
    const Yielding yielding = find_yielding(*feel);
    CHECK_THAT(yielding.tolerance, Contains("within 90 pN, 1.8 times the 50 asked"));
    CHECK_THAT(yielding.period, Contains("2.5 times"));
    CHECK_THAT(yielding.reach, Contains("up to 4.5 times"));
    CHECK_THAT(yielding.motors, Contains("for 25 % of the time"));
    CHECK(yielding.all().size() == 4);
}

TEST_CASE("where nothing moves by itself the servo's guess is what is looked at",
          "[session][feel]") {
    FeelLog log = log_of({}, 50.0);
    for (int i = 1; i <= 300; ++i) {
        ServoTick tick;
        tick.touch.force_newton = Vec3(1e-9, 0, 0);
        log.add(tick);
        TouchModel answer;
        answer.force_newton = Vec3(1e-9, (i % 100 == 0 ? 0.1e-12 : 1e-9) * i, 0);
        log.add_answer(answer);
    }

    const Feel feel = log.feel(0).value_or(Feel{});
    CHECK(feel.audits == 3);
    CHECK(feel.median_pN == Approx(20));
    CHECK(feel.ninety_pN == Approx(30));
    CHECK(feel.within_share == 1);
}

TEST_CASE("what an audit finds stands for the steps before it", "[session][feel]") {
    FeelLog log = log_of({}, 50.0);
    for (int i = 0; i < 80; ++i) log.add_step(step_of(8, {}));
    log.add_step(step_of(8, 60.0));
    for (int i = 0; i < 19; ++i) log.add_step(step_of(8, 1.0));

    const Feel feel = log.feel(0).value_or(Feel{});
    CHECK(feel.audits == 20);
    CHECK(feel.within_share == Approx(0.19));
    CHECK(feel.median_pN == 60);
    CHECK_FALSE(find_yielding(feel).tolerance.empty());
}

TEST_CASE("nothing gives way where everything holds", "[session][feel]") {
    FeelLog log = log_of(std::array{20.0, 3000.0}, 50.0);
    log.add(tick_of(33, 1));
    for (int i = 1; i <= 9; ++i) log.add_step(step_of(8, 50.0));
    log.add_step(step_of(8, 51.0));

    const std::optional<Feel> feel = log.feel(9.9e3);
    REQUIRE(feel);
    CHECK(feel->within_share == 0.9);
    CHECK(find_yielding(*feel).all().empty());
}
