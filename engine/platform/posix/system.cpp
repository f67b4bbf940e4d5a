#include "platform/system.h"

#include <cstdlib>

namespace palpa {

#ifdef __APPLE__

std::string_view system_name() noexcept { return "macOS"; }
bool has_display() { return true; }
std::string_view vulkan_remedy() noexcept { return "install the Vulkan SDK, which has MoltenVK"; }
std::string_view usb_list_name() noexcept { return "System Information"; }
std::string_view hidapi_remedy() noexcept { return "install hidapi"; }

#else

std::string_view system_name() noexcept { return "Linux"; }

bool has_display() {
    const auto is_named = [](const char* variable) {
        const char* const value = std::getenv(variable);
        return value && *value != 0;
    };
    return is_named("DISPLAY") || is_named("WAYLAND_DISPLAY");
}

std::string_view vulkan_remedy() noexcept {
    return "install a driver (Debian: mesa-vulkan-drivers)";
}

std::string_view usb_list_name() noexcept { return "'lsusb'"; }
std::string_view hidapi_remedy() noexcept { return "install libhidapi-hidraw0"; }

#endif

// The program is linked with it, and would not have started.
bool has_vulkan() noexcept { return true; }

}  // namespace palpa
