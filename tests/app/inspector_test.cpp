// Tree, inspector, hands and docks of the window, without a window.
#include "app/actions.h"
#include "app/inspected.h"
#include "app/lesson_course.h"
#include "app/notices.h"
#include "tests/support/paths.h"
#include "tests/support/window_screen.h"

#include <catch2/catch.hpp>
#include <string>
#include <variant>
#include <vector>

using namespace palpa;
using test::WindowScreen;

namespace {

// Clicks down the panel at the right until something is sent; returns the edit.
EditDescription click_until_edit(WindowScreen& screen) {
    screen.frames(3);
    screen.session.commands.clear();
    const float x = screen.picture().right + 40;
    for (float y = 90; y < 500 && screen.session.commands.empty(); y += 6) screen.click({x, y});
    REQUIRE_FALSE(screen.session.commands.empty());
    return std::get<EditDescription>(screen.session.commands.back());
}

}  // namespace

TEST_CASE("the inspector removes a spring and a mark, and empties a hand", "[app][panels]") {
    WindowScreen screen;
    const RestraintEdit spring{{"fixed:1", "moved:1"}, {}, 20, 3};
    const PinEdit mark{{"fixed:1 OH2", "moved:1 OH2"}};
    SceneObjects& objects = screen.app.write<NewestFrame>().frame.objects;
    objects.restraints = {spring};
    objects.marks = {{mark, 3.2}};

    inspect(screen.app, InspectedSpring{spring.atoms});
    RestraintEdit removed = spring;
    removed.k_kcal_per_mol_angstrom2 = 0;
    CHECK(click_until_edit(screen).action == EditAction(removed));
    inspect(screen.app, InspectedMark{mark.atoms});
    CHECK(click_until_edit(screen).action == EditAction(mark));
    screen.app.write<NewestFrame>().frame.hands.front().held_address = "moved";
    inspect(screen.app, InspectedHand{0});
    CHECK(click_until_edit(screen).action == EditAction(ReleaseEdit{}));
}

TEST_CASE("the inspector shows the molecule in hand once the other entity is removed",
          "[app][panels]") {
    WindowScreen screen;
    const Inspectable held = InspectedMolecule{"moved"};
    CHECK(find_inspected(screen.app) == held);
    for (const Inspectable& gone :
         {Inspectable(InspectedMolecule{"nobody"}), Inspectable(InspectedHand{3}),
          Inspectable(InspectedSpring{{"a:1"}}), Inspectable(InspectedMark{{"a:1 B"}})}) {
        inspect(screen.app, gone);
        CHECK(find_inspected(screen.app) == held);
        screen.frames(2);
    }
    inspect(screen.app, InspectedMolecule{"fixed"});
    CHECK(find_inspected(screen.app) == Inspectable(InspectedMolecule{"fixed"}));
}

TEST_CASE("panels are as a person left them, and unknown ones are passed over", "[app][panels]") {
    Docks docks = build_docks();
    CHECK(list_docks(docks).empty());
    docks.size[Side::Left] = 240.4F;
    docks.is_folded[Side::Right] = true;
    docks.is_folded[Side::Left] = false;
    docks.is_open["plots"] = true;
    docks.is_open["tree"] = false;
    docks.is_open["lesson"] = false;  // the next scene's is shown
    docks.is_open["search"] = true;   // it is over the picture
    const std::vector<std::string> kept = list_docks(docks);
    CHECK(kept == std::vector<std::string>{"left 240", "left unfolded", "right folded",
                                           "tree closed", "plots open"});

    std::vector<std::string> with_others = kept;
    with_others.insert(with_others.end(), {"", "left", "wings open", "left 1 2"});
    const Docks again = build_docks(with_others);
    CHECK(list_docks(again) == kept);
    CHECK_FALSE(again.is_open.at("search"));
    CHECK(again.is_open.size() == docks.is_open.size());
}

TEST_CASE("the search finds a panel by what it has", "[app][panels]") {
    WindowScreen screen;
    screen.app.write<Docks>().is_open["coupling"] = false;
    open_panel(screen.app, "search");
    screen.frames(3);
    for (const char letter : std::string("gain curves"))
        ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(letter));
    screen.frames(2);
    CHECK(press_in_panels(screen.app, {Key::Enter}));
    screen.frames(3);
    CHECK_FALSE(is_panel_open(screen.app, "search"));
    CHECK(is_panel_open(screen.app, "coupling"));
    CHECK(screen.app.resource<Docks>().front.at(Side::Right) == "coupling");
}

TEST_CASE("a step of a lesson opens the panel that it teaches", "[app][panels]") {
    WindowScreen screen;
    screen.app.write<PictureState>().has_first = true;
    Lesson& lesson = screen.app.write<LessonState>().lesson;
    const auto teaches = [&] {
        return lesson.steps()[lesson.current()].panel == LessonPanel::Coupling;
    };
    while (!teaches()) {
        follow_lesson(screen.app);
        screen.frames(2);
        CHECK(screen.app.resource<Docks>().front.at(Side::Right) == "hand");
        lesson.skip();
    }
    follow_lesson(screen.app);
    screen.frames(2);
    CHECK(screen.app.resource<Docks>().front.at(Side::Right) == "coupling");
}

TEST_CASE("each refusal of an edit gives one message", "[app][panels]") {
    WindowScreen screen;
    const std::vector<std::string>& told = screen.app.resource<Notices>().history;
    screen.readout().problem = "no room";
    screen.readout().refused_edits = 1;
    tell_news(screen.app);
    tell_news(screen.app);
    CHECK(told == std::vector<std::string>{"no room"});
    tell(screen.app, "another");
    screen.readout().refused_edits = 2;
    tell_news(screen.app);
    CHECK(told == std::vector<std::string>{"no room", "another", "no room"});
}

TEST_CASE("settings are those of the hand that the mouse leads", "[app][panels]") {
    const SceneDescription scene = read_scene(test::in_project("scenes/water/two-hands.toml"));
    WindowScreen screen;  // for the overlay library
    test::NotingSession session;
    EmulatedOmni second{EmulatedOmniSettings()};
    World app = build_window_world({nullptr, &session, &screen.options, &scene},
                                   {{&screen.omni, nullptr, 0.1}, {&second, nullptr, 0.1}});
    const auto last = [&] { return std::get<LiveSettings>(session.commands.back()); };
    perform(app, "mode-4");
    CHECK(last().hand == 0);
    perform(app, "other-hand");
    CHECK(app.resource<SettingsState>().now == settings_of(scene, 1));
    perform(app, "mode-5");
    CHECK(last().hand == 1);
    CHECK(last().coupling.mode == CouplingMode::NoForce);
    CHECK(list_hand_settings(app).at(1) == last());
}

TEST_CASE("a hit of the search is clicked while keys of scenes are listed", "[app][panels]") {
    WindowScreen screen;
    open_panel(screen.app, "search", true);
    screen.frames(3);
    for (const char letter : std::string("mode"))
        ImGui::GetIO().AddInputCharacter(static_cast<unsigned>(letter));
    screen.frames(2);
    for (float y = 120; y < 500 && screen.session.commands.empty(); y += 10) {
        if (!is_panel_open(screen.app, "search")) {
            open_panel(screen.app, "search", true);
            screen.frames(3);
        }
        screen.click({640, y});
    }
    CHECK_FALSE(is_panel_open(screen.app, "search"));
}
