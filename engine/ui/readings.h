// A table of readings: names, values, and explanations on hovering.
#pragma once
#include <string>

namespace palpa {

// Begins a table; false if it is not seen. End it by ImGui::EndTable.
bool begin_readings(const char* id);
// A row: a name, a value, and what it is when the mouse rests on it.
void add_reading(const char* name, const std::string& value, const char* explanation);

}  // namespace palpa
