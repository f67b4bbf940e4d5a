// Where panels go and how large they are, in a window of any size and with text of any size.
#pragma once
#include <imgui.h>
#include <algorithm>
#include <string>

namespace palpa {

// A rectangle of the window, pixels from the upper left.
struct ScreenArea {
    float left = 0, top = 0, right = 0, bottom = 0;

    float width() const noexcept { return right - left; }
    float height() const noexcept { return bottom - top; }
};

inline constexpr float usual_text = 15;  // pixels of a line of text at the usual size

// What a length at the usual size of the text is at the present one.
inline float scaled(float pixels) { return pixels * ImGui::GetFontSize() / usual_text; }

inline float panel_edge() { return scaled(10); }  // around the panels

// Width of the panels at either side of a window that wide.
inline float panel_column(float window_width) {
    return std::min(std::clamp(0.3F * window_width, scaled(240), scaled(350)), 0.4F * window_width);
}

inline constexpr ImGuiWindowFlags fixed_panel =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings;

// Folds the panel that begins next where the window gets so small that panels would cover half of
// the picture, and unfolds it where it gets larger again; a person may do otherwise in between.
// `folds`: the panel's, as of the frame before.
void fold_in_small_window(bool& folds);

// The explanation of the item before, while the mouse rests on it.
void tip(const char* text);

// The text of a button or the title of a panel in the window's language. Its ID, and the name by
// which ImGui::FindWindowByName knows the panel, are the same in each.
std::string labelled(const char* english);

// On the line of the item before where a button with this text has room there.
void same_line_if_it_fits(const char* text);

// A shade over everything, so that nothing behind it can be clicked; below what is brought to the
// front after it.
void draw_shade();

}  // namespace palpa
