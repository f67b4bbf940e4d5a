// Panels, menus and toolbar without a window.
#include "app/actions.h"
#include "app/inspected.h"
#include "app/lesson_course.h"
#include "app/marks.h"
#include "app/recorder.h"
#include "app/selecting.h"
#include "tests/support/in_language.h"
#include "tests/support/skip.h"
#include "tests/support/window_screen.h"

#include <imgui_internal.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

using namespace palpa;
using test::WindowScreen;

namespace {

// Names a font file as the environment does; empty: the usual ones.
void name_font(const char* file) {
#ifdef _WIN32
    _putenv_s("PALPA_FONT", file);
#else
    setenv("PALPA_FONT", file, 1);
#endif
}

bool is_in_screen(const ImRect& area, ImVec2 size) {
    return area.Min.x >= 0 && area.Min.y >= 0 && area.Max.x <= size.x && area.Max.y <= size.y;
}

// The windows that are drawn, without the library's own.
std::vector<const ImGuiWindow*> list_windows() {
    std::vector<const ImGuiWindow*> windows;
    for (const ImGuiWindow* const window : ImGui::GetCurrentContext()->Windows)
        if (window->WasActive && !window->IsFallbackWindow && !window->Hidden)
            windows.push_back(window);
    return windows;
}

}  // namespace

TEST_CASE("every action has a name, a text, and keys of its own", "[app][panels]") {
    std::set<std::string_view> ids;
    std::set<std::tuple<Key, bool, bool>> chords;
    for (const Action& action : list_actions()) {
        INFO(action.id);
        CHECK(ids.insert(action.id).second);
        CHECK(std::string(action.text).size() > 2);
        CHECK(std::string(action.explains).ends_with('.'));
        CHECK(&action_called(action.id) == &action);
        for (const KeyChord& chord : action.keys) {
            if (!chord) continue;
            CHECK(chords.emplace(chord.key, chord.control, chord.shift).second);
            CHECK(find_action({chord.key, chord.control, chord.shift}) == &action);
            CHECK_FALSE(name_of(chord).empty());
        }
    }
    // The hand's own keys start nothing else.
    for (const Key key :
         {Key::Space, Key::Left, Key::Right, Key::Up, Key::Down, Key::PageUp, Key::PageDown})
        CHECK_FALSE(find_action({key}));
    CHECK_FALSE(find_action({Key::P, true}));
    // Shift matters only for a key that says so: a plus needs it on many keyboards.
    CHECK(find_action({Key::Plus, true, true})->id == "larger-text");
    CHECK(find_action({Key::Z, true, true})->id == "redo");
    CHECK(find_action({Key::Z, true, false})->id == "undo");
    CHECK(find_action({Key::F, false, true})->id == "centre");
    CHECK(find_action({Key::F, true})->id == "select");
    CHECK(keys_of(action_called("redo")) == "Ctrl+Shift+Z, Ctrl+Y");
}

TEST_CASE("every panel has a name, a title and an icon", "[app][panels]") {
    std::set<std::string_view> ids;
    for (const Panel* const panel : list_panels()) {
        INFO(panel->id);
        CHECK(ids.insert(panel->id).second);
        CHECK_FALSE(std::string(panel->title).empty());
        CHECK_FALSE(std::string(panel->icon).empty());
    }
}

TEST_CASE("settings and additions are those that undo has restored", "[app][panels]") {
    WindowScreen screen;
    const LiveSettings first = screen.app.resource<SettingsState>().now;
    const ViewAdditions one{{}, {"resid 1"}, {}};
    set_additions(screen.app, one);
    set_additions(screen.app, one);
    perform(screen.app, "mode-2");
    CHECK(screen.session.commands.size() == 2);

    screen.frame();  // the session has not heard of them yet
    CHECK(screen.app.resource<ViewAdditions>() == one);
    CHECK_FALSE(screen.app.resource<SettingsState>().now == first);
    ++screen.readout().undo.restored;
    screen.session.commands.clear();
    screen.frame();
    CHECK(screen.app.resource<ViewAdditions>() == ViewAdditions());
    CHECK(screen.app.resource<SettingsState>().now == first);
    CHECK(screen.session.commands.empty());

    // Devices hear of another period.
    screen.app.write<NewestFrame>().frame.hands.front().settings.period_ms = 20;
    ++screen.readout().undo.restored;
    screen.frame();
    CHECK(screen.session.commands.size() == 1);
    CHECK(screen.app.resource<SettingsState>().now.period_ms == 20);
}

