// What the program says about settings that make trouble, against what then happens.
#include "core/load_error.h"
#include "core/units.h"
#include "haptics/gains.h"
#include "loading/load.h"
#include "simulation/probe.h"
#include "simulation/resources.h"
#include "tests/support/water_run.h"

#include <catch2/catch.hpp>
#include <string>
#include <tuple>
#include <vector>

using namespace palpa;
using Catch::Matchers::Contains;
using Catch::Matchers::WithinRel;

TEST_CASE("a setting is called shaking where it shakes, and only there", "[session][coupling]") {
    const auto [hand, period_ms, delay_ticks] = GENERATE(table<std::string, int, int>({
        {"light", 1, 1},
        {"slack", 1, 1},
        {"light", 1, 0},
        {"medium", 1, 1},
        {"medium", 5, 1},
        {"firm", 1, 1},
        {"firm", 5, 1},
        {"firm", 14, 1},
        {"firm-grip", 14, 1},
    }));
    INFO(hand << ", " << period_ms << " ms, " << delay_ticks);
    const Summary summary =
        test::run_water({"mode=2", "grip=" + hand, "run.period_ms=" + std::to_string(period_ms),
                         "servo_delay_ticks=" + std::to_string(delay_ticks), "friction_N=0",
                         "encoder_step_mm=0", "stroke=hold", "kick_N_s=0.005", "seconds=20"});

    const bool shakes = summary.ripple.value().rms > 0.02;
    CHECK(summary.warnings.empty() == !shakes);
}

TEST_CASE("the stiffness felt is the paper's", "[session][coupling]") {
    const SceneDescription scene = test::water_scene({"mode=2"});
    const World world = load_world(scene);
    const auto felt_at = [&](double distance) {
        const LineForce line = force_along_line_at(world, distance);
        return hand_force_slope(coupling_of(world, hand_at(world, 0)).laws.force,
                                line.force * units::newton_per_kcal_per_mol_angstrom) *
               line.stiffness * units::newton_per_metre_per_kcal_per_mol_angstrom2 / 0.25e9;
    };

    CHECK_THAT(felt_at(equilibrium_distance(world).value()), WithinRel(646, 1e-3));
    CHECK_THAT(stiffest_place(scene, world).newton_per_metre, WithinRel(663, 1e-3));
    CHECK_THAT(stiffest_place(scene, world).angstrom, WithinRel(2.760, 1e-3));
    const double wall =
        repulsion_distance(world, 3e-9 / units::newton_per_kcal_per_mol_angstrom, 7).value();
    CHECK_THAT(felt_at(wall), WithinRel(264, 2e-3));
    // Eq. 3 falls to A_dmin where nothing pulls: fifty times stiffer.
    const SceneDescription notched = test::water_scene({"mode=1"});
    CHECK_THAT(stiffest_place(notched, load_world(notched)).newton_per_metre,
               WithinRel(32'300, 2e-3));
}

TEST_CASE("a run that is too short for its stroke, or goes through, says so",
          "[session][coupling]") {
    const auto warnings = [](const std::vector<std::string>& settings) {
        std::string all;
        for (const std::string& warning : test::run_water(settings).warnings) all += warning + "; ";
        return all;
    };

    CHECK_THAT(warnings({"stroke_s=20"}),
               Contains("the stroke takes 41.6 s, but the run only 10 s"));
    CHECK_THAT(
        warnings({"mode=2", "grip=firm", "stroke=path", "hand.path=[[0, 60], [3, -70], [4, -70]]",
                  "hand.start_angstrom=4", "clamp_N=1"}),
        Contains("through the other one"));
    CHECK(warnings({}).empty());
}

namespace {

// What somebody warned of in a run that does not go well: a handle that nobody holds, knocked.
struct Knocked {
    explicit Knocked(std::vector<std::string> settings) {
        const std::vector<std::string> all{"stroke=hold", "grip=none", "friction_N=0",
                                           "kick_N_s=0.005", "seconds=10"};
        settings.insert(settings.end(), all.begin(), all.end());
        const Summary summary = test::run_water(settings);
        is_bad = summary.ripple.value().rms > 0.02 || summary.net_work_J > 1e-3;
        for (const std::string& warning : summary.warnings) words += warning + "; ";
    }

    bool is_bad = false;
    std::string words;
};

}  // namespace

TEST_CASE("settings that vibrate or gain energy by themselves are warned of",
          "[session][coupling]") {
    SECTION("coarse position sensors") {
        const std::string step = GENERATE("0.5", "1");
        const std::string workspace = GENERATE("clutch", "bubble");
        const Knocked knocked({"encoder_step_mm=" + step, "workspace=" + workspace});
        CHECK(knocked.is_bad);
        CHECK_THAT(knocked.words, Contains("one step of its position sensor (" + step + " mm"));
    }
    SECTION("strong damping of a handle that is read in steps") {
        const Knocked knocked({"damping_N_s_per_m=" + std::string(GENERATE("2", "5"))});
        CHECK(knocked.is_bad);
        CHECK_THAT(knocked.words, Contains("less damping"));
    }
    SECTION("a law as steep as rounding errors are small") {
        const Knocked knocked({"force_law=perceptual", "F_lo_pN=0.001",
                               "F_hi_nN=" + std::string(GENERATE("3", "1"))});
        CHECK_THAT(knocked.words, Contains("this force law makes rounding errors felt"));
    }
}

TEST_CASE("settings that are calm are not warned of", "[session][coupling]") {
    const auto [step, damping, delay, inertia] =
        GENERATE(table<std::string, std::string, std::string, std::string>({
            {"0.055", "0.5", "1", "0.045"},
            {"0.1", "0.5", "1", "0.045"},
            {"0.055", "1", "0", "0.1"},
            {"0.055", "5", "7", "0.045"},
            {"0.12", "0.5", "3", "0.1"},
            {"0", "5", "1", "0.045"},
        }));
    INFO(step << " mm, " << damping << " N s/m, " << delay << " ticks, " << inertia << " kg");
    const Knocked knocked({"encoder_step_mm=" + step, "damping_N_s_per_m=" + damping,
                           "servo_delay_ticks=" + delay, "inertia_kg=" + inertia});

    CHECK_FALSE(knocked.is_bad);
    CHECK_THAT(knocked.words, !Contains("position sensor") && !Contains("rounding"));
}

TEST_CASE("gains and steps beyond what any device can use are refused", "[session]") {
    for (const std::string setting :
         {"encoder_step_mm=4", "A_f_max=1e15", "A_f_min=1e15", "coupling.A_f=1e15"}) {
        INFO(setting);
        CHECK_THROWS_AS(test::water_scene({setting}), LoadError);
    }
}
