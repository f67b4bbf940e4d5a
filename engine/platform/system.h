// Names the system and its parts for messages that advise its user.
#pragma once
#include <string_view>

namespace palpa {

std::string_view system_name() noexcept;  // "Linux", "Windows" or "macOS"

// Returns whether there is a display to open a window on.
bool has_display();

// Returns whether the system has the library that drawing needs (Vulkan's loader).
bool has_vulkan() noexcept;
// Returns advice for a system without a driver.
std::string_view vulkan_remedy() noexcept;

// The name of what lists USB devices, as in "{} shows it": "'lsusb'".
std::string_view usb_list_name() noexcept;

// Returns advice where the library for SpaceMouse and game pads does not start.
std::string_view hidapi_remedy() noexcept;

}  // namespace palpa
