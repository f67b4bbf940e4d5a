#include "ui/readings.h"

#include "ui/layout.h"

#include <imgui.h>

namespace palpa {

bool begin_readings(const char* id) {
    if (!ImGui::BeginTable(id, 2)) return false;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, scaled(105));
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

void add_reading(const char* name, const std::string& value, const char* explanation) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    tip(explanation);
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", value.c_str());
    tip(explanation);
}

}  // namespace palpa
