#include "platform/display.h"

#include <cstdlib>

namespace palpa {

bool has_display() {
#ifdef __APPLE__
    return true;
#else
    const auto is_named = [](const char* variable) {
        const char* const value = std::getenv(variable);
        return value && *value != 0;
    };
    return is_named("DISPLAY") || is_named("WAYLAND_DISPLAY");
#endif
}

}  // namespace palpa
