// palpa help KEY: what the keys of scene files mean.
#pragma once
#include <string>
#include <vector>

namespace palpa {

// Of keys by their full name or its last part, of tables, or of "keys", all of them. Returns false
// where a word is neither; throws LoadError with the nearest name where it has a point.
bool print_scene_keys(const std::vector<std::string>& asked);

}  // namespace palpa
