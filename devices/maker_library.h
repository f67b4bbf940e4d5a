// Finds the library of a device's maker at run time, and checks what such devices need.
#pragma once
#include "devices/device_check.h"
#include "devices/device_nodes.h"
#include "platform/library.h"

#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
// No handle reaches further from its base; a reading that says so is not valid.
inline constexpr double farthest_reading_m = 1;

struct LibrarySearch {
    bool is_found = false;
    std::string path;                  // where it was found; its name if that is not known
    std::vector<std::string> tried;    // names tried, each with the reason of the failure
    std::vector<std::string> missing;  // names of missing functions
};

// The first library of a list that can be loaded. It stays loaded until the program ends: its
// threads may outlive every device.
class MakerLibrary {
public:
    // Tries `path` alone if it is given, otherwise `names`. `search` receives the result and has to
    // outlive this.
    MakerLibrary(const std::optional<std::filesystem::path>& path, std::vector<std::string> names,
                 LibrarySearch& search);

    // Sets `function` to the function of this name, or adds the name to the missing ones. Does
    // nothing if no library was found.
    template <class Function>
    void take(const char* name, Function& function) {
        if (loaded_) function = reinterpret_cast<Function>(find(name));
    }

private:
    void* find(const char* name);

    LibrarySearch& search_;
    std::optional<SharedLibrary> loaded_;
    bool is_located_ = false;  // search_.path is that of a function found in it
};

DeviceCheck check_library(const LibrarySearch& search, std::string remedy);
// `remedy` says which version has all functions.
DeviceCheck check_symbols(const LibrarySearch& search, std::string remedy);

// Adds the checks "bus" and "permission" of devices that were found in the system's folders, or
// `none` if there are none. None of these prevents the use: some devices are not shown there.
void add_bus_checks(std::span<const FoundDevice> found, DeviceCheck none,
                    std::vector<DeviceCheck>& checks);

}  // namespace palpa
