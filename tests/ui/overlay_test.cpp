// The overlays without a window: a mouse that is only numbers moves sliders and presses buttons.
#include "ui/overlay.h"

#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/in_language.h"
#include "tests/support/skip.h"
#include "tests/support/water_scene.h"
#include "ui/backend.h"
#include "ui/question.h"

#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

using namespace palpa;

namespace {

// An overlay of the water scene on a screen that is not there.
struct Screen {
    explicit Screen(const SceneDescription& scene = test::water_scene(), float text_scale = 1)
        : overlay(scene) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280, 800};
        io.DeltaTime = 1 / 60.0F;
        set_ui_style(text_scale);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        World world = load_world(scene);
        readout.contact = contact_at(world, 0).model;
        ServoTick tick;
        tick.contact = readout.contact;
        for (int i = 0; i < 100; ++i) overlay.add_tick(tick);
    }
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    ~Screen() { ImGui::DestroyContext(); }

    void frame() {
        ImGui::NewFrame();
        overlay.draw(readout, status, commands, actions);
        if (question) {
            if (const Answer* const answer = draw_question(*question)) given = answer->key;
        }
        ImGui::Render();
    }
    void drag(ImVec2 from, ImVec2 to) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = from;
        frame();
        io.MouseDown[0] = true;
        frame();
        io.MousePos = to;
        frame();
        io.MouseDown[0] = false;
        frame();
        frame();
    }
    // Everything that is written on the screen has been laid out: vertices say so.
    int vertices() const { return ImGui::GetDrawData()->TotalVtxCount; }

    Overlay overlay;
    Readout readout;
    OverlayStatus status;
    std::vector<Command> commands;
    std::vector<Action> actions;
    std::optional<Question> question;
    std::optional<Key> given;
};

// As the environment does; empty: the usual ones.
void name_font(const char* file) {
#ifdef _WIN32
    _putenv_s("PALPA_FONT", file);
#else
    setenv("PALPA_FONT", file, 1);
#endif
}

}  // namespace

TEST_CASE("settings and additions are those that undo has restored", "[ui]") {
    Screen screen;
    const LiveSettings first = screen.overlay.settings();
    const ViewAdditions none = screen.overlay.additions();
    const ViewAdditions one{{}, {"resid 1"}, {}};
    CHECK(screen.overlay.set_additions(one));
    CHECK_FALSE(screen.overlay.set_additions(one));
    screen.overlay.perform(Action::Mode2, screen.commands);
    CHECK(screen.commands.size() == 1);
    screen.readout.undo.settings = first;
    screen.readout.undo.additions = none;

    screen.frame();  // the session has not heard of them yet
    CHECK(screen.overlay.additions() == one);
    CHECK_FALSE(screen.overlay.settings() == first);
    ++screen.readout.undo.restored;
    screen.commands.clear();
    screen.frame();
    CHECK(screen.overlay.additions() == none);
    CHECK(screen.overlay.settings() == first);
    CHECK(screen.commands.empty());

    // Devices hear of another period.
    screen.readout.undo.settings.period_ms = 20;
    ++screen.readout.undo.restored;
    screen.frame();
    CHECK(screen.commands.size() == 1);
    CHECK(screen.overlay.settings().period_ms == 20);
}

TEST_CASE("panels stay in the window with text twice as large, and without a font file",
          "[ui][overlay]") {
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
    Screen screen(test::water_scene(), row.text_scale);
    name_font("");
    ImGui::GetIO().DisplaySize = row.size;
    for (int i = 0; i < 4; ++i) screen.frame();

    CHECK(screen.vertices() > 1000);                                   // words are there
    if (row.font) CHECK(ImGui::GetFont()->FindGlyphNoFallback(0xC5));  // Å
    const ScreenArea free = screen.overlay.free_area(row.size.x, row.size.y);
    CHECK(free.width() >= 0.15F * row.size.x);
    for (const ImGuiWindow* const window : ImGui::GetCurrentContext()->Windows) {
        if (window->Collapsed || !window->WasActive || window->IsFallbackWindow) continue;
        INFO(window->Name);
        const ImRect area = window->Rect();
        CHECK(area.Min.x >= 0);
        CHECK(area.Min.y >= 0);
        CHECK(area.Max.x <= row.size.x);
        CHECK(area.Max.y <= row.size.y);
        CHECK(
            (window->ScrollbarY || window->ContentSize.y <= window->InnerRect.GetHeight() + 0.5F));
    }
}