TEST_CASE("at least 60 % of the width is picture, with text up to half as large again",
          "[app][panels]") {
    const auto size = GENERATE(ImVec2(1280, 800), ImVec2(1366, 768), ImVec2(1920, 1080));
    const float text_scale = GENERATE(1.0F, 1.5F);
    INFO(size.x << " x " << size.y << ", text " << text_scale);
    WindowScreen screen(test::water_scene(), text_scale);
    ImGui::GetIO().DisplaySize = size;
    screen.frames(4);
    CHECK(screen.picture().width() >= 0.6F * size.x);
    CHECK(screen.picture().height() >= 0.5F * size.y);
    for (const ImGuiWindow* const window : list_windows()) {
        INFO(window->Name);
        CHECK(is_in_screen(window->Rect(), size));
        if ((window->Flags & ImGuiWindowFlags_ChildWindow) != 0) continue;
        // No dock or bar covers the picture.
        const ScreenArea picture = screen.picture();
        const ImRect middle(picture.left + 1, picture.top + 0.3F * picture.height(),
                            picture.right - 1, picture.bottom - 1);
        CHECK_FALSE(window->Rect().Overlaps(middle));
    }
}

TEST_CASE("panels stay in the window with text twice as large, and without a font file",
          "[app][panels]") {
    struct Row {
        ImVec2 size;
        float text_scale;
        const char* font;  // null: the usual one
    };
    const auto row = GENERATE(values<Row>({{{1280, 720}, 2, nullptr},
                                           {{2560, 1440}, 2, nullptr},
                                           {{1280, 720}, 1, "/nowhere/font.ttf"},
                                           {{1280, 720}, 2, __FILE__}}));
    INFO(row.size.x << " x " << row.size.y << ", text " << row.text_scale);
    if (row.font) name_font(row.font);  // not there; or no font
    WindowScreen screen(test::water_scene(), row.text_scale);
    name_font("");
    ImGui::GetIO().DisplaySize = row.size;
    screen.frames(4);
    CHECK(screen.vertices() > 1000);                                   // words are there
    if (row.font) CHECK(ImGui::GetFont()->FindGlyphNoFallback(0xC5));  // Å
    for (const ImGuiWindow* const window : list_windows()) {
        INFO(window->Name);
        CHECK(is_in_screen(window->Rect(), row.size));
    }
}

TEST_CASE("docks fold to icons in a small window, and unfold by one", "[app][panels]") {
    WindowScreen screen;
    ImGui::GetIO().DisplaySize = {640, 480};
    screen.frames(3);
    CHECK(screen.picture().width() > 0.85F * 640);
    open_panel(screen.app, "inspector");
    screen.frames(3);
    CHECK(screen.picture().width() < 0.8F * 640);
}

TEST_CASE("nothing is cut off, in English and in German", "[app][panels][translate]") {
    const bool is_german = GENERATE(false, true);
    const test::InLanguage language(is_german ? "de" : "");
    if (is_german && !language.is_there()) return test::skip("no German catalogue");
    const auto size =
        GENERATE(ImVec2(900, 600), ImVec2(1280, 720), ImVec2(1366, 768), ImVec2(1920, 1080));
    const auto* const panel = GENERATE("hand", "coupling", "inspector", "plots", "machine", "keys");
    INFO(size.x << " x " << size.y << ", " << panel);
    WindowScreen screen;
    ImGui::GetIO().DisplaySize = size;
    open_panel(screen.app, panel);
    screen.frames(4);
    for (const ImGuiWindow* const window : list_windows()) {
        INFO(window->Name);
        CHECK(is_in_screen(window->Rect(), size));
        CHECK((window->ScrollbarX || window->ContentSize.x <= window->InnerRect.GetWidth() + 0.5F ||
               (window->Flags & ImGuiWindowFlags_NoScrollbar) != 0));
    }
}

