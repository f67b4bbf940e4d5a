// A field for a text of any length.
#pragma once
#include <imgui.h>
#include <string>

namespace palpa {

// As wide as there is room; `hint` is shown while it is empty. Whether the text was changed, or,
// with ImGuiInputTextFlags_EnterReturnsTrue, Enter was pressed.
bool type_text(const char* id, const char* hint, std::string& text, ImGuiInputTextFlags flags = 0);

}  // namespace palpa
