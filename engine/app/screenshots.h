// Unused names for what the window saves, and its screenshots.
#pragma once
#include "gpu/swapchain.h"

#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

// The first of palpa-0001.png and so on, with `start` "palpa", for which nothing with one of the
// endings is there; it has the first ending. Makes the folder. Throws LoadError.
std::filesystem::path find_free_name(const std::filesystem::path& folder, const std::string& start,
                                     const std::vector<std::string>& endings);

// Saves palpa-0001.png and so on in the folder; returns the file. Throws LoadError.
std::filesystem::path save_screenshot(const std::filesystem::path& folder, const WindowShot& shot);

}  // namespace palpa