TEST_CASE("a slider of the coupling changes a gain at once", "[app][panels]") {
    WindowScreen screen;
    open_panel(screen.app, "coupling");
    screen.frames(3);
    const LiveSettings before = screen.app.resource<SettingsState>().now;
    const float x = screen.picture().right + 60;
    for (float y = 300; y < 780 && screen.session.commands.empty(); y += 6)
        screen.drag({x, y}, {x + 90, y});
    REQUIRE_FALSE(screen.session.commands.empty());
    const LiveSettings after = std::get<LiveSettings>(screen.session.commands.back());
    CHECK_FALSE(after == before);
    CHECK(after == screen.app.resource<SettingsState>().now);
}

TEST_CASE("the legend of colours stands in the lower left corner of the picture", "[app][panels]") {
    const auto size = GENERATE(ImVec2(900, 600), ImVec2(1280, 720), ImVec2(1920, 1080));
    WindowScreen screen;
    ImGui::GetIO().DisplaySize = size;
    screen.app.write<NewestFrame>().frame.legend = {{{1, 0, 0}, "helix"}, {{0, 0, 1}, "strand"}};
    screen.frames(4);
    const ImGuiWindow* const legend = ImGui::FindWindowByName("##legend");
    REQUIRE(legend);
    const ScreenArea picture = screen.picture();
    CHECK(legend->Rect().Max.y <= picture.bottom);
    CHECK(legend->Rect().Min.x >= picture.left);
    CHECK(legend->Rect().Max.x <= 0.5F * (picture.left + picture.right));
    perform(screen.app, "panels");
    screen.frame();
    CHECK_FALSE(legend->Active);
}

TEST_CASE("what nothing in hand does is no step of a lesson", "[app][panels]") {
    WindowScreen screen;
    ServoTick tick = screen.tick;
    tick.contact.is_still = true;
    tick.contact.molecule.place_angstrom = Vec3(0, 0, 0);  // as near as the first step asks for
    const auto add_seconds = [&](int seconds) {
        for (int i = 0; i < 1000 * seconds; ++i) {
            tick.reading.time_s += 1e-3;
            add_tick(screen.app, tick);
        }
    };
    const Lesson& lesson = screen.app.resource<LessonState>().lesson;
    add_seconds(10);
    CHECK_FALSE(lesson.can_go_on());
    tick.contact.is_still = false;
    add_seconds(10);
    CHECK(lesson.can_go_on());
}

TEST_CASE("a lesson from the beginning waits until the world is as at the start", "[app][panels]") {
    WindowScreen screen;
    ServoTick tick = screen.tick;
    tick.contact.is_still = false;
    tick.contact.molecule.place_angstrom = Vec3(0, 0, 0);  // as near as the first step asks for
    const auto add_ticks = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) {
            tick.reading.time_s += 1e-3;
            add_tick(screen.app, tick);
        }
    };
    const Lesson& lesson = screen.app.resource<LessonState>().lesson;
    add_ticks(10);
    REQUIRE(lesson.is_step_done());
    perform(screen.app, "mode-4");
    screen.session.commands.clear();

    perform(screen.app, "restart-lesson");
    REQUIRE(screen.session.commands.size() == 2);
    CHECK(std::get<LiveSettings>(screen.session.commands[0]).coupling.mode ==
          CouplingMode::Guarded);
    CHECK(std::holds_alternative<Reset>(screen.session.commands[1]));
    CHECK_FALSE(lesson.is_step_done());
    add_ticks(10);  // of the world that goes
    CHECK_FALSE(lesson.is_step_done());
    screen.readout().resets = 1;
    follow_lesson(screen.app);
    add_ticks(10);  // some were under way
    CHECK_FALSE(lesson.is_step_done());
    follow_lesson(screen.app);
    add_ticks(10);
    CHECK(lesson.is_step_done());
}

