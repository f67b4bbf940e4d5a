#include "ui/view_labels.h"

#include <imgui.h>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace palpa;

namespace {

// Vertices that these labels take, seen from (0, 0, 10).
int vertices(const std::vector<ViewLabel>& labels) {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {1280, 800};
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    ImGui::NewFrame();
    draw_view_labels(labels, {});
    ImGui::Render();
    const int count = ImGui::GetDrawData()->TotalVtxCount;
    ImGui::DestroyContext();
    return count;
}

}  // namespace

TEST_CASE("labels are written where they are seen, ticks only where there is room",
          "[ui][labels]") {
    const ViewLabel force{{0, 0, 0}, "1.25 nN"}, elsewhere{{2, 0, 0}, "1.25 nN"};
    const ViewLabel tick{{0.1F, 0, 0}, "1.25 nN", true}, far_tick{{-2, 0, 0}, "1.25 nN", true};
    const int one = vertices({force});

    CHECK(one > 0);
    CHECK(vertices({}) == 0);
    CHECK(vertices({force, elsewhere}) == 2 * one);
    CHECK(vertices({force, far_tick}) == 2 * one);
    CHECK(vertices({tick, force}) == one);
    CHECK(vertices({{{0, 0, 20}, "behind the camera"}}) == 0);
}
