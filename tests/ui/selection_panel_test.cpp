// The panel of selections without a window: letters and a mouse that are only numbers.
#include "ui/selection_panel.h"

#include "ui/backend.h"
#include "ui/caption.h"

#include <imgui.h>
#include <imgui_internal.h>
#include <catch2/catch.hpp>
#include <optional>
#include <string>

using namespace palpa;

namespace {

struct SelectionScreen {
    explicit SelectionScreen(ImVec2 size = {1280, 800}, float text_scale = 1) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = size;
        io.DeltaTime = 1 / 60.0F;
        for (const int key : {ImGuiKey_Enter, ImGuiKey_Escape, ImGuiKey_End}) io.KeyMap[key] = key;
        set_ui_style(text_scale);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        area = {0.3F * size.x, 48 * text_scale, 0.7F * size.x, size.y};
    }
    SelectionScreen(const SelectionScreen&) = delete;
    SelectionScreen& operator=(const SelectionScreen&) = delete;
    ~SelectionScreen() { ImGui::DestroyContext(); }

    void frame() {
        ImGui::NewFrame();
        const SelectionOrder order = panel.draw(status, additions, area);
        ImGui::Render();
        if (order.select) selected = order.select;
        if (order.additions) additions = *order.additions;
        focused = focused || order.focus;
    }
    void type(const std::string& text) {
        ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
        frame();
        frame();
    }
    // As the window passes it on, and, where a frame sees it, the library.
    void press(Key key, bool is_seen = true) {
        const ImGuiKey_ same = key == Key::Enter ? ImGuiKey_Enter : ImGuiKey_Escape;
        ImGui::GetIO().KeysDown[same] = is_seen;
        panel.press(key);
        frame();
        ImGui::GetIO().KeysDown[same] = false;
        frame();
    }
    void press_end() {
        ImGui::GetIO().KeysDown[ImGuiKey_End] = true;
        frame();
        ImGui::GetIO().KeysDown[ImGuiKey_End] = false;
        frame();
    }
    void click(ImVec2 place) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = place;
        frame();
        io.MouseDown[0] = true;
        frame();
        io.MouseDown[0] = false;
        frame();
        frame();
    }
    ImRect panel_area() const {
        return ImGui::FindWindowByName(labelled(selection_panel).c_str())->Rect();
    }
    // Clicks all over the panel's lower part until something has happened; it may grow meanwhile.
    template <class Test>
    bool click_until(const Test& is_done) {
        for (float y = 50; y < panel_area().GetHeight(); y += 8)
            for (float x = 10; x < panel_area().GetWidth(); x += 25) {
                if (ImGui::GetCurrentContext()->OpenPopupStack.Size > 0)
                    ImGui::ClosePopupToLevel(0, true);
                click({panel_area().Min.x + x, panel_area().Min.y + y});
                if (is_done()) return true;
            }
        return false;
    }

    SelectionPanel panel;
    SelectionStatus status;
    ViewAdditions additions;
    ScreenArea area;
    std::optional<std::string> selected;
    bool focused = false;
};

}  // namespace

TEST_CASE("an expression is typed, asked for by Enter, and kept where it was wrong",
          "[ui][selection]") {
    const bool is_seen = GENERATE(true, false);  // false: it was down for less than a frame
    SelectionScreen screen;
    screen.frame();
    CHECK_FALSE(screen.panel.is_open());
    screen.panel.open();
    screen.frame();
    screen.frame();
    screen.type("protien");
    CHECK_FALSE(screen.selected);
    screen.press(Key::Enter, is_seen);
    REQUIRE(screen.selected == "protien");

    screen.status.problem = "selection, column 1: 'protien'";
    screen.selected.reset();
    screen.panel.open();
    screen.frame();
    screen.frame();
    screen.press_end();
    screen.type(" or water");
    screen.press(Key::Escape, is_seen);  // typing ends, and nothing is lost
    screen.panel.open();
    screen.frame();
    screen.frame();
    screen.press(Key::Enter, is_seen);
    CHECK(screen.selected == "protien or water");

    screen.panel.show("resid 1:3");
    screen.frame();
    screen.panel.open();
    screen.frame();
    screen.frame();
    screen.press(Key::Enter, is_seen);
    CHECK(screen.selected == "resid 1:3");
}

