// Interface to OpenHaptics' device library (HDAPI) of the maker of the Phantom Omni and the Touch,
// loaded at run time. Its names, types and numbers are declared here from the documented interface.
// It has one scheduler and one current device for each process.
#pragma once
#include "devices/maker_library.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::hd {

using Code = unsigned int;  // errors, parameters, capabilities, what a callback returns
using Handle = unsigned int;
using Schedule = unsigned long;
using Callback = Code (*)(void*);

struct ErrorInfo {
    Code code;
    int internal_code;
    Handle device;
};

inline constexpr Handle no_device = 0xFFFFFFFF;

// errors
inline constexpr Code success = 0, invalid_enum = 0x100, invalid_value = 0x101,
                      invalid_operation = 0x102, invalid_input_type = 0x103, bad_handle = 0x104,
                      warm_motors = 0x200, exceeded_max_force = 0x201,
                      exceeded_force_impulse = 0x202, exceeded_max_velocity = 0x203,
                      force_error = 0x204, device_fault = 0x300, already_initiated = 0x301,
                      comm_error = 0x302, comm_config_error = 0x303, timer_error = 0x304,
                      illegal_begin = 0x400, illegal_end = 0x401, frame_error = 0x402,
                      invalid_priority = 0x500, scheduler_full = 0x501, invalid_licence = 0x600;

// parameters, with how many values they have
inline constexpr Code current_buttons = 0x2000,   // 1 int, a bit a button
    current_transform = 0x2052,                   // 16 doubles, column after column; mm
    model_type = 0x2501, serial_number = 0x2504,  // text
    usable_workspace = 0x2551,                    // 6 doubles, lowest corner, highest corner; mm
    calibration_styles = 0x2555,                  // 1 int, a bit a style
    update_rate = 0x2600,                         // 1 int, Hz
    nominal_max_stiffness = 0x2602,               // 1 double, N/mm
    nominal_max_force = 0x2603, nominal_max_continuous_force = 0x2604,  // 1 double, N
    motor_temperature = 0x2605,  // 6 doubles, 0 cold, 1 the hottest
    current_force = 0x2700;      // 3 doubles, N

// capabilities
inline constexpr Code force_output = 0x4000, max_force_clamping = 0x4001;

// calibration: its state, and the ways that a device has
inline constexpr Code calibration_ok = 0x5000, calibration_needs_update = 0x5001,
                      calibration_needs_hand = 0x5002;
inline constexpr Code encoder_reset = 1, automatic = 2, inkwell = 4;

inline constexpr Code callback_done = 0, callback_continue = 1;

// The functions that are used: init_device is the library's hdInitDevice, and so on.
struct Library {
    Handle (*init_device)(const char* name) = nullptr;
    void (*disable_device)(Handle) = nullptr;
    Handle (*get_current_device)() = nullptr;
    void (*make_current_device)(Handle) = nullptr;
    void (*begin_frame)(Handle) = nullptr;
    void (*end_frame)(Handle) = nullptr;
    ErrorInfo (*get_error)() = nullptr;
    void (*enable)(Code) = nullptr;
    void (*disable)(Code) = nullptr;
    void (*get_integerv)(Code, int*) = nullptr;
    void (*get_doublev)(Code, double*) = nullptr;
    const char* (*get_string)(Code) = nullptr;
    void (*set_doublev)(Code, const double*) = nullptr;
    Code (*check_calibration)() = nullptr;
    void (*update_calibration)(Code style) = nullptr;
    void (*set_scheduler_rate)(unsigned long rate_hz) = nullptr;
    void (*start_scheduler)() = nullptr;
    void (*stop_scheduler)() = nullptr;
    Schedule (*schedule_asynchronous)(Callback, void*, unsigned short priority) = nullptr;
    void (*unschedule)(Schedule) = nullptr;
};

struct LibrarySearch : palpa::LibrarySearch {
    Library library;  // complete if `missing` is empty
};

// Tries `path` alone if there is one, otherwise the names under which the library is installed. It
// stays loaded for ever: its threads may outlive every device.
LibrarySearch find_library(const std::optional<std::filesystem::path>& path);

// What went wrong, and what the person can do about it; without full stop.
struct ErrorWords {
    std::string_view what, remedy;
};
ErrorWords describe(Code error) noexcept;

}  // namespace palpa::hd