TEST_CASE("a dragged slider changes a gain at once", "[ui][overlay]") {
    Screen screen;
    screen.frame();
    screen.frame();
    const LiveSettings before = screen.overlay.settings();
    ImVec2 slider{};
    // The sliders stand in the right column; find the first that answers.
    for (float y = 300; y < 700 && screen.commands.empty(); y += 6) {
        slider = {1000, y};
        screen.drag(slider, {1130, y});
    }
    REQUIRE_FALSE(screen.commands.empty());
    const LiveSettings after = std::get<LiveSettings>(screen.commands.back());
    CHECK_FALSE(after == before);
    CHECK(after == screen.overlay.settings());
    CHECK(after.coupling.mode == before.coupling.mode);
}

TEST_CASE("in a small window panels are folded, and the molecule is seen", "[ui][overlay]") {
    Screen screen;
    for (const ImVec2 size : {ImVec2(640, 480), ImVec2(800, 500)}) {
        INFO(size.x << " x " << size.y);
        ImGui::GetIO().DisplaySize = {1280, 720};
        for (int i = 0; i < 3; ++i) screen.frame();
        const ScreenArea large = screen.overlay.free_area(1280, 720);
        CHECK(large.width() > 0.4F * 1280);
        ImGui::GetIO().DisplaySize = size;
        for (int i = 0; i < 3; ++i) screen.frame();
        CHECK(screen.overlay.free_area(size.x, size.y).width() > 0.9F * size.x);
        CHECK(ImGui::FindWindowByName("###Coupling")->Collapsed);
    }
    // A person may look at one nevertheless.
    ImGui::SetWindowCollapsed("###Coupling", false);
    for (int i = 0; i < 3; ++i) screen.frame();
    CHECK_FALSE(ImGui::FindWindowByName("###Coupling")->Collapsed);
}

namespace {

// And the picture's middle is covered by no panel.
void check_nothing_is_cut_off(ImVec2 size, Action action) {
    INFO(size.x << " x " << size.y << ", action " << static_cast<int>(action));
    Screen screen;
    ImGui::GetIO().DisplaySize = size;
    screen.overlay.perform(action, screen.commands);
    for (int i = 0; i < 4; ++i) screen.frame();

    const ScreenArea free = screen.overlay.free_area(size.x, size.y);
    CHECK(free.width() > 0.3F * size.x);
    CHECK(free.height() > 0.5F * size.y);
    for (const ImGuiWindow* const window : ImGui::GetCurrentContext()->Windows) {
        if (!window->WasActive || window->IsFallbackWindow) continue;
        INFO(window->Name);
        const ImRect area = window->Rect();
        CHECK(area.Min.x >= 0);
        CHECK(area.Min.y >= 0);
        CHECK(area.Max.x <= size.x);
        CHECK(area.Max.y <= size.y);
        CHECK(window->ContentSize.x <= window->InnerRect.GetWidth() + 0.5F);
        CHECK(
            (window->ScrollbarY || window->ContentSize.y <= window->InnerRect.GetHeight() + 0.5F));
        const bool is_above =
            action == Action::ToggleHelp && window->ID == ImHashStr("###Keys and mouse");
        if (is_above || (window->Flags & ImGuiWindowFlags_ChildWindow) != 0) continue;
        constexpr float rounding = 1;  // places are whole pixels
        const bool covers = area.Min.x < free.right - rounding &&
                            area.Max.x > free.left + rounding &&
                            area.Min.y < free.bottom - rounding && area.Max.y > free.top + rounding;
        CHECK_FALSE(covers);
    }
    for (int i = 0; i < ImGui::GetCurrentContext()->Tables.GetMapSize(); ++i) {
        const ImGuiTable* const table = ImGui::GetCurrentContext()->Tables.TryGetMapData(i);
        if (!table) continue;
        for (int column = 0; column < table->ColumnsCount; ++column) {
            const ImGuiTableColumn& cells = table->Columns[column];
            CHECK(cells.ContentMaxXUnfrozen <= cells.ClipRect.Max.x + 1);
        }
    }
}

}  // namespace

TEST_CASE("nothing is cut off, and the picture's middle is covered by no panel", "[ui][overlay]") {
    const auto size =
        GENERATE(ImVec2(900, 600), ImVec2(1280, 720), ImVec2(1366, 768), ImVec2(1920, 1080));
    const auto action = GENERATE(Action::Guarded, Action::Mode1, Action::ToggleHelp);
    check_nothing_is_cut_off(size, action);
}

TEST_CASE("nothing is cut off in German", "[ui][overlay][translate]") {
    const test::InLanguage german("de");
    if (!german.is_there()) return test::skip("no German catalogue");
    const auto size =
        GENERATE(ImVec2(900, 600), ImVec2(1280, 720), ImVec2(1366, 768), ImVec2(1920, 1080));
    const auto action = GENERATE(Action::Guarded, Action::Mode1, Action::ToggleHelp);
    check_nothing_is_cut_off(size, action);
}