TEST_CASE("Esc goes back one level and never quits", "[app][panels]") {
    WindowScreen screen;
    screen.frame();
    open_panel(screen.app, "keys");
    open_panel(screen.app, "search");
    screen.frame();
    perform(screen.app, "back");
    CHECK(is_panel_open(screen.app, "keys"));
    CHECK_FALSE(is_panel_open(screen.app, "search"));
    perform(screen.app, "back");
    CHECK_FALSE(is_panel_open(screen.app, "keys"));
    perform(screen.app, "back");
    CHECK_FALSE(screen.app.resource<FrameLoop>().is_quitting);
    CHECK_FALSE(screen.app.resource<Dialogs>().question);
}

TEST_CASE("Esc ends measuring before anything else", "[app][panels]") {
    WindowScreen screen;
    screen.frame();
    open_panel(screen.app, "keys");
    perform(screen.app, "measure");
    REQUIRE(measures(screen.app));
    perform(screen.app, "back");
    CHECK_FALSE(measures(screen.app));
    CHECK(is_panel_open(screen.app, "keys"));
}

TEST_CASE("atoms that were clicked on for a measure are forgotten where atoms get other numbers",
          "[app][panels]") {
    WindowScreen screen;
    screen.frame();
    perform(screen.app, "measure");
    select_anew(screen.app);
    measure_atom(screen.app, 0);
    screen.app.write<NewestFrame>().frame.atoms =
        std::make_shared<const AtomDirectory>(*frame_of(screen.app).atoms);
    select_anew(screen.app);
    CHECK(screen.app.resource<Measuring>().is_on);
    CHECK(screen.app.resource<Measuring>().atoms.empty());
}

TEST_CASE("a question is answered before anything behind it can be changed", "[app][panels]") {
    WindowScreen screen;
    screen.app.write<Dialogs>().question = {"Sure?", {{Key::Y, "Yes"}, {Key::Escape, "No"}}};
    screen.frames(2);
    for (const float x : {100.0F, 250.0F, 1000.0F})
        for (float y = 20; y < 790; y += 6) screen.drag({x, y}, {x + 60, y});
    CHECK(screen.session.commands.empty());
    CHECK_FALSE(screen.given);
    for (float y = 380; y < 440 && !screen.given; y += 6) screen.click({620, y});
    CHECK(screen.given == Key::Y);
}

TEST_CASE("at the wall a warning says how to get off it", "[app][panels]") {
    WindowScreen screen;
    screen.frames(2);
    const int usual = screen.vertices();
    ServoTick tick = screen.tick;
    tick.overtravel_m = {4e-3, 0, 0};
    tick.reading.time_s = 1;
    add_tick(screen.app, tick);
    screen.frames(2);
    CHECK(screen.vertices() > usual + 200);  // a line of some hundred letters, four corners each
}

TEST_CASE("a warning appears while steps are late, and not after a single late step",
          "[app][panels]") {
    WindowScreen screen;
    const auto vertices_after = [&](double step_ms, int frames) {
        screen.readout().step_ms = step_ms;
        screen.frames(frames);
        return screen.vertices();
    };
    const int usual = vertices_after(0.1, 3);
    CHECK(vertices_after(5, 1) < usual + 100);
    CHECK(vertices_after(0.1, 60) < usual + 100);
    CHECK(vertices_after(5, 60) > usual + 200);
}

