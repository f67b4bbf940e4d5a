#include "ui/language_list.h"

#include <imgui.h>
#include <algorithm>
#include <string_view>

namespace palpa {

std::optional<std::string> draw_language_list(std::span<const Language> languages) {
    if (languages.size() < 2) return std::nullopt;
    // Whoever chose a wrong one finds the way back by the English word.
    constexpr const char* english = "Language";
    const std::string_view heading = translated("Language");
    ImGui::TextUnformatted(heading.data());
    if (heading != english) {
        ImGui::SameLine();
        ImGui::TextDisabled("%s", english);
    }
    std::optional<std::string> chosen;
    const std::string code = language_in_use();
    const auto present = std::ranges::find(languages, code, &Language::code);
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##language", present == languages.end() ? "" : present->name.c_str()))
        return std::nullopt;
    for (const Language& language : languages) {
        if (ImGui::Selectable(language.name.c_str(), language.code == code)) chosen = language.code;
    }
    ImGui::EndCombo();
    return chosen;
}

}  // namespace palpa
