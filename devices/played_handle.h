// Handles that follow a table of times and positions: a recorded trace, or a script. Nobody holds
// them, and no force moves them.
#pragma once
#include "devices/ordered_time.h"
#include "haptics/device.h"
#include "haptics/hand.h"
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Position of the handle at one time. Between two rows it moves at constant velocity; before the
// first and after the last row it rests.
struct PlayedRow {
    double time_s = 0;
    Vec3 handle_m = Vec3::Zero();
    Vec3 turn_rad = Vec3::Zero();  // rotation vector
    bool clutch = false;           // pressed until the next row
    // The recorded device's stiffness cap (0: not stated), and whether it was at a stop.
    double cap_N_per_m = 0;
    bool at_stop = false;
};

// Largest distance of a row from the middle along each axis, m: of a script, and of a recorded
// trace, since a mouse has no end.
inline constexpr double script_reach_m = 0.5, trace_reach_m = 100;

// Parses comma-separated values with a header line: time_s, handle_x_m, handle_y_m, handle_z_m and,
// optionally, clutch (0 or 1), handle_turn_x_rad, handle_turn_y_rad, handle_turn_z_rad, cap_N_per_m
// and at_stop (0 or 1), in any order; times must ascend. Empty lines and lines that begin with '#'
// are ignored. Throws LoadError with `file` and the line.
std::vector<PlayedRow> parse_script(std::string_view text, const std::string& file);

// The same for a recorded trace: other columns are ignored, and so is an incomplete last line.
std::vector<PlayedRow> parse_trace(std::string_view text, const std::string& file);

// Reads a file: a script; or a trace, or the folder of a recording with a trace.
std::vector<PlayedRow> read_trace(const std::filesystem::path& recording);
std::vector<PlayedRow> read_script(const std::filesystem::path& file);

struct PlayedHandleSettings {
    std::string name = "script";
    std::vector<PlayedRow> rows = {};  // times ascending; none: it rests in the middle
    double viscosity_N_s_per_m = 0;    // of the device, if no row states a cap
    HandOrders* orders = nullptr;      // orders of a window to restart or stop
};

// Runs on the servo's clock: each write() advances it by one tick. If played at the recorded ticks,
// the readings equal the recorded ones to the last digit.
class PlayedHandle final : public Device {
public:
    explicit PlayedHandle(PlayedHandleSettings settings);

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override;

private:
    // The row of the present tick.
    PlayedRow row_now() const noexcept;

    PlayedHandleSettings settings_;
    DeviceSpec spec_;
    OrderedTime time_;
    std::uint64_t tick_ = 0,
                  start_tick_ = 0;  // tick since the start; tick at which the table began
    std::size_t next_ = 0;          // index of the next row
};

}  // namespace palpa
