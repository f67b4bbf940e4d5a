// A list of all values of an enumeration.
#pragma once
#include <imgui.h>
#include <cstddef>

namespace palpa {

// A combo over all values of an enumeration; `name`: the shown name of one. True if it was changed.
template <class Choice, class Name>
bool choose(const char* id, std::size_t count, Choice& choice, const Name& name) {
    bool is_changed = false;
    if (!ImGui::BeginCombo(id, name(choice))) return false;
    for (std::size_t i = 0; i < count; ++i) {
        const auto each = static_cast<Choice>(i);
        if (!ImGui::Selectable(name(each), each == choice)) continue;
        is_changed = each != choice;
        choice = each;
    }
    ImGui::EndCombo();
    return is_changed;
}

}  // namespace palpa
