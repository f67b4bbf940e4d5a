// A text field without a length limit.
#pragma once
#include <imgui.h>
#include <string>

namespace palpa {

// Uses the available width; `hint` is shown while the field is empty. Returns true if the text was
// changed, or, with ImGuiInputTextFlags_EnterReturnsTrue, if Enter was pressed.
bool type_text(const char* id, const char* hint, std::string& text, ImGuiInputTextFlags flags = 0);

}  // namespace palpa
