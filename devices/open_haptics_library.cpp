#include "devices/open_haptics_library.h"

#include <fmt/format.h>
#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif
#include <array>

namespace palpa::hd {
namespace {

#ifdef _WIN32
constexpr std::array names{"HD.dll"};
using Loaded = HMODULE;

Loaded load(const std::string& name, std::string& why) {
    const Loaded loaded = LoadLibraryA(name.c_str());
    if (!loaded) why = fmt::format("{}: Windows' error {}", name, GetLastError());
    return loaded;
}

void* find(Loaded loaded, const char* function) {
    return reinterpret_cast<void*>(GetProcAddress(loaded, function));
}

std::string path_of(Loaded loaded, void*) {
    std::array<char, MAX_PATH> path{};
    GetModuleFileNameA(loaded, path.data(), static_cast<DWORD>(path.size()));
    return path.data();
}
#else
// As the maker's packages of 3.4 and 3.0 name it.
constexpr std::array names{"libHD.so", "libHD.so.3.4", "libHD.so.3.4.0", "libHD.so.3",
                           "libHD.so.3.0"};
using Loaded = void*;

Loaded load(const std::string& name, std::string& why) {
    const Loaded loaded = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!loaded) why = dlerror();  // begins with the name
    return loaded;
}

void* find(Loaded loaded, const char* function) { return dlsym(loaded, function); }

std::string path_of(Loaded, void* function) {
    Dl_info info{};
    return dladdr(function, &info) != 0 && info.dli_fname ? info.dli_fname : "";
}
#endif

template <class Function>
void take(Loaded loaded, const char* name, Function& function, LibrarySearch& search) {
    void* const found = find(loaded, name);
    if (!found) {
        search.missing.emplace_back(name);
        return;
    }
    function = reinterpret_cast<Function>(found);
    if (search.path.empty()) search.path = path_of(loaded, found);
}

}  // namespace

LibrarySearch find_library(const std::optional<std::filesystem::path>& path) {
    std::vector<std::string> candidates(names.begin(), names.end());
    if (path) candidates = {path->string()};
    LibrarySearch search;
    Loaded loaded = nullptr;
    for (const std::string& name : candidates) {
        std::string why;
        loaded = load(name, why);
        if (loaded) break;
        search.tried.push_back(why);
    }
    if (!loaded) return search;

    search.is_found = true;
    Library& l = search.library;
    take(loaded, "hdInitDevice", l.init_device, search);
    take(loaded, "hdDisableDevice", l.disable_device, search);
    take(loaded, "hdGetCurrentDevice", l.get_current_device, search);
    take(loaded, "hdMakeCurrentDevice", l.make_current_device, search);
    take(loaded, "hdBeginFrame", l.begin_frame, search);
    take(loaded, "hdEndFrame", l.end_frame, search);
    take(loaded, "hdGetError", l.get_error, search);
    take(loaded, "hdEnable", l.enable, search);
    take(loaded, "hdDisable", l.disable, search);
    take(loaded, "hdGetIntegerv", l.get_integerv, search);
    take(loaded, "hdGetDoublev", l.get_doublev, search);
    take(loaded, "hdGetString", l.get_string, search);
    take(loaded, "hdSetDoublev", l.set_doublev, search);
    take(loaded, "hdCheckCalibration", l.check_calibration, search);
    take(loaded, "hdUpdateCalibration", l.update_calibration, search);
    take(loaded, "hdSetSchedulerRate", l.set_scheduler_rate, search);
    take(loaded, "hdStartScheduler", l.start_scheduler, search);
    take(loaded, "hdStopScheduler", l.stop_scheduler, search);
    take(loaded, "hdScheduleAsynchronous", l.schedule_asynchronous, search);
    take(loaded, "hdUnschedule", l.unschedule, search);
    return search;
}

ErrorWords words(Code error) noexcept {
    switch (error) {
        case success:
            return {};
        case warm_motors:
            return {"the motors are too warm",
                    "let the device rest for some minutes; the force returns by itself, smaller"};
        case exceeded_max_force:
            return {"the force was larger than the device allows", "choose a smaller force gain"};
        case exceeded_force_impulse:
            return {"the force changed faster than the device allows",
                    "choose a smaller force gain or a softer coupling"};
        case exceeded_max_velocity:
            return {"the handle was faster than the device allows",
                    "hold the handle, and move it slowly"};
        case force_error:
            return {"the device could not play the force",
                    "switch the device off and on; run its maker's diagnostic"};
        case device_fault:
            return {"the device reports a fault or is not there",
                    "check power and cable, then run its maker's set-up and diagnostic"};
        case already_initiated:
            return {"the device is in use", "end the other program that uses it"};
        case comm_error:
            return {"the device does not answer",
                    "check the cable; a Touch wants a port of the computer, not of a hub"};
        case comm_config_error:
            return {"the connection is not set up",
                    "run the maker's set-up program, which pairs the device with its name"};
        case timer_error:
            return {"the maker's scheduler got no clock", "end other programs and start again"};
        case bad_handle:
            return {"there is no device of that name",
                    "run the maker's set-up program, and see which names it knows"};
        case invalid_licence:
            return {"the maker's library has no licence",
                    "install the Developer Edition of OpenHaptics, which needs none"};
        case scheduler_full:
        case invalid_priority:
            return {"the maker's scheduler takes no more callbacks", "start the program again"};
        case invalid_enum:
        case invalid_value:
        case invalid_operation:
        case invalid_input_type:
            return {"the maker's library does not know what it was asked",
                    "install OpenHaptics 3.4 or newer"};
        case illegal_begin:
        case illegal_end:
        case frame_error:
            return {"a tick of the device was not finished", "start the program again"};
        default:
            return {"an error that is not documented", "run the maker's diagnostic"};
    }
}

}  // namespace palpa::hd