TEST_CASE("a recording that is under way has a red mark", "[app][panels]") {
    WindowScreen screen;
    const auto count_red = [] {
        int count = 0;
        const ImDrawData& data = *ImGui::GetDrawData();
        for (int list = 0; list < data.CmdListsCount; ++list) {
            for (const ImDrawVert& vertex : data.CmdLists[list]->VtxBuffer) {
                const ImVec4 colour = ImGui::ColorConvertU32ToFloat4(vertex.col);
                count += colour.x > 0.7F && colour.y < 0.15F && colour.z < 0.15F ? 1 : 0;
            }
        }
        return count;
    };
    screen.frames(2);
    CHECK(count_red() == 0);
    screen.session.recorded = RecordingState{.recorded_s = 61.5};
    screen.frame();
    CHECK(count_red() > 10 + 4 * 13);  // a circle, and "recording 1:01"
}

TEST_CASE("the record button has the size and what is left, and a full disk is foretold once",
          "[app][panels][recording]") {
    WindowScreen screen;
    const Action& record = action_called("record");
    const auto is_told = [&](const char* text) {
        tell_of_recording(screen.app);
        const std::vector<std::string>& history = screen.app.resource<Notices>().history;
        return std::ranges::count_if(history, [&](const std::string& notice) {
            return notice.find(text) != std::string::npos;
        });
    };
    screen.frames(2);
    const int without = screen.vertices();
    CHECK(record.state(screen.app).empty());

    screen.session.recorded = {
        .recorded_s = 60, .bytes = 12'400'000, .free_bytes = 48'000'000'000, .bytes_per_s = 1e6};
    CHECK(record.state(screen.app) == "12 MB, 48 GB left");
    screen.frames(2);
    CHECK(screen.vertices() > without);
    CHECK(is_told("the disk has room") == 0);
    screen.session.recorded->free_bytes = 500'000'000;
    CHECK(is_told("the disk has room for 8 minutes of this recording: 500 MB are left") == 1);
    CHECK(is_told("the disk has room") == 1);

    screen.session.recorded.reset();
    screen.session.packed = 0.4;
    CHECK(record.state(screen.app) == "compressing: 40 %");
    screen.session.packed.reset();
    screen.session.ended = {{"folder", 7'700'000, ""}, {"other", 30'000'000, "no room"}};
    CHECK(is_told("recorded into folder, 8 MB; to play it: Ctrl+O, O, its journal.txt.gz") == 1);
    CHECK(is_told("recorded into other, 30 MB, but it could not be compressed: no room") == 1);
    CHECK(record.state(screen.app).empty());
}

TEST_CASE("keys switch modes, pause, step and reset", "[app][panels]") {
    WindowScreen screen;
    const std::vector<Command>& commands = screen.session.commands;
    const auto press = [&](Key key) { perform(screen.app, *find_action({key})); };
    press(Key::Digit4);
    CHECK(std::get<LiveSettings>(commands.at(0)).coupling.mode ==
          CouplingMode::ConstantForceConstantDisplacement);
    press(Key::Digit4);  // it is on already
    CHECK(commands.size() == 1);
    press(Key::P);
    CHECK(std::get<Pause>(commands.at(1)).paused);
    press(Key::P);
    CHECK_FALSE(std::get<Pause>(commands.at(2)).paused);
    press(Key::Period);
    CHECK(std::holds_alternative<StepOnce>(commands.at(3)));
    press(Key::R);
    CHECK(std::holds_alternative<Reset>(commands.at(4)));
}

TEST_CASE("every mode and size of window can be drawn, whatever the values", "[app][panels]") {
    WindowScreen screen;
    const auto* const mode = GENERATE("mode-1", "mode-2", "mode-3", "mode-4", "mode-5", "guarded");
    const auto size = GENERATE(ImVec2(1280, 800), ImVec2(320, 240), ImVec2(3840, 2160));
    ImGui::GetIO().DisplaySize = size;
    perform(screen.app, mode);
    ServoTick broken;
    broken.contact.force_newton.setConstant(std::numeric_limits<double>::quiet_NaN());
    broken.stopped = true;
    add_tick(screen.app, broken);
    for (const char* const panel : {"coupling", "hand", "plots", "machine", "inspector", "keys"}) {
        open_panel(screen.app, panel);
        screen.frames(2);
    }
    CHECK(screen.vertices() > 1000);
}

TEST_CASE("a spring stiffer than the hand keeps calm is called out", "[app][panels]") {
    const bool shakes = GENERATE(true, false);
    WindowScreen screen(test::water_scene(
        {"mode=2", shakes ? "period_ms=14" : "period_ms=1", "start_angstrom=2.77"}));
    CHECK(is_shaking(screen.app) == shakes);
}

TEST_CASE("search finds actions by their words and performs them", "[app][panels]") {
    WindowScreen screen;
    open_panel(screen.app, "search");
    screen.frames(3);
    ImGuiIO& io = ImGui::GetIO();
    for (const char letter : std::string("constant gains")) io.AddInputCharacter(letter);
    screen.frames(2);
    CHECK(press_in_panels(screen.app, {Key::Enter}));
    screen.frames(2);
    CHECK_FALSE(is_panel_open(screen.app, "search"));
    CHECK(screen.app.resource<SettingsState>().now.coupling.mode ==
          CouplingMode::ConstantForceConstantDisplacement);
}

TEST_CASE("an expression that is typed selects atoms, and a wrong one says why", "[app][panels]") {
    WindowScreen screen;
    open_panel(screen.app, "select", true);
    screen.frames(3);
    ImGuiIO& io = ImGui::GetIO();
    const auto type = [&](const std::string& text) {
        for (const char letter : text) io.AddInputCharacter(static_cast<unsigned>(letter));
        screen.frames(2);
        CHECK(press_in_panels(screen.app, {Key::Enter}));
        screen.frames(2);
    };
    type("name OH2");
    const SelectionState& selection = screen.app.resource<SelectionState>();
    CHECK(selection.expression == "name OH2");
    CHECK(std::ranges::count(selection.atoms, true) == 2);
    close_panel(screen.app, "select");
    screen.frame();
    open_panel(screen.app, "select", true);
    screen.frames(3);
    type("nmae OH2");
    CHECK_FALSE(selection.problem.empty());
    CHECK(selection.expression == "name OH2");  // stays
    perform(screen.app, "select-nothing");
    CHECK(selection.atoms.empty());
}

TEST_CASE("a click in the tree shows a molecule in the inspector, where it is hidden",
          "[app][panels]") {
    WindowScreen screen;
    screen.frames(2);
    const std::string second = screen.app.resource<NewestFrame>().frame.objects.molecules[1].name;
    const Inspectable wanted = InspectedMolecule{second};
    for (float y = 60; y < 200 && screen.app.resource<Inspected>().what != wanted; y += 6)
        screen.click({30, y});
    REQUIRE(screen.app.resource<Inspected>().what == wanted);
    screen.frames(2);
    const auto is_hidden = [&] {
        for (const Command& command : screen.session.commands) {
            const auto* const edit = std::get_if<EditDescription>(&command);
            const auto* const look = edit ? std::get_if<AppearanceEdit>(&edit->action) : nullptr;
            if (look && look->molecule == second && look->visible == false) return true;
        }
        return false;
    };
    const float x = screen.picture().right + 130;
    for (float y = 60; y < 400 && !is_hidden(); y += 5) screen.click({x, y});
    CHECK(is_hidden());
}

TEST_CASE("names of keys are German, and letters of keys stay", "[app][panels][translate]") {
    const test::InLanguage german("de");
    if (!german.is_there()) return test::skip("no German catalogue");
    CHECK(keys_of(action_called("pause")) == "P");
    CHECK(keys_of(action_called("redo")) == "Strg+Umschalt+Z, Strg+Y");
    CHECK(keys_of(action_called("remove")) == "Entf");
}
