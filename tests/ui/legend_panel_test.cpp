#include "ui/legend_panel.h"

#include "render/picture.h"

#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <vector>

using namespace palpa;

namespace {

struct Drawn {
    bool is_there = false;
    ImRect box;
    std::vector<ImU32> colours;  // of all vertices of the panel
};

Drawn draw(const std::vector<LegendEntry>& legend, const ScreenArea& area) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {1280, 800};
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    for (int i = 0; i < 3; ++i) {  // it finds its size
        ImGui::NewFrame();
        draw_legend_panel(legend, area);
        ImGui::Render();
    }
    Drawn drawn;
    if (const ImGuiWindow* const window = ImGui::FindWindowByName("##legend")) {
        drawn.is_there = window->Active;
        drawn.box = window->Rect();
        for (const ImDrawVert& vertex : window->DrawList->VtxBuffer)
            drawn.colours.push_back(vertex.col);
        CHECK((window->Flags & ImGuiWindowFlags_NoMouseInputs) != 0);
    }
    ImGui::DestroyContext();
    return drawn;
}

std::ptrdiff_t count(const Drawn& drawn, ImU32 colour) {
    return std::count(drawn.colours.begin(), drawn.colours.end(), colour);
}

}  // namespace

TEST_CASE("the legend stands in the lower left corner, a square for each colour", "[ui][legend]") {
    const ScreenArea area{300, 40, 980, 620};

    const Drawn drawn = draw({{{1, 0, 0}, "helix"}, {{0, 0.5F, 0}, "strand"}}, area);

    REQUIRE(drawn.is_there);
    CHECK(drawn.box.Min.x >= 300);
    CHECK(drawn.box.Min.x <= 310);
    CHECK(drawn.box.Max.y <= 620);
    CHECK(drawn.box.Max.y > 600);
    CHECK(drawn.box.GetWidth() < 150);
    CHECK(count(drawn, IM_COL32(255, 0, 0, 255)) >= 4);
    CHECK(count(drawn, IM_COL32(0, srgb_code(0.5F), 0, 255)) >= 4);
}

TEST_CASE("colours that are seen without a legend have none", "[ui][legend]") {
    CHECK_FALSE(draw({}, {300, 40, 980, 620}).is_there);
}
