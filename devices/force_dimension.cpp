#include "devices/force_dimension.h"

#include "devices/device_nodes.h"
#include "devices/maker_library.h"
#include "platform/library.h"
#include "platform/system.h"
#include "platform/thread.h"

#include <fmt/format.h>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

// USB ids that open programs' rules name: Force Dimension's controllers, and Novint's Falcon.
constexpr std::array usb_ids{UsbId{0x1451, 0x0301}, UsbId{0x1451, 0x0402}, UsbId{0x1451, 0x0403},
                             UsbId{0x1451, 0x040c}, UsbId{0x0403, 0xcb48}};

std::string dhd_remedy() {
    const std::string_view file = system_name() == "Windows" ? "dhd64.dll" : "libdhd.so.3";
    return fmt::format(
        "install the Force Dimension SDK (www.forcedimension.com), {}; or set "
        "PALPA_FORCE_DIMENSION to the path of {}",
        how_to_place_library(file), file);
}

// From the library's axes to the program's, and back by its transpose.
const Mat3& turn_of_axes() {
    static const Mat3 turn = (Mat3() << 0, 1, 0, 0, 0, 1, 1, 0, 0).finished();
    return turn;
}

// What the library does not say. Peaks and half widths are those that CHAI3D (cDeltaDevices) has
// for the same devices; a sigma or lambda, stronger and larger, counts as an omega.
struct Limits {
    double peak_newton, half_m;
    double continuous_newton;  // 0: not known
    bool is_known = true;
};

Limits limits_of(int type) noexcept {
    switch (type) {
        case dhd::omega_3:
        case dhd::omega_6:
        case dhd::omega_6_left:
        case dhd::omega_7:
        case dhd::omega_7_left:
            return {12, 0.075, 12};
        case dhd::delta_3:
        case dhd::delta_6:
            return {20, 0.15, 0};
        case dhd::falcon:
            return {8, 0.04, 0};
        default:
            return {12, 0.075, 0, false};
    }
}

// A force must not outlive exit(), which destroys nothing that lives on a stack.
struct OpenDevices {
    std::mutex mutex;
    std::vector<ForceDimension*> all;
};

OpenDevices& open_devices() {
    static auto& devices = *new OpenDevices;
    return devices;
}

void close_open_devices() {
    OpenDevices& devices = open_devices();
    std::vector<ForceDimension*> all;
    {
        const std::lock_guard lock(devices.mutex);
        all.swap(devices.all);
    }
    for (ForceDimension* const device : all) device->close();
}

// Two devices of one process must not take the same one.
std::optional<dhd::Id> open_next(const dhd::Library& library) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const int id = library.open();
    if (id < 0 || id > std::numeric_limits<signed char>::max()) return std::nullopt;
    return static_cast<dhd::Id>(id);
}

std::string last_error(const dhd::Library& library) {
    const char* const text = library.error_get_last_str();
    return text && *text != '\0' ? text : "the library does not say why";
}

void check_system(const std::filesystem::path& root, std::vector<DeviceCheck>& checks) {
    add_bus_checks(find_raw_usb_devices(root, usb_ids),
                   {"bus", CheckOutcome::Unknown, "no device with a known id on USB",
                    fmt::format("check power and cable; {} shows Force Dimension's as 1451:..., a "
                                "Falcon as 0403:cb48",
                                usb_list_name())},
                   checks);
}

DeviceCheck check_calibration(const std::array<int, dhd::most_status>& status, bool has_status) {
    if (!has_status) return {"calibration", CheckOutcome::Unknown, "the library does not say", ""};
    if (status[dhd::status_reset] == 0) return {"calibration", CheckOutcome::Ok, "done", ""};
    return {"calibration", CheckOutcome::Failed, "the device is waiting for its calibration",
            "move the handle to its rest position until the light stops blinking (omega or sigma: "
            "put the end of the arm into its socket; Falcon: pull the grip out and push it in)"};
}

}  // namespace

ForceDimension::ForceDimension(const dhd::Library& library, dhd::Id id, DeviceSpec spec,
                               const ForceDimensionSettings& settings)
    : library_(library), settings_(settings), spec_(std::move(spec)), id_(id) {
    {
        const std::lock_guard lock(open_devices().mutex);
        open_devices().all.push_back(this);
    }
    // After the library was loaded, so before the library's own end.
    static const bool is_registered = std::atexit(close_open_devices) == 0;
    (void)is_registered;
    thread_ = std::thread([this] { run(); });
}

