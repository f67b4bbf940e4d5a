// palpa help KEY: what the keys of scene files mean.
#pragma once
#include <string>
#include <vector>

namespace palpa {

// Explains keys by their full name or its last part, tables ("view", or "run." where a command has
// that name), and with "keys" all. Returns false where the first word is none of these; throws
// LoadError with the nearest name where a word is almost a key.
bool print_scene_keys(const std::vector<std::string>& asked);

}  // namespace palpa
