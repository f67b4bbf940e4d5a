#include "devices/force_dimension_library.h"

#include "platform/library.h"

#include <utility>

namespace palpa::dhd {
namespace {

// libdhd.so.3 on Linux, dhd64.dll on Windows.
std::vector<std::string> list_names() {
    std::vector<std::string> names = list_library_files("dhd", {"3"});
    for (std::string& name : list_library_files("dhd64", {})) names.push_back(std::move(name));
    return names;
}

}  // namespace

LibrarySearch find_library(const std::optional<std::filesystem::path>& path) {
    LibrarySearch search;
    Library& l = search.library;
    MakerLibrary library(path, list_names(), search);
    library.take("dhdOpen", l.open);
    library.take("dhdClose", l.close);
    library.take("dhdGetSystemType", l.get_system_type);
    library.take("dhdGetSystemName", l.get_system_name);
    library.take("dhdHasWrist", l.has_wrist);
    library.take("dhdEnableForce", l.enable_force);
    library.take("dhdSetGravityCompensation", l.set_gravity_compensation);
    library.take("dhdEmulateButton", l.emulate_button);
    library.take("dhdGetStatus", l.get_status);
    library.take("dhdGetButtonMask", l.get_button_mask);
    library.take("dhdGetPosition", l.get_position);
    library.take("dhdGetPositionAndOrientationFrame", l.get_position_and_orientation_frame);
    library.take("dhdSetForce", l.set_force);
    library.take("dhdErrorGetLastStr", l.error_get_last_str);
    return search;
}

}  // namespace palpa::dhd