TEST_CASE("buttons draw, hide, name and look at what is selected, and what was added is removed",
          "[ui][selection]") {
    SelectionScreen screen;
    screen.panel.show("resid 5");
    for (int i = 0; i < 3; ++i) screen.frame();
    CHECK_FALSE(screen.click_until(
        [&] { return screen.additions != ViewAdditions() || screen.focused; }));  // nothing is

    screen.status = {"resid 5", "1 residue, 7 atoms", {}};
    screen.frame();
    REQUIRE(screen.click_until([&] { return !screen.additions.layers.empty(); }));
    CHECK(screen.additions.layers[0].of == "resid 5");
    CHECK(screen.additions.hidden.empty());  // "Add this look" stands first
    const std::size_t layers = screen.additions.layers.size();
    (void)screen.click_until([&] { return !screen.additions.labels.empty(); });
    CHECK(screen.additions.layers.size() == layers);  // the same is not added again
    screen.additions.labels.clear();
    screen.additions.hidden.clear();
    REQUIRE(screen.click_until([&] { return !screen.additions.hidden.empty(); }));
    CHECK(screen.additions.hidden[0] == "resid 5");
    screen.additions = {};
    screen.frame();
    REQUIRE(screen.click_until([&] { return !screen.additions.labels.empty(); }));
    CHECK(screen.additions.labels[0] == "resid 5");
    REQUIRE(screen.click_until([&] { return screen.focused; }));
    screen.selected.reset();
    REQUIRE(screen.click_until([&] { return screen.selected.has_value(); }));
    CHECK(screen.selected->empty());

    screen.additions = {{{.of = "resid 7"}}, {}, {}};
    screen.status = {};
    for (int i = 0; i < 3; ++i) screen.frame();
    CHECK(screen.click_until([&] { return screen.additions.layers.empty(); }));
}

TEST_CASE("the panel of selections fits windows and text of any size", "[ui][selection]") {
    struct Row {
        ImVec2 size;
        float text_scale;
    };
    const auto row = GENERATE(values<Row>(
        {{{1280, 720}, 1}, {{900, 600}, 1}, {{1280, 720}, 2}, {{2560, 1440}, 2}, {{640, 480}, 1}}));
    INFO(row.size.x << " x " << row.size.y << ", text " << row.text_scale);
    SelectionScreen screen(row.size, row.text_scale);
    screen.panel.show("protein");
    screen.status = {"protein", "198 residues, 3128 atoms",
                     "selection, column 9: 'protien', expected"
                     " protein, chain A, resid 50:80, resname LIG, name CA or within 5 of ligand"};
    for (int i = 0; i < 12; ++i)
        screen.additions.labels.push_back("molecule protease_a and resid 25 and name CA");
    for (int i = 0; i < 4; ++i) screen.frame();

    const ImGuiWindow& window = *ImGui::FindWindowByName(labelled(selection_panel).c_str());
    CHECK(window.Rect().Min.x >= 0);
    CHECK(window.Rect().Max.x <= row.size.x);
    CHECK(window.Rect().Min.y >= 0.5F * row.size.y);
    CHECK(window.Rect().Max.y <= row.size.y);
    CHECK(window.ContentSize.x <= window.InnerRect.GetWidth() + 0.5F);
    CHECK(window.ScrollbarY);
}

TEST_CASE("a caption stands in its area, smaller where it would not fit", "[ui][caption]") {
    const std::string text = GENERATE(std::string("flaps"), std::string(200, 'M'));
    SelectionScreen screen;
    ImGui::NewFrame();
    draw_caption(text, {400, 50, 800, 700});
    ImGui::Render();

    const ImDrawData& data = *ImGui::GetDrawData();
    REQUIRE(data.CmdListsCount == 1);
    float left = 1e9F, right = 0, top = 1e9F, bottom = 0;
    for (const ImDrawVert& vertex : data.CmdLists[0]->VtxBuffer) {
        left = std::min(left, vertex.pos.x);
        right = std::max(right, vertex.pos.x);
        top = std::min(top, vertex.pos.y);
        bottom = std::max(bottom, vertex.pos.y);
    }
    CHECK(left >= 400);
    CHECK(right <= 800);
    CHECK(left + right == Approx(1200).margin(4));
    CHECK(top >= 50);
    CHECK(bottom < 150);
}