TEST_CASE("the legend of colours stands above what is below the picture", "[ui][overlay]") {
    const auto size = GENERATE(ImVec2(900, 600), ImVec2(1280, 720), ImVec2(1920, 1080));
    const bool plays = GENERATE(false, true);
    INFO(size.x << " x " << size.y << (plays ? ", plays" : ""));
    Screen screen;
    ImGui::GetIO().DisplaySize = size;
    screen.status.legend = {{{1, 0, 0}, "helix"}, {{0, 0, 1}, "strand"}};
    if (plays) screen.readout.playback = PlaybackState{.frames = 100};
    for (int i = 0; i < 4; ++i) screen.frame();

    const ImGuiWindow* const legend = ImGui::FindWindowByName("##legend");
    const ImGuiWindow* const below = ImGui::FindWindowByName(plays ? "###Trajectory" : "###Lesson");
    REQUIRE(legend);
    REQUIRE(below);
    REQUIRE(below->Active);
    const ImRect box = legend->Rect();
    CHECK(box.Max.y <= below->Pos.y);
    CHECK(box.Max.y >= below->Pos.y - 0.2F * size.y);
    const ScreenArea free = screen.overlay.free_area(size.x, size.y);
    CHECK(box.Min.x >= free.left);
    CHECK(box.Max.x <= 0.5F * (free.left + free.right));

    screen.overlay.perform(Action::ToggleOverlay, screen.commands);
    screen.frame();
    CHECK_FALSE(legend->Active);
}

TEST_CASE("the help breaks its lines where a screen is narrow, and keys only where they must",
          "[ui][overlay]") {
    struct Row {
        ImVec2 size;
        float text_scale;
    };
    const auto row = GENERATE(
        values<Row>({{{900, 600}, 1}, {{900, 600}, 1.5F}, {{1600, 1000}, 1.5F}, {{640, 480}, 1}}));
    INFO(row.size.x << " x " << row.size.y << ", text " << row.text_scale);
    Screen screen(test::water_scene(), row.text_scale);
    ImGui::GetIO().DisplaySize = row.size;
    screen.overlay.perform(Action::ToggleHelp, screen.commands);
    for (int i = 0; i < 4; ++i) screen.frame();

    ImGuiWindow& window = *ImGui::FindWindowByName("###Keys and mouse");
    CHECK(window.Rect().Min.x >= 0);
    CHECK(window.Rect().Max.x <= row.size.x);
    CHECK(window.Rect().Max.y <= row.size.y);
    CHECK(window.ContentSize.x <= window.InnerRect.GetWidth());
    const ImGuiTable* const table = ImGui::TableFindByID(window.GetID("keys"));
    REQUIRE(table);
    for (int column = 0; column < 4; ++column) {
        const ImGuiTableColumn& cells = table->Columns[column];
        CHECK(cells.ContentMaxXUnfrozen <= cells.ClipRect.Max.x + 1);
    }
    // "Ctrl+Shift+Z" and the like are in the narrower columns, which stay whole.
    CHECK(table->Columns[2].WidthGiven >= ImGui::CalcTextSize("Enter, N").x);
}

TEST_CASE("what nothing in hand does is no step of a lesson", "[ui][overlay]") {
    Screen screen;
    ServoTick tick;
    tick.contact = screen.readout.contact;
    tick.contact.is_still = true;
    tick.contact.molecule.place_angstrom = Vec3(0, 0, 0);  // as near as the first step asks for
    const auto add_seconds = [&](int seconds) {
        for (int i = 0; i < 1000 * seconds; ++i) {
            tick.reading.time_s += 1e-3;
            screen.overlay.add_tick(tick);
        }
    };
    add_seconds(10);
    CHECK_FALSE(screen.overlay.lesson().can_go_on());
    tick.contact.is_still = false;
    add_seconds(10);
    CHECK(screen.overlay.lesson().can_go_on());
}

