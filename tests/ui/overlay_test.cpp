// The overlays without a window: a mouse that is only numbers moves sliders and presses buttons.
#include "ui/overlay.h"

#include "simulation/step.h"
#include "tests/support/water_scene.h"
#include "ui/backend.h"
#include "ui/question.h"

#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

using namespace palpa;

namespace {

// An overlay of the water scene on a screen that is not there.
struct Screen {
    explicit Screen(const SceneDescription& scene = test::water_scene()) : overlay(scene) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280, 800};
        io.DeltaTime = 1 / 60.0F;
        set_ui_style(1);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        Simulation simulation = load_simulation(scene);
        readout.touch = simulation.touch.model;
        ServoTick tick;
        tick.touch = readout.touch;
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

}  // namespace

TEST_CASE("a dragged slider changes a gain at once, and one undo takes the whole drag back",
          "[ui][overlay]") {
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

    screen.commands.clear();
    CHECK(screen.overlay.perform(Action::Undo, screen.commands));
    REQUIRE(screen.commands.size() == 1);
    CHECK(std::get<LiveSettings>(screen.commands[0]) == before);
    screen.overlay.perform(Action::Redo, screen.commands);
    CHECK(screen.overlay.settings() == after);
    screen.overlay.perform(Action::Undo, screen.commands);
    screen.overlay.perform(Action::Undo, screen.commands);  // nothing is left
    CHECK(screen.overlay.settings() == before);
}

TEST_CASE("nothing is cut off, and the picture's middle is covered by no panel", "[ui][overlay]") {
    const auto size =
        GENERATE(ImVec2(900, 600), ImVec2(1280, 720), ImVec2(1366, 768), ImVec2(1920, 1080));
    const auto action = GENERATE(Action::Guarded, Action::Mode1, Action::ToggleHelp);
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
            action == Action::ToggleHelp && window->Name == std::string("Keys and mouse");
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
    tick.touch = screen.readout.touch;
    tick.kept_m = {4e-3, 0, 0};
    tick.reading.time_s = 1;
    screen.overlay.add_tick(tick);
    screen.frame();
    screen.frame();
    CHECK(screen.vertices() > usual + 200);  // a line of some hundred letters, four corners each
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
    broken.touch.force_newton.setConstant(std::numeric_limits<double>::quiet_NaN());
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
