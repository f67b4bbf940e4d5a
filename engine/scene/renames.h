// Names that scene files of format 1 had, and what they are in format 2: the tables of all of them
// are in renames.cpp.
#pragma once
#include <string_view>

namespace palpa {

// The last part of what a key was called: "colouring" for "view.colour". Empty where it had no
// other name. `table`: the tables that it is in, with a dot at the end, "edits[2].appearance.".
std::string_view find_key_before(std::string_view table, std::string_view key);

// What a value of a choice is called now: "acceleration" for "plain" of "statics.weights". Empty
// where it is no old name.
std::string_view find_value_now(std::string_view key, std::string_view value);

}  // namespace palpa
