// Saves screenshots of the window under unused names.
#pragma once
#include "gpu/swapchain.h"

#include <filesystem>

namespace palpa {

// Saves palpa-0001.png and so on in the folder; returns the file. Throws LoadError.
std::filesystem::path save_screenshot(const std::filesystem::path& folder, const WindowShot& shot);

}  // namespace palpa
