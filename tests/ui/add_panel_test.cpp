// The dialog without a window: a mouse and keys that are only numbers.
#include "ui/add_panel.h"

#include "loading/load.h"
#include "scene/read_scene.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"
#include "ui/backend.h"
#include "ui/layout.h"

#include <imgui.h>
#include <imgui_internal.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

using namespace palpa;

namespace {

std::shared_ptr<const AtomDirectory> atoms_of(const SceneDescription& scene) {
    return list_atoms(load_world(scene));
}

struct Dialog {
    explicit Dialog(const SceneDescription& scene = test::water_scene(), ImVec2 size = {1280, 800},
                    float text_scale = 1)
        : panel(scene.file.parent_path()), atoms(atoms_of(scene)) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = size;
        io.DeltaTime = 1 / 60.0F;
        set_ui_style(text_scale);
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }
    Dialog(const Dialog&) = delete;
    Dialog& operator=(const Dialog&) = delete;
    ~Dialog() { ImGui::DestroyContext(); }

    void frame() {
        ImGui::NewFrame();
        if (std::optional<AddEdit> edit = panel.draw(*atoms)) asked = std::move(edit);
        ImGui::Render();
    }
    void frames() {
        for (int i = 0; i < 4; ++i) frame();
    }
    // A text, and Enter before the library has seen it.
    void type_and_enter(const std::string& text) {
        ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
        enter();
    }
    void enter() {
        panel.press({Key::Enter});
        frames();
    }
    void click(float x, float y) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {x, y};
        frame();
        io.MouseDown[0] = true;
        frame();
        io.MouseDown[0] = false;
        frames();
    }
    const ImGuiWindow& window() const { return *ImGui::FindWindowByName("###Add a molecule"); }
    // The first of the three circles, and those below it.
    void choose(int origin) {
        const ImRect area = window().Rect();
        const float line = ImGui::GetFontSize() + ImGui::GetStyle().FramePadding.y * 2 +
                           ImGui::GetStyle().ItemSpacing.y;
        const ImVec2 padding = ImGui::GetStyle().WindowPadding;
        click(area.Min.x + padding.x + 0.5F * ImGui::GetFontSize(),
              area.Min.y + window().TitleBarHeight() + padding.y +
                  line * (static_cast<float>(origin) + 0.45F));
    }

    // Above the buttons and a line for what is wrong.
    void enter_name() {
        const ImRect area = window().Rect();
        const ImGuiStyle& style = ImGui::GetStyle();
        const float button = ImGui::GetFontSize() + 2 * style.FramePadding.y;
        click(area.GetCenter().x, area.Max.y - style.WindowPadding.y - ImGui::GetFontSize() -
                                      2 * style.ItemSpacing.y - 1.5F * button);
        ImGui::GetIO().KeyCtrl = true;
        ImGui::GetIO().KeyMap[ImGuiKey_A] = 'A';
        ImGui::GetIO().KeysDown['A'] = true;
        frame();
        ImGui::GetIO().KeysDown['A'] = false;
        ImGui::GetIO().KeyCtrl = false;
        frame();
    }

    AddPanel panel;
    std::shared_ptr<const AtomDirectory> atoms;
    std::optional<AddEdit> asked;
};

SceneDescription peptides() { return read_scene(test::test_data("two_peptides")); }

}  // namespace

TEST_CASE("Enter asks for the residue that is chosen, by a name that is free", "[ui][add]") {
    Dialog screen;
    screen.panel.open(*screen.atoms, "");
    screen.frames();
    CHECK(screen.panel.is_open());
    CHECK_FALSE(screen.asked);

    screen.enter();

    REQUIRE(screen.asked);
    CHECK(*screen.asked == AddEdit{"TIP3", "", "w2", {}});
    CHECK_FALSE(screen.panel.is_open());
    screen.asked.reset();
    screen.frames();
    CHECK_FALSE(screen.asked);
}

TEST_CASE("a free name is the first that no molecule has", "[ui][add]") {
    AtomDirectory atoms;
    atoms.molecules = {{"w2", {}, 0}, {"w4", {}, 0}};
    CHECK(find_free_name(atoms, "w") == "w3");
    atoms.molecules.push_back({"w3", {}, 0});
    CHECK(find_free_name(atoms, "w") == "w5");
    CHECK(find_free_name(atoms, "v") == "v2");
}

TEST_CASE("what is typed finds a residue, and Down the one below it", "[ui][add]") {
    Dialog screen(peptides());
    std::vector<std::string> names;
    for (const auto& [name, residue] : screen.atoms->force_field->residues) names.push_back(name);
    REQUIRE(names.size() >= 3);
    screen.panel.open(*screen.atoms, "");
    screen.frames();

    SECTION("typed") {
        std::string name = names[2];
        for (char& letter : name) letter = static_cast<char>(std::tolower(letter));
        screen.type_and_enter(name);
        REQUIRE(screen.asked);
        CHECK(screen.asked->residue == names[2]);
    }
    SECTION("chosen") {
        screen.panel.press({Key::Down});
        screen.panel.press({Key::Down});
        screen.panel.press({Key::Up});
        screen.enter();
        REQUIRE(screen.asked);
        CHECK(screen.asked->residue == names[1]);
    }
    SECTION("to the end of the list, and no farther") {
        for (std::size_t i = 0; i < names.size() + 3; ++i) screen.panel.press({Key::Down});
        screen.enter();
        REQUIRE(screen.asked);
        CHECK(screen.asked->residue == names.back());
    }
    SECTION("none of that name") {
        screen.type_and_enter("nothing like that");
        CHECK_FALSE(screen.asked);
        CHECK(screen.panel.is_open());
    }
}

