// Period and gains that the window measures.
#include "app/measure_scene.h"

#include "app/saving.h"
#include "core/machine.h"
#include "tests/support/window_screen.h"

#include <catch2/catch.hpp>
#include <variant>

using namespace palpa;
using test::WindowScreen;

namespace {

SceneDescription scene_measured_on(std::string machine) {
    SceneDescription scene = test::water_scene();
    scene.measured_on = std::move(machine);
    return scene;
}

// A step that took so long, under a force.
void add_step(WindowScreen& screen, double ms, double pN) {
    Readout& readout = screen.readout();
    ++readout.steps;
    readout.step_ms = ms;
    readout.holds_something = true;
    LiveHand& hand = screen.app.write<NewestFrame>().frame.hands.front();
    hand.contact.force_newton = Vec3(1e-12 * pN, 0, 0);
    measure_scene(screen.app);
}

const LiveSettings& settings_of(const WindowScreen& screen) {
    return screen.app.resource<SettingsState>().now;
}

}  // namespace

TEST_CASE("a scene from another machine gets its period from steps here", "[app][measure]") {
    WindowScreen screen(scene_measured_on("another machine"));
    const LiveSettings before = settings_of(screen);
    for (int i = 0; i < 199; ++i) add_step(screen, i % 40 == 0 ? 500 : 8, 100);  // renewals
    CHECK(settings_of(screen) == before);
    measure_scene(screen.app);  // the same step once more
    CHECK(settings_of(screen) == before);
    add_step(screen, 8, 100);
    // Ten medians at most, and half as much again.
    CHECK(settings_of(screen).period_ms == 120);
    CHECK(settings_of(screen).coupling == before.coupling);
    CHECK(screen.session.commands.size() == 1);
    CHECK(is_saved(screen.app));
}

TEST_CASE("a scene that was measured nowhere gets its gains from forces", "[app][measure]") {
    WindowScreen screen(scene_measured_on("nowhere"));
    for (int i = 0; i < 300; ++i) add_step(screen, 1, 0.1);  // no force worth the name
    CHECK(settings_of(screen).period_ms == 5);               // the shortest
    for (int i = 0; i < 600; ++i) add_step(screen, 1, 6 + i);
    REQUIRE(settings_of(screen).coupling.feel_pN);
    // 95 % are up to 575 pN: a tenth, and three times that, in two digits.
    CHECK((*settings_of(screen).coupling.feel_pN)[0] == Approx(58));
    CHECK((*settings_of(screen).coupling.feel_pN)[1] == Approx(1700));
    CHECK(screen.session.commands.size() == 2);
}

TEST_CASE("gains that the person chose stay, and nothing changes behind a question",
          "[app][measure]") {
    WindowScreen screen(scene_measured_on("nowhere"));
    screen.app.write<Dialogs>().question.emplace();
    for (int i = 0; i < 300; ++i) add_step(screen, 1, 100);
    CHECK(screen.session.commands.empty());
    screen.app.write<Dialogs>().question.reset();
    LiveSettings chosen = settings_of(screen);
    chosen.coupling.feel_pN = {20, 600};
    chosen.period_ms = 40;
    change_settings(screen.app, chosen);
    for (int i = 0; i < 700; ++i) add_step(screen, 1, 100);
    CHECK((*settings_of(screen).coupling.feel_pN)[0] == 20);
    CHECK(settings_of(screen).period_ms == 40);
}

TEST_CASE("what is measured here, or wanted as it is, stays", "[app][measure]") {
    WindowScreen screen(scene_measured_on(GENERATE(std::string(), machine_name())));
    for (int i = 0; i < 1000; ++i) add_step(screen, 50, 100);
    CHECK(screen.session.commands.empty());
}
