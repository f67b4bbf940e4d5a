#include "ui/colours.h"

namespace palpa {
namespace {

constexpr Colours light{.hand = IM_COL32(20, 90, 190, 255),
                        .molecule = IM_COL32(190, 40, 40, 255),
                        .gain = IM_COL32(20, 130, 70, 255),
                        .energy = IM_COL32(110, 70, 160, 255),
                        .now = IM_COL32(250, 170, 0, 255),
                        .task = IM_COL32(20, 90, 190, 255),
                        .done = IM_COL32(20, 130, 70, 255),
                        .wrong = IM_COL32(165, 40, 15, 255),
                        .ink = IM_COL32(25, 30, 40, 255),
                        .halo = IM_COL32(255, 255, 255, 140),
                        .ground = IM_COL32(255, 255, 255, 200),
                        .selection = IM_COL32(190, 0, 120, 255),
                        .background = {0.86F, 0.89F, 0.93F}};

constexpr Colours dark{.hand = IM_COL32(100, 170, 255, 255),
                       .molecule = IM_COL32(255, 120, 100, 255),
                       .gain = IM_COL32(100, 210, 140, 255),
                       .energy = IM_COL32(190, 150, 240, 255),
                       .now = IM_COL32(255, 190, 40, 255),
                       .task = IM_COL32(130, 190, 255, 255),
                       .done = IM_COL32(110, 215, 150, 255),
                       .wrong = IM_COL32(255, 140, 110, 255),
                       .ink = IM_COL32(235, 238, 245, 255),
                       .halo = IM_COL32(15, 18, 25, 150),
                       .ground = IM_COL32(30, 34, 42, 210),
                       .selection = IM_COL32(255, 90, 190, 255),
                       .background = {0.020F, 0.024F, 0.032F}};

bool is_dark = false;

}  // namespace

const Colours& colours() noexcept { return is_dark ? dark : light; }

bool is_dark_theme() noexcept { return is_dark; }

void choose_theme(bool wants_dark) {
    is_dark = wants_dark;
    if (ImGui::GetCurrentContext()) set_theme_colours();
}

void set_theme_colours() {
    ImVec4* const colour = ImGui::GetStyle().Colors;
    if (is_dark) {
        ImGui::StyleColorsDark();
        colour[ImGuiCol_WindowBg] = {0.10F, 0.11F, 0.13F, 1};
        colour[ImGuiCol_PopupBg] = {0.13F, 0.14F, 0.17F, 0.98F};
        colour[ImGuiCol_MenuBarBg] = {0.14F, 0.15F, 0.18F, 1};
        colour[ImGuiCol_TitleBg] = colour[ImGuiCol_TitleBgActive] = {0.16F, 0.18F, 0.22F, 1};
        colour[ImGuiCol_FrameBg] = {0.19F, 0.21F, 0.25F, 1};
        return;
    }
    ImGui::StyleColorsLight();
    colour[ImGuiCol_WindowBg] = {1, 1, 1, 1};
    colour[ImGuiCol_PopupBg] = {1, 1, 0.96F, 0.98F};
    colour[ImGuiCol_TitleBg] = colour[ImGuiCol_TitleBgActive] = {0.86F, 0.90F, 0.95F, 0.95F};
    colour[ImGuiCol_FrameBg] = {0.90F, 0.92F, 0.95F, 1};
}

}  // namespace palpa
