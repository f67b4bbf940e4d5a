// Handles that move by themselves, as a table says: a recording's trace, or a script that somebody
// wrote. Nobody holds them, and no force moves them.
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

// Where the handle is at a time. Between two rows it goes straight and evenly, before the first and
// after the last it rests.
struct PlayedRow {
    double time_s = 0;
    Vec3 handle_m = Vec3::Zero();
    Vec3 turn_rad = Vec3::Zero();  // rotation vector
    bool clutch = false;           // pressed until the next row
};

// Where no row may be beyond, from the middle, either way.
inline constexpr double played_reach_m = 0.5;

// Comma-separated values under a line of names: time_s, handle_x_m, handle_y_m, handle_z_m and, if
// need be, clutch (0 or 1), handle_turn_x_rad, handle_turn_y_rad, handle_turn_z_rad, in any order;
// times ascend. Empty lines and those that begin with '#' are passed over. Throws LoadError that
// names `file` and the line.
std::vector<PlayedRow> parse_script(std::string_view text, const std::string& file);

// The same of a recorded trace, of whose columns others are passed over, as is what stands behind
// the last whole line of one that was cut off.
std::vector<PlayedRow> parse_trace(std::string_view text, const std::string& file);

// Of a file: a script; a trace, or the folder of a recording with one.
std::vector<PlayedRow> read_trace(const std::filesystem::path& recording);
std::vector<PlayedRow> read_script(const std::filesystem::path& file);

struct PlayedHandleSettings {
    std::string name = "script";
    std::vector<PlayedRow> rows = {};  // times ascending; none: it rests in the middle
    HandOrders* orders = nullptr;      // of a window: it begins anew, or stands still
};

// Time is the servo's: each write moves it on by one tick. Played at the ticks at which they were
// recorded, rows are what was read then, to the last digit.
class PlayedHandle final : public Device {
public:
    explicit PlayedHandle(PlayedHandleSettings settings);

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override;
    void write(const Vec3& force_newton) noexcept override;

private:
    // At the present tick.
    PlayedRow row_now() const noexcept;

    PlayedHandleSettings settings_;
    DeviceSpec spec_;
    OrderedTime time_;
    std::uint64_t tick_ = 0, start_tick_ = 0;  // since the beginning; where the table began
    std::size_t next_ = 0;                     // the first row that is still to come
};

}  // namespace palpa
