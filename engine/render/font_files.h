// Finds fonts for text in pictures.
#pragma once
#include <filesystem>
#include <vector>

namespace palpa {

// Font files that are there, the best first: of the usual ones of each system, whose letters are
// Latin and Greek and have the signs of formulas. The environment's PALPA_FONT names a file to take
// instead of all these.
std::vector<std::filesystem::path> list_font_files();

}  // namespace palpa
