#include "session/plan_hand.h"

#include "loading/load.h"
#include "simulation/probe.h"
#include "tests/support/water_run.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace palpa;
using Catch::Matchers::Contains;
using Catch::Matchers::Equals;

namespace {

HandScript plan(const std::vector<std::string>& settings) {
    const SceneDescription scene = test::water_scene(settings);
    return plan_hand(scene, load_world(scene), omni_half_workspace_m.x());
}

}  // namespace

TEST_CASE("an in-out stroke is as long as the gain and the hand's bend ask", "[session][hand]") {
    const HandScript script = plan({"mode=2"});

    REQUIRE(script.path.size() == 5);
    // 7 to 2.473 Å at 0.25e9, and 2.1198 N on 200 N/m.
    const double travel = (7 - 2.473) * 1e-10 * 0.25e9 + 2.1198 / 200;
    CHECK(script.path[0].x_m - script.path[1].x_m == Approx(travel).epsilon(2e-3));
    CHECK(script.path[0].x_m == script.path[3].x_m);
    CHECK(script.path[1].time_s - script.path[0].time_s == Approx(3));
    CHECK(script.path[2].time_s - script.path[1].time_s == Approx(1));
}

TEST_CASE("without friction or delay a slow stroke peaks at the force it was planned for",
          "[session][hand]") {
    const std::string mode = GENERATE("2", "4");
    const double peak_nN = GENERATE(1.0, 3.0);
    const Summary summary =
        test::run_water({"mode=" + mode, "peak_nN=" + std::to_string(peak_nN), "friction_N=0",
                         "encoder_step_mm=0", "stroke_s=6", "seconds=15"});

    const World world = load_world(test::water_scene());
    const double planned = repulsion_distance(world, peak_nN / 0.0694770, 7).value();
    CHECK(summary.closest_angstrom == Approx(planned).margin(0.005));
}

TEST_CASE("a stroke longer than the workspace brings the molecule in by clutching",
          "[session][hand]") {
    const Summary summary = test::run_water(
        {"mode=2", "hand.start_angstrom=14", "stroke_s=10", "seconds=40", "friction_N=0"});

    CHECK(summary.closest_angstrom == Approx(2.473).margin(0.01));
    CHECK(summary.last_angstrom == Approx(14).margin(0.3));
}

TEST_CASE("a path is taken as the scene gives it", "[session][hand]") {
    const HandScript script = plan({"stroke=path", "hand.path=[[0.5, 10.0], [1.5, -20]]"});

    REQUIRE(script.path.size() == 2);
    CHECK(script.path[1].time_s == 1.5);
    CHECK(script.path[1].x_m == Approx(-0.020));
}

TEST_CASE("a force that the molecules never reach is an error at the peak's key",
          "[session][hand]") {
    // At 2.4 Å they repel with more than 3 nN already.
    CHECK_THROWS_WITH(plan({"hand.start_angstrom=2.4", "peak_nN=3"}),
                      Equals("--set peak_nN=3: the repulsion does not reach 3 nN within 2.4 Å; "
                             "expected another hand.peak_nN or hand.start_angstrom"));
}

TEST_CASE("a stroke with a peak is refused where the hand holds a spring", "[session][hand]") {
    SceneDescription scene = test::water_scene({"hand.stroke=in-out"});
    const World world = load_world(scene);
    scene.hands.front().grab.atom = "OH2";

    CHECK_THROWS_WITH(plan_hand(scene, world, omni_half_workspace_m.x()),
                      Contains("--set hand.stroke=in-out: ") && Contains("\"path\" or \"hold\""));
}

TEST_CASE("a fast path beyond the workspace takes the molecule all its way", "[session][hand]") {
    // 0.5 m at 0.25e9 are 20 Å; the handle lags a little behind the hand when the clutch is
    // pressed.
    const Summary summary =
        test::run_water({"mode=2", "stroke=path", "hand.path=[[0.5, 0], [1.5, 500]]", "seconds=12",
                         "friction_N=0"});

    CHECK(summary.last_angstrom == Approx(27).margin(0.1));
}

TEST_CASE("a stroke that no hand could follow is an error at its key", "[session][hand]") {
    CHECK_THROWS_WITH(plan({"stroke=path", "hand.path=[[0, 0], [0.1, 500]]"}),
                      Contains("--set hand.path") && Contains("9.38 m/s"));
    CHECK_THROWS_WITH(plan({"stroke_s=0.02"}), Contains("--set stroke_s=0.02"));
}

TEST_CASE("a hand that leads brings the water where its path says, whatever the gain",
          "[session][hand]") {
    const std::string mode = GENERATE("4", "guarded");
    const SceneDescription scene =
        test::water_scene({"mode=" + mode, "hand.stroke=lead", "hand.start_angstrom=7",
                           "hand.path=[[0.5, 0], [6, -4], [6.5, -4], [12, 1]]", "run.seconds=30"});
    World world = load_world(scene);
    const double begin = grabbed_distance(world);
    EmulatedOmni device(test::build_played_omni(scene, world));
    const Summary summary = run_headless(scene, world, device, {}, nullptr, {});

    CHECK(summary.closest_angstrom == Approx(begin - 4).margin(0.1));
    CHECK(summary.last_angstrom == Approx(begin + 1).margin(0.05));
}
