#include "devices/force_dimension_library.h"

#include "platform/library.h"

#include <utility>

namespace palpa::dhd {
namespace {

template <class Function>
void take(const SharedLibrary& loaded, const char* name, Function& function,
          LibrarySearch& search) {
    void* const found = loaded.find(name);
    if (!found) {
        search.missing.emplace_back(name);
        return;
    }
    function = reinterpret_cast<Function>(found);
    if (search.path.empty()) search.path = loaded.path_of(found);
}

// libdhd.so.3 on Linux, dhd64.dll on Windows.
std::vector<std::string> list_names() {
    std::vector<std::string> names = list_library_files("dhd", {"3"});
    for (std::string& name : list_library_files("dhd64", {})) names.push_back(std::move(name));
    return names;
}

}  // namespace

LibrarySearch find_library(const std::optional<std::filesystem::path>& path) {
    LibrarySearch search;
    std::optional<SharedLibrary> found;
    for (const std::string& file : path ? std::vector{path->string()} : list_names()) {
        found.emplace(file);
        if (found->is_open()) break;
        search.tried.push_back(found->problem());
        found.reset();
    }
    if (!found) return search;
    const SharedLibrary& loaded = *found;

    search.is_found = true;
    Library& l = search.library;
    take(loaded, "dhdOpen", l.open, search);
    take(loaded, "dhdClose", l.close, search);
    take(loaded, "dhdGetSystemType", l.get_system_type, search);
    take(loaded, "dhdGetSystemName", l.get_system_name, search);
    take(loaded, "dhdHasWrist", l.has_wrist, search);
    take(loaded, "dhdEnableForce", l.enable_force, search);
    take(loaded, "dhdSetGravityCompensation", l.set_gravity_compensation, search);
    take(loaded, "dhdEmulateButton", l.emulate_button, search);
    take(loaded, "dhdGetStatus", l.get_status, search);
    take(loaded, "dhdGetButtonMask", l.get_button_mask, search);
    take(loaded, "dhdGetPosition", l.get_position, search);
    take(loaded, "dhdGetPositionAndOrientationFrame", l.get_position_and_orientation_frame, search);
    take(loaded, "dhdSetForce", l.set_force, search);
    take(loaded, "dhdErrorGetLastStr", l.error_get_last_str, search);
    return search;
}

}  // namespace palpa::dhd
