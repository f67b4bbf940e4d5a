// Force Dimension's device library (DHD), the maker's own for omega, delta, sigma and lambda, and
// for Novint's Falcon, found while the program runs. What it exports is declared here from the
// documented interface: names, types and numbers. It is thread-safe, and serves several devices.
#pragma once
#include "devices/maker_library.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa::dhd {

using Id = char;  // number of an open device, from 0

inline constexpr int on = 1, off = 0;

// types of devices
inline constexpr int omega_3 = 33, omega_6 = 34, omega_6_left = 36, omega_7 = 35, omega_7_left = 37,
                     falcon = 60, delta_3 = 63, delta_6 = 64, sigma_7 = 104, sigma_7_left = 105;

// number of status entries; releases of the library have 15 or more
inline constexpr int most_status = 64;
inline constexpr int status_reset = 3, status_force = 5, status_force_off_cause = 14;
inline constexpr int off_by_button = 1;

// The functions in use: each is the library's dhdX with the same order of arguments. Those that
// return an int return a negative value on failure.
struct Library {
    int (*open)() = nullptr;  // opens the next free device; returns its Id
    int (*close)(Id) = nullptr;
    int (*get_system_type)(Id) = nullptr;
    const char* (*get_system_name)(Id) = nullptr;
    bool (*has_wrist)(Id) = nullptr;
    int (*enable_force)(unsigned char value, Id) = nullptr;
    int (*set_gravity_compensation)(int value, Id) = nullptr;
    int (*emulate_button)(unsigned char value, Id) = nullptr;  // button pressed by the gripper
    int (*get_status)(int* status, Id) = nullptr;
    unsigned int (*get_button_mask)(Id) = nullptr;
    int (*get_position)(double* x, double* y, double* z, Id) = nullptr;  // m
    // Also the axes of the handle, as columns.
    int (*get_position_and_orientation_frame)(double* x, double* y, double* z, double (*axes)[3],
                                              Id) = nullptr;
    int (*set_force)(double x, double y, double z, Id) = nullptr;  // N
    const char* (*error_get_last_str)() = nullptr;                 // last error of this thread
};

struct LibrarySearch : palpa::LibrarySearch {
    Library library;  // complete if `missing` is empty
};

// Loads `path` if it is given, otherwise tries the names under which the library is installed. The
// library stays loaded until the program ends.
LibrarySearch find_library(const std::optional<std::filesystem::path>& path);

}  // namespace palpa::dhd