TEST_CASE("a lesson from the beginning waits until the world is as at the start", "[ui][overlay]") {
    Screen screen;
    ServoTick tick;
    tick.contact = screen.readout.contact;
    tick.contact.is_still = false;
    tick.contact.molecule.place_angstrom = Vec3(0, 0, 0);  // as near as the first step asks for
    const auto add_ticks = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) {
            tick.reading.time_s += 1e-3;
            screen.overlay.add_tick(tick);
        }
    };
    const Lesson& lesson = screen.overlay.lesson();
    add_ticks(10);
    REQUIRE(lesson.is_step_done());
    (void)screen.overlay.perform(Action::Mode4, screen.commands);
    screen.commands.clear();
    screen.frame();
    screen.frame();

    const ImGuiWindow* const panel = ImGui::FindWindowByName("###Lesson");
    REQUIRE(panel);
    // The last row: "skip" or "Next", then the button; its right end stands last.
    const float y = panel->Rect().Max.y - 14;
    for (float x = panel->Rect().Max.x - 4; x > panel->Rect().Min.x && screen.actions.empty();
         x -= 6)
        screen.drag({x, y}, {x, y});

    REQUIRE(screen.actions == std::vector{Action::Reset});
    REQUIRE(screen.commands.size() == 1);
    CHECK(std::get<LiveSettings>(screen.commands[0]).coupling.mode == CouplingMode::Guarded);
    CHECK_FALSE(lesson.is_step_done());
    add_ticks(10);  // of the world that goes
    CHECK_FALSE(lesson.is_step_done());
    screen.readout.resets = 1;
    screen.frame();
    add_ticks(10);  // some were under way
    CHECK_FALSE(lesson.is_step_done());
    screen.frame();
    add_ticks(10);
    CHECK(lesson.is_step_done());
}

TEST_CASE("both gain curves are 120 pixels high where a screen is 720", "[ui][overlay]") {
    const auto size = GENERATE(ImVec2(1280, 720), ImVec2(1366, 768));
    Screen screen;
    ImGui::GetIO().DisplaySize = size;
    for (int i = 0; i < 4; ++i) screen.frame();
    CHECK(screen.overlay.plot_height() >= 120);
}

TEST_CASE("Esc closes an open list, then the help, and then nothing", "[ui][overlay]") {
    Screen screen;
    screen.overlay.perform(Action::ToggleHelp, screen.commands);
    screen.frame();
    CHECK(screen.overlay.close_something());
    CHECK_FALSE(screen.overlay.close_something());

    screen.frame();
    // The drop-down of the modes, below the buttons of the left column.
    for (float y = 40; y < 300; y += 6) {
        screen.drag({150, y}, {150, y});
        if (ImGui::GetCurrentContext()->OpenPopupStack.Size > 0) break;
    }
    REQUIRE(ImGui::GetCurrentContext()->OpenPopupStack.Size == 1);
    CHECK(screen.overlay.close_something());
    screen.frame();
    CHECK(ImGui::GetCurrentContext()->OpenPopupStack.Size == 0);
    CHECK_FALSE(screen.overlay.close_something());
}

TEST_CASE("a question is answered before anything behind it can be changed", "[ui][overlay]") {
    Screen screen;
    screen.question = Question{"Sure?", {{Key::Y, "Yes"}, {Key::Escape, "No"}}};
    screen.frame();
    screen.frame();
    for (const float x : {100.0F, 250.0F, 1000.0F}) {
        for (float y = 20; y < 790; y += 6) screen.drag({x, y}, {x + 60, y});
    }
    CHECK(screen.commands.empty());
    CHECK(screen.actions.empty());
    CHECK_FALSE(screen.given);
    for (float y = 380; y < 440 && !screen.given; y += 6) screen.drag({620, y}, {620, y});
    CHECK(screen.given == Key::Y);
}

TEST_CASE("at the wall the overlay says how to get off it", "[ui][overlay]") {
    Screen screen;
    const int usual = (screen.frame(), screen.frame(), screen.vertices());
    ServoTick tick;
    tick.contact = screen.readout.contact;
    tick.overtravel_m = {4e-3, 0, 0};
    tick.reading.time_s = 1;
    screen.overlay.add_tick(tick);
    screen.frame();
    screen.frame();
    CHECK(screen.vertices() > usual + 200);  // a line of some hundred letters, four corners each
}

TEST_CASE("a warning appears while steps are late, and not after a single late step",
          "[ui][overlay]") {
    Screen screen;
    const auto vertices_after = [&](double step_ms, int frames) {
        screen.readout.step_ms = step_ms;
        for (int i = 0; i < frames; ++i) screen.frame();
        return screen.vertices();
    };
    const int usual = vertices_after(0.1, 3);
    CHECK(vertices_after(5, 1) < usual + 100);  // the reading has more digits
    CHECK(vertices_after(0.1, 60) < usual + 100);
    CHECK(vertices_after(5, 60) > usual + 200);
}

