// What a system is called, has and offers, for messages that advise its user.
#pragma once
#include <string_view>

namespace palpa {

std::string_view system_name() noexcept;  // "Linux", "Windows" or "macOS"

// Whether there is a display to open a window on.
bool has_display();

// Whether the system has the library that drawing needs (Vulkan's loader), and what to do without a
// driver.
bool has_vulkan() noexcept;
std::string_view vulkan_remedy() noexcept;

// The system's list of USB devices, as in "{} shows it": "'lsusb'".
std::string_view usb_list_name() noexcept;

// What to do where the library for SpaceMouse and game pads does not start.
std::string_view hidapi_remedy() noexcept;

}  // namespace palpa
