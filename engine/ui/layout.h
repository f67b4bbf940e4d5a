// Positions and sizes of panels for any size of window and text.
#pragma once
#include <imgui.h>
#include <algorithm>
#include <string>

namespace palpa {

// A rectangle of the window, pixels from the upper left corner.
struct ScreenArea {
    float left = 0, top = 0, right = 0, bottom = 0;

    float width() const noexcept { return right - left; }
    float height() const noexcept { return bottom - top; }
};

inline constexpr float usual_text = 15;  // height of a line of text at normal size, pixels

// Converts a length at the normal text size to the present one.
inline float scaled(float pixels) { return pixels * ImGui::GetFontSize() / usual_text; }

inline float panel_edge() { return scaled(10); }  // margin around the panels

// Width of the side panels for this width of the window.
inline float panel_column(float window_width) {
    return std::min(std::clamp(0.3F * window_width, scaled(240), scaled(350)), 0.4F * window_width);
}

inline constexpr ImGuiWindowFlags fixed_panel =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings;

// Collapses the next panel when the window becomes so small that panels would cover half of the
// picture, and expands it when the window becomes larger again. A person may change that in
// between. `folds`: state of the panel from the frame before.
void fold_in_small_window(bool& folds);

// Shows a tooltip for the previous item.
void tip(const char* text);

// The text of a button or the title of a panel in the window's language. Its ID, and the name for
// ImGui::FindWindowByName, are the same in all languages.
std::string labelled(const char* english);

// Continues on the line of the previous item if a button with this text fits there.
void same_line_if_it_fits(const char* text);

// Dims everything and blocks clicks, except for windows brought to the front afterwards.
void draw_shade();

}  // namespace palpa