TEST_CASE("why an edit was refused is written over the picture", "[ui][overlay]") {
    Screen screen;
    const int usual = (screen.frame(), screen.frame(), screen.vertices());
    screen.readout.problem = "not done: the scene's force field has no residue 'ABC'";
    screen.frame();
    screen.frame();
    CHECK(screen.vertices() > usual + 100);  // four corners a letter
}

TEST_CASE("a recording that is under way has a red mark", "[ui][overlay]") {
    Screen screen;
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
    screen.frame();
    screen.frame();
    CHECK(count_red() == 0);
    screen.status.recorded_s = 61.5;
    screen.frame();
    CHECK(count_red() > 10 + 4 * 13);  // a circle, and "recording 1:01"
}

TEST_CASE("buttons add and remove a molecule, and record", "[ui][overlay]") {
    Screen screen;
    screen.frame();
    screen.frame();
    const Action wanted = GENERATE(Action::Add, Action::Remove, Action::Record);
    const auto is_asked = [&] {
        return std::count(screen.actions.begin(), screen.actions.end(), wanted) > 0;
    };
    for (float y = 60; y < 130 && !is_asked(); y += 10) {
        for (float x = 20; x < 350 && !is_asked(); x += 20) screen.drag({x, y}, {x, y});
    }
    CHECK(is_asked());
    CHECK_FALSE(screen.overlay.perform(wanted, screen.commands));  // the window does
}

TEST_CASE("keys switch modes, pause, step and reset", "[ui][overlay]") {
    Screen screen;
    std::vector<Command>& commands = screen.commands;
    CHECK(screen.overlay.perform(Action::Mode4, commands));
    CHECK(std::get<LiveSettings>(commands.at(0)).coupling.mode ==
          CouplingMode::ConstantForceConstantDisplacement);
    screen.overlay.perform(Action::Mode4, commands);  // it is on already
    CHECK(commands.size() == 1);
    screen.overlay.perform(Action::PauseOrGo, commands);
    CHECK(std::get<Pause>(commands.at(1)).paused);
    screen.overlay.perform(Action::PauseOrGo, commands);
    CHECK_FALSE(std::get<Pause>(commands.at(2)).paused);
    screen.overlay.perform(Action::StepOnce, commands);
    CHECK(std::holds_alternative<StepOnce>(commands.at(3)));
    screen.overlay.perform(Action::Reset, commands);
    CHECK(std::holds_alternative<Reset>(commands.at(4)));
    CHECK_FALSE(screen.overlay.perform(Action::Screenshot, commands));
    CHECK_FALSE(screen.overlay.perform(Action::Quit, commands));
}

TEST_CASE("a click on the box beside sound asks for it", "[ui][overlay]") {
    Screen screen;
    screen.frame();
    screen.frame();
    const auto asked = [&] {
        return std::count(screen.actions.begin(), screen.actions.end(), Action::ToggleSound);
    };
    // The readings stand in the left column, their values from its middle on.
    for (float y = 100; y < 790 && asked() == 0; y += 6) screen.drag({160, y}, {160, y});

    CHECK(asked() == 1);
    CHECK_FALSE(screen.overlay.perform(Action::ToggleSound, screen.commands));  // the window does
}

TEST_CASE("every mode and size of window can be drawn, whatever the values", "[ui][overlay]") {
    Screen screen;
    const auto mode =
        GENERATE(Action::Mode1, Action::Mode2, Action::Mode3, Action::Mode4, Action::Mode5);
    const auto size = GENERATE(ImVec2(1280, 800), ImVec2(320, 240), ImVec2(3840, 2160));
    ImGui::GetIO().DisplaySize = size;
    screen.overlay.perform(mode, screen.commands);
    screen.overlay.perform(Action::ToggleHelp, screen.commands);
    ServoTick broken;
    broken.contact.force_newton.setConstant(std::numeric_limits<double>::quiet_NaN());
    broken.stopped = true;
    screen.overlay.add_tick(broken);

    for (int i = 0; i < 3; ++i) screen.frame();

    CHECK(screen.vertices() > 1000);
    screen.overlay.perform(Action::ToggleHelp, screen.commands);
    screen.overlay.perform(Action::ToggleLesson, screen.commands);
    screen.overlay.perform(Action::ToggleOverlay, screen.commands);
    const int many = screen.vertices();
    screen.frame();
    CHECK(screen.vertices() < many / 2);
}

TEST_CASE("a spring stiffer than the hand keeps calm is called out", "[ui][overlay]") {
    const bool shakes = GENERATE(true, false);
    Screen screen(test::water_scene(
        {"mode=2", shakes ? "period_ms=14" : "period_ms=1", "start_angstrom=2.77"}));
    CHECK(screen.overlay.is_shaking(screen.readout) == shakes);
}