ForceDimension::~ForceDimension() {
    {
        const std::lock_guard lock(open_devices().mutex);
        std::erase(open_devices().all, this);
    }
    close();
}

void ForceDimension::close() noexcept {
    std::call_once(closed_, [this] {
        is_closing_ = true;
        {
            const std::lock_guard lock(mutex_);
            is_over_ = true;
        }
        wake_.notify_one();
        if (thread_.joinable()) thread_.join();
    });
}

DeviceReading ForceDimension::read() noexcept {
    const bool is_new = readings_.read(last_);
    DeviceReading reading = last_;
    reading.valid = reading.valid && is_new;
    return reading;
}

std::string_view ForceDimension::status() const noexcept {
    switch (state_.load()) {
        case State::Ready:
            return {};
        case State::NeedsCalibration:
            return "The device is waiting for its calibration: move the handle to its rest "
                   "position until the light stops blinking.";
        case State::ForceButton:
            return "The device's motors are off: press its force button.";
        case State::Refused:
            return "The device switched the force off because the handle was too fast or its own "
                   "monitoring found a fault; the force returns by itself.";
        case State::Lost:
            return "The device does not answer: check power and cable. Palpa keeps looking for it.";
    }
    return {};
}

void ForceDimension::wait_for(std::chrono::steady_clock::duration time) {
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, time, [&] { return is_over_; });
}

void ForceDimension::run() noexcept {
    using Clock = std::chrono::steady_clock;
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(servo_tick_s));
    if (settings_.is_paced) (void)ask_for_real_time();
    start();
    for (Clock::time_point due = Clock::now(); !is_closing_;) {
        if (!id_) {
            wait_for(std::chrono::duration_cast<Clock::duration>(
                std::chrono::duration<double>(settings_.retry_s)));
            if (is_closing_) break;
            id_ = open_next(library_);
            if (id_) start();
            due = Clock::now();
            continue;
        }
        tick();
        if (!settings_.is_paced) continue;
        due = std::max(due + period,
                       Clock::now() - period);  // ticks that were missed are not repeated
        sleep_exactly_until(due);
    }
    if (id_) stop();
}

void ForceDimension::start() noexcept {
    has_wrist_ = library_.has_wrist(*id_);
    const int type = library_.get_system_type(*id_);
    if (type == dhd::sigma_7 || type == dhd::sigma_7_left)
        (void)library_.emulate_button(dhd::on, *id_);
    (void)library_.set_gravity_compensation(dhd::on, *id_);
    // The first force that is played is none.
    (void)library_.set_force(0, 0, 0, *id_);
    (void)library_.enable_force(dhd::on, *id_);
    failed_ticks_ = refused_left_ticks_ = 0;
    state_ = State::Ready;
    look_at_status();  // before its first position: it may have lost its calibration
}

void ForceDimension::stop() noexcept {
    (void)library_.set_force(0, 0, 0, *id_);
    (void)library_.enable_force(dhd::off, *id_);
    (void)library_.close(*id_);
    id_.reset();
}

void ForceDimension::tick() noexcept {
    DeviceReading reading;
    bool answers = take_pose(reading);
    if (ticks_ % status_ticks == 0) look_at_status();
    const State state = state_;
    Vec3 force = forces_.take(spec_.peak_force_newton);
    if (state != State::Ready || !answers) force.setZero();
    const Vec3 played = turn_of_axes().transpose() * force;
    answers = library_.set_force(played.x(), played.y(), played.z(), *id_) >= 0 && answers;

    failed_ticks_ = answers ? 0 : failed_ticks_ + 1;
    reading.valid = reading.valid && answers && state != State::NeedsCalibration;
    if (state == State::ForceButton || state == State::Refused)
        reading.trouble = DeviceTrouble::ForceRefused;
    if (failed_ticks_ >= lost_ticks) {
        stop();
        state_ = State::Lost;
    }
    readings_.post(reading);
    ++ticks_;
}