TEST_CASE("a copy is of what is in hand, and has the name that was typed", "[ui][add]") {
    Dialog screen;
    screen.panel.open(*screen.atoms, "moved");
    screen.frames();
    screen.choose(1);

    SECTION("as it is") {
        screen.enter();
        REQUIRE(screen.asked);
        CHECK(*screen.asked == AddEdit{"", "moved", "moved2", {}});
    }
    SECTION("another") {
        screen.panel.press({Key::Up});
        screen.enter();
        REQUIRE(screen.asked);
        CHECK(*screen.asked == AddEdit{"", "fixed", "fixed2", {}});
    }
    SECTION("by another name") {
        screen.enter_name();
        screen.type_and_enter(" the third ");
        REQUIRE(screen.asked);
        CHECK(screen.asked->name == "the third");
    }
    SECTION("names that no molecule can have") {
        const std::string bad = GENERATE("fixed", "a:1", "  ");
        screen.enter_name();
        screen.type_and_enter(bad);
        CHECK_FALSE(screen.asked);
        CHECK(screen.panel.is_open());
    }
}

TEST_CASE("where the force field has no residues, a copy is offered first", "[ui][add]") {
    Dialog screen(read_scene(test::in_project("scenes/hiv")));
    REQUIRE(screen.atoms->force_field->residues.empty());
    screen.panel.open(*screen.atoms, "inhibitor");
    screen.frames();
    screen.enter();
    REQUIRE(screen.asked);
    CHECK(*screen.asked == AddEdit{"", "inhibitor", "inhibitor2", {}});
}

TEST_CASE("files that are dropped are what is added", "[ui][add]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path structure = folder.add_file("My water-1.crd", ""),
                                topology = folder.add_file("system.PSF", "");
    Dialog screen;

    SECTION("a structure and its topology, in any order") {
        screen.panel.open(std::vector<std::filesystem::path>{topology, structure});
        screen.frames();
        screen.enter();
        REQUIRE(screen.asked);
        CHECK(*screen.asked == AddEdit{"", "", "my_water_2", {}, structure, topology, ""});
    }
    SECTION("one after the other") {
        screen.panel.open(std::vector<std::filesystem::path>{structure});
        screen.frames();
        screen.panel.open(std::vector<std::filesystem::path>{topology});
        screen.frames();
        screen.enter();
        REQUIRE(screen.asked);
        CHECK(screen.asked->structure == structure);
        CHECK(screen.asked->topology == topology);
        // The next structure is another one.
        screen.panel.open(std::vector<std::filesystem::path>{structure});
        screen.frames();
        screen.enter();
        CHECK(screen.asked->topology.empty());
    }
    SECTION("a file that is not there") {
        screen.panel.open(std::vector<std::filesystem::path>{folder.path() / "no.crd"});
        screen.frames();
        screen.enter();
        CHECK_FALSE(screen.asked);
        CHECK(screen.panel.is_open());
    }
    SECTION("typed, from the folder of the scene") {
        screen.panel.open(*screen.atoms, "");
        screen.frames();
        screen.choose(2);
        screen.type_and_enter("three.crd");
        REQUIRE(screen.asked);
        CHECK(screen.asked->structure == test::in_project("scenes/water/three.crd"));
        CHECK(screen.asked->name == "three2");
    }
}

TEST_CASE("the dialog has room for what it says, at any size of window and text", "[ui][add]") {
    struct Row {
        ImVec2 size;
        float text_scale;
    };
    const auto row = GENERATE(values<Row>({{{900, 600}, 1},
                                           {{900, 600}, 1.5F},
                                           {{1280, 720}, 1.1F},
                                           {{1600, 1000}, 1.5F},
                                           {{3840, 2160}, 3}}));
    const int origin = GENERATE(0, 1, 2);
    INFO(row.size.x << " x " << row.size.y << ", text " << row.text_scale << ", " << origin);
    Dialog screen(peptides(), row.size, row.text_scale);
    screen.panel.open(*screen.atoms, "");
    screen.frames();
    screen.choose(origin);

    const ImGuiWindow& window = screen.window();
    const ImRect area = window.Rect();
    CHECK(area.Min.x >= 0);
    CHECK(area.Min.y >= 0);
    CHECK(area.Max.x <= row.size.x);
    CHECK(area.Max.y <= row.size.y);
    CHECK_FALSE(window.ScrollbarX);
    CHECK_FALSE(window.ScrollbarY);
    CHECK(window.ContentSize.x <= window.InnerRect.GetWidth());
    CHECK(ImGui::GetFontSize() == Approx(15 * row.text_scale).margin(0.5));
}

TEST_CASE("a click beside the dialog reaches nothing, one on Close closes it", "[ui][add]") {
    Dialog screen;
    screen.panel.open(*screen.atoms, "");
    screen.frames();
    const ImRect area = screen.window().Rect();
    screen.click(20, 20);
    CHECK(ImGui::GetCurrentContext()->HoveredWindow->Name == std::string("##shade"));
    CHECK(screen.panel.is_open());
    // Close stands behind the two that add, at the bottom.
    for (float y = area.Max.y; y > area.Min.y && screen.panel.is_open(); y -= 5)
        screen.click(area.Min.x + 340, y);
    CHECK_FALSE(screen.panel.is_open());
    CHECK_FALSE(screen.asked);
}
