#include "platform/system.h"

#include <windows.h>

namespace palpa {

std::string_view system_name() noexcept { return "Windows"; }

bool has_display() { return true; }

// It comes with the graphics driver, and a program may start without it.
bool has_vulkan() noexcept { return LoadLibraryW(L"vulkan-1.dll") != nullptr; }

std::string_view vulkan_remedy() noexcept {
    return "install the newest driver of the graphics card from its maker's site";
}

std::string_view usb_list_name() noexcept { return "the Device Manager"; }
std::string_view hidapi_remedy() noexcept {
    return "start the program again; if that does not help, report it";
}

}  // namespace palpa
