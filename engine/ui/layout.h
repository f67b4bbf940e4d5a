// Positions and sizes of panels for any size of window and text.
#pragma once
#include <imgui.h>
#include <string>
#include <string_view>

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

inline constexpr ImGuiWindowFlags fixed_panel =
    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings;

// A button without a frame that shows an icon (ui/icons.h); `id` tells it from others. `is_on`: it
// is drawn pressed.
bool icon_button(const char* icon, const char* id, const ImVec2& size = {0, 0}, bool is_on = false);

// Shows a tooltip for the previous item.
void tip(const char* text);

// The text of a button or the title of a panel in the window's language. Its ID, and the name for
// ImGui::FindWindowByName, are the same in all languages.
std::string labelled(const char* english);

// Writes a text that may be wider than the window on several lines, which break at spaces alone:
// "0.5 nN" stays a number.
void write_wrapped(std::string_view text);

// Continues on the line of the previous item if a button with this text fits there.
void same_line_if_it_fits(const char* text);

// Dims everything and blocks clicks, except for windows brought to the front afterwards.
void draw_shade();

}  // namespace palpa