bool ForceDimension::take_pose(DeviceReading& reading) noexcept {
    Vec3 place = Vec3::Constant(no_value);
    double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int answer = has_wrist_ ? library_.get_position_and_orientation_frame(
                                        &place.x(), &place.y(), &place.z(), axes, *id_)
                                  : library_.get_position(&place.x(), &place.y(), &place.z(), *id_);
    reading.time_s = static_cast<double>(ticks_) / spec_.rate_hz;
    if (answer < 0) return false;
    reading.buttons = library_.get_button_mask(*id_) & 0xFU;
    Mat3 turn;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) turn(row, column) = axes[row][column];
    constexpr double rounding = 1e-2;
    const bool is_turn =
        (turn * turn.transpose() - Mat3::Identity()).norm() < rounding && turn.determinant() > 0;
    if (!place.allFinite() || place.norm() > farthest_reading_m || !is_turn) return true;
    reading.position_m = turn_of_axes() * place;
    reading.orientation =
        Quat(Mat3(turn_of_axes() * turn * turn_of_axes().transpose())).normalized();
    reading.valid = true;
    return true;
}

// Of its own accord a device switches its motors off: by its button, or where the handle was too
// fast. A person switches them on again in the first case, else this does, after a pause.
void ForceDimension::look_at_status() noexcept {
    std::array<int, dhd::most_status> status{};
    if (library_.get_status(status.data(), *id_) < 0) return;
    if (status[dhd::status_reset] != 0) {
        state_ = State::NeedsCalibration;
        return;
    }
    if (status[dhd::status_force] != 0) {
        state_ = State::Ready;
        refused_left_ticks_ = 0;
        return;
    }
    if (status[dhd::status_force_off_cause] == dhd::off_by_button) {
        state_ = State::ForceButton;
        return;
    }
    refused_left_ticks_ -= status_ticks;
    if (state_ != State::Refused) {
        state_ = State::Refused;
        refused_left_ticks_ = refused_ticks;
    } else if (refused_left_ticks_ <= 0) {
        (void)library_.enable_force(dhd::on, *id_);
        refused_left_ticks_ = refused_ticks;
    }
}

OpenedDevice open_force_dimension(const ForceDimensionSettings& settings,
                                  const DeviceRequest& request) {
    OpenedDevice opened;
    std::vector<DeviceCheck>& checks = opened.checks;
    const dhd::LibrarySearch search = dhd::find_library(settings.library);
    const bool is_whole = search.is_found && search.missing.empty();
    // The reason is the last check; that the device was seen stands before it.
    if (!is_whole) check_system(request.system_root, checks);
    checks.push_back(check_library(search, dhd_remedy()));
    if (!search.is_found) return opened;
    checks.push_back(
        check_symbols(search, "install version 3.7 or newer of the Force Dimension SDK"));
    if (!is_whole) return opened;
    check_system(request.system_root, checks);
    const dhd::Library& library = search.library;
    const std::optional<dhd::Id> id = open_next(library);
    if (!id) {
        checks.push_back({"init", CheckOutcome::Failed, last_error(library),
                          "check power and cable, and end other programs that use the device; on "
                          "Linux the user needs permission: " +
                              permission_remedy()});
        return opened;
    }
    const char* const name = library.get_system_name(*id);
    DeviceSpec spec;
    spec.name = name && *name != '\0' ? name : "Force Dimension device";
    checks.push_back({"init", CheckOutcome::Ok, spec.name, ""});
    const Limits limits = limits_of(library.get_system_type(*id));
    spec.peak_force_newton = limits.peak_newton;
    spec.continuous_force_newton = limits.continuous_newton;
    spec.half_workspace_m = Vec3::Constant(limits.half_m);
    checks.push_back(
        {"limits", limits.is_known ? CheckOutcome::Ok : CheckOutcome::Unknown,
         fmt::format(
             "up to {} N, {:.0f} mm in each direction{}", limits.peak_newton, 1e3 * limits.half_m,
             limits.is_known ? "" : "; assumed values of an omega, because this type is unknown"),
         ""});
    std::array<int, dhd::most_status> status{};
    const bool is_told = library.get_status(status.data(), *id) >= 0;
    checks.push_back(check_calibration(status, is_told));
    opened.device = std::make_unique<ForceDimension>(library, *id, spec, settings);
    return opened;
}

bool is_force_dimension_there(const DeviceRequest& request) {
    return !find_raw_usb_devices(request.system_root, usb_ids).empty();
}

OpenedDevice open_force_dimension_device(const DeviceRequest& request) {
    ForceDimensionSettings settings;
    // No name at all would stand for this program itself.
    const char* const path = std::getenv("PALPA_FORCE_DIMENSION");
    if (path && *path != '\0') settings.library = path;
    return open_force_dimension(settings, request);
}

}  // namespace palpa
