// Guarded coupling where all joints follow: calm and passive for slack to firm hands at every
// period, and how far a handle goes for what it does there.
#include "scene/read_scene.h"
#include "tests/support/paths.h"
#include "tests/support/water_run.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;

namespace {

SceneDescription scene_of(const std::string& file, const std::vector<std::string>& settings) {
    return read_scene(test::in_project("scenes/" + file), settings);
}

// Out and back on a device without friction. A slack hand needs a minute at 83 ms.
void check_calm_and_passive(const std::string& file, int period_ms, const std::string& grip,
                            int delay_ticks) {
    CAPTURE(file, period_ms, grip, delay_ticks);
    const Summary summary = test::run_scene(
        scene_of(file, {"period_ms=" + std::to_string(period_ms), "grip=" + grip, "friction_N=0",
                        "servo_delay_ticks=" + std::to_string(delay_ticks), "run.seconds=60"}));
    CHECK(summary.net_work_J < 0);
    CHECK(summary.ripple.value().rms < 0.02);
    CHECK(summary.largest_felt_N < 3);
    CHECK(summary.steps_not_finite == 0);
}

}  // namespace

TEST_CASE("a hairpin that is opened is calm and gives a hand nothing", "[session][coupling]") {
    const auto [period_ms, grip, delay] = GENERATE(table<int, std::string, int>(
        {{14, "slack", 0}, {14, "firm", 3}, {83, "slack", 3}, {83, "firm", 0}}));
    check_calm_and_passive("hairpin/scene.toml", period_ms, grip, delay);
}

TEST_CASE("the same at every period, for every hand and delay", "[session][coupling][long]") {
    const int period_ms = GENERATE(1, 14, 83), delay = GENERATE(0, 3);
    const std::string grip = GENERATE("slack", "medium", "firm");
    check_calm_and_passive("hairpin/scene.toml", period_ms, grip, delay);
}

TEST_CASE("TL-3 comes out and goes back with 0.5 m of a handle", "[session][coupling][long]") {
    const Summary summary = test::run_scene(scene_of("hiv/flexible.toml", {}));
    REQUIRE(summary.unbinding.has_value());
    CHECK(summary.unbinding->free_s.has_value());
    CHECK(summary.travel.handle_m < 0.5);
    CHECK(summary.travel.strokes <= 4);
    CHECK(summary.travel.lost_m < 0.05 * summary.travel.handle_m);
    CHECK(summary.net_work_J < 0);
    CHECK(summary.ripple.value().rms < 0.02);
}
