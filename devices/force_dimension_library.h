// Force Dimension's device library (DHD), the maker's own for omega, delta, sigma and lambda, and
// for Novint's Falcon, found while the program runs. What it exports is declared here from the
// documented interface: names, types and numbers. It is thread-safe, and serves several devices.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa::dhd {

using Id = char;  // of an open device, from 0

inline constexpr int on = 1, off = 0;

// types of devices
inline constexpr int omega_3 = 33, omega_6 = 34, omega_6_left = 36, omega_7 = 35, omega_7_left = 37,
                     falcon = 60, delta_3 = 63, delta_6 = 64, sigma_7 = 104, sigma_7_left = 105;

// entries of the status, of which releases of the library have 15 and more
inline constexpr int most_status = 64;
inline constexpr int status_reset = 3, status_force = 5, status_force_off_cause = 14;
inline constexpr int off_by_button = 1;

// The functions that are used: each is the library's dhdX, in its order of arguments. Those that
// answer an int say less than 0 where they failed.
struct Library {
    int (*open)() = nullptr;  // the next one that nobody has open; its Id
    int (*close)(Id) = nullptr;
    int (*get_system_type)(Id) = nullptr;
    const char* (*get_system_name)(Id) = nullptr;
    bool (*has_wrist)(Id) = nullptr;
    int (*enable_force)(unsigned char value, Id) = nullptr;
    int (*set_gravity_compensation)(int value, Id) = nullptr;
    int (*emulate_button)(unsigned char value, Id) = nullptr;  // by the gripper
    int (*get_status)(int* status, Id) = nullptr;
    unsigned int (*get_button_mask)(Id) = nullptr;
    int (*get_position)(double* x, double* y, double* z, Id) = nullptr;  // m
    // And the axes of the handle, which are the columns.
    int (*get_position_and_orientation_frame)(double* x, double* y, double* z, double (*axes)[3],
                                              Id) = nullptr;
    int (*set_force)(double x, double y, double z, Id) = nullptr;  // N
    const char* (*error_get_last_str)() = nullptr;                 // of this thread
};

struct LibrarySearch {
    bool is_found = false;
    Library library;                   // complete if nothing is missing
    std::string path;                  // where it was found
    std::vector<std::string> tried;    // each with why it could not be loaded
    std::vector<std::string> missing;  // functions
};

// Tries `path` alone if there is one, otherwise the names under which the library is installed. It
// stays loaded for ever.
LibrarySearch find_library(const std::optional<std::filesystem::path>& path);

}  // namespace palpa::dhd
