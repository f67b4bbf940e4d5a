#include "devices/open_haptics.h"

#include "core/omni.h"
#include "devices/device_nodes.h"
#include "devices/maker_library.h"
#include "platform/library.h"
#include "platform/system.h"

#include <fmt/format.h>
#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr double metre_per_mm = 1e-3;
// The library sorts its callbacks by it; the middle of its range.
constexpr unsigned short priority = 0x7FFF;
// While the stylus has to go into its inkwell, the library is asked so often whether it is there.
constexpr int inkwell_ticks = 250;

// From the maker's data sheet of the Omni, used where the library says nothing.
constexpr double omni_continuous_newton = 0.88;

// USB ids that were seen on the Touch: serial, as its papers say it, HID. The one of Ethernet
// and the oldest ones do not show.
constexpr std::array touch_ids{UsbId{0x2988, 0x0302}, UsbId{0x0301, 0x2988}, UsbId{0x2988, 0x0304}};

std::string open_haptics_remedy() {
    const std::string file = list_library_files("HD", {}).front();
    return fmt::format(
        "install the Touch driver and OpenHaptics for {} (Developer Edition 3.4) from 3D Systems, "
        "{}; or set PALPA_OPENHAPTICS to the path of {}",
        system_name(), how_to_place_library(file), file);
}

// The library has no more errors than this to tell at once, and must not keep us for ever.
constexpr int most_errors = 16;

// Takes all errors out; the first one, or success.
hd::Code first_error(const hd::Library& library) {
    hd::Code first = hd::success;
    for (int i = 0; i < most_errors; ++i) {
        const hd::Code error = library.get_error().code;
        if (error == hd::success) break;
        if (first == hd::success) first = error;
    }
    return first;
}

bool is_force_error(hd::Code error) noexcept {
    return error == hd::exceeded_max_force || error == hd::exceeded_force_impulse ||
           error == hd::exceeded_max_velocity || error == hd::force_error;
}

bool is_loss(hd::Code error) noexcept {
    return error == hd::device_fault || error == hd::comm_error || error == hd::comm_config_error ||
           error == hd::timer_error || error == hd::bad_handle;
}

// The only device that is open. The library has one scheduler for the whole process, and a force
// must not outlive exit(), which destroys nothing that lives on a stack.
std::atomic<OpenHaptics*> open_one{nullptr};

void close_open_one() {
    if (OpenHaptics* const device = open_one.exchange(nullptr)) device->close();
}

// Of another program that ended badly, or of another name of the same device.
hd::Handle init_device(const hd::Library& library, const std::string& name, hd::Code& error) {
    constexpr int attempts = 3;
    for (int i = 0; i < attempts; ++i) {
        (void)first_error(library);
        const hd::Handle handle = library.init_device(name.empty() ? nullptr : name.c_str());
        error = first_error(library);
        if (error == hd::success && handle != hd::no_device) return handle;
        if (error == hd::success) error = hd::bad_handle;
        if (handle != hd::no_device) library.disable_device(handle);
        if (error != hd::already_initiated) break;
        library.disable_device(library.get_current_device());
    }
    return hd::no_device;
}

// Under the wanted name, or else as the default device or under the names that the maker's programs
// give. `error`: of the first of these.
hd::Handle find_device(const hd::Library& library, const std::string& wanted, hd::Code& error) {
    const hd::Handle first = init_device(library, wanted, error);
    if (first != hd::no_device || !wanted.empty()) return first;
    for (const char* const name : {"Default Device", "Default PHANToM", "Left Device"}) {
        hd::Code ignored = hd::success;
        const hd::Handle handle = init_device(library, name, ignored);
        if (handle != hd::no_device) return handle;
    }
    return hd::no_device;
}

// No number where the library does not know.
double query(const hd::Library& library, hd::Code parameter) {
    std::array<double, 16> values{};  // more than any parameter has
    values.fill(no_value);
    library.get_doublev(parameter, values.data());
    return first_error(library) == hd::success ? values[0] : no_value;
}

std::string text_of(const hd::Library& library, hd::Code parameter) {
    const char* const text = library.get_string(parameter);
    const bool is_known = first_error(library) == hd::success && text;
    return is_known ? text : "";
}

bool is_positive(double value) noexcept { return std::isfinite(value) && value > 0; }

// The box in which the handle can be used.
struct Box {
    bool is_known = false;
    Vec3 centre_m = Vec3::Zero(), half_m = omni_half_workspace_m;
};

Box query_box(const hd::Library& library) {
    std::array<double, 16> mm{};
    library.get_doublev(hd::usable_workspace, mm.data());
    const bool is_known = first_error(library) == hd::success;
    const Vec3 low(mm[0], mm[1], mm[2]), high(mm[3], mm[4], mm[5]);
    const Vec3 half_m = 0.5 * metre_per_mm * (high - low);
    Box box;
    if (!is_known || !half_m.allFinite() || half_m.minCoeff() <= 0) return box;
    if (half_m.maxCoeff() > farthest_reading_m) return box;
    return {true, 0.5 * metre_per_mm * (high + low), half_m};
}

int query_calibration_style(const hd::Library& library) {
    int styles = 0;
    library.get_integerv(hd::calibration_styles, &styles);
    (void)first_error(library);
    for (const hd::Code style : {hd::inkwell, hd::automatic}) {
        if ((static_cast<hd::Code>(styles) & style) != 0) return static_cast<int>(style);
    }
    return static_cast<int>(hd::encoder_reset);
}

std::vector<FoundDevice> find_on_bus(const std::filesystem::path& root) {
    std::vector<FoundDevice> found = find_usb_devices(root, touch_ids);
    for (FoundDevice& device : find_firewire_devices(root, "sensable")) {
        found.push_back(std::move(device));
    }
    return found;
}

void check_touch_on_bus(const std::filesystem::path& root, std::vector<DeviceCheck>& checks) {
    add_bus_checks(
        find_on_bus(root),
        {"bus", CheckOutcome::Unknown,
         "no device of this maker on USB or FireWire (a device on Ethernet does not show here)",
         fmt::format("check power and cable; {} shows a Touch as 2988:0302 or 2988:0304",
                     usb_list_name())},
        checks);
}

DeviceCheck check_calibration(const hd::Library& library, int style) {
    if (library.check_calibration() == hd::calibration_needs_update) {
        library.update_calibration(static_cast<hd::Code>(style));
    }
    const hd::Code state = library.check_calibration();
    (void)first_error(library);
    if (state == hd::calibration_ok) return {"calibration", CheckOutcome::Ok, "done", ""};
    if (state == hd::calibration_needs_hand) {
        return {"calibration", CheckOutcome::Failed, "the device is not calibrated",
                "put the stylus into the inkwell, wait for two seconds, and take it out again"};
    }
    return {"calibration", CheckOutcome::Failed, "calibration failed",
            "put the stylus into the inkwell; if that does not help, run the maker's diagnostic"};
}

DeviceCheck check_rate(const hd::Library& library) {
    library.set_scheduler_rate(static_cast<unsigned long>(servo_rate_hz));
    (void)first_error(library);
    int rate_hz = 0;
    library.get_integerv(hd::update_rate, &rate_hz);
    const hd::Code error = first_error(library);
    if (error != hd::success || rate_hz <= 0) {
        return {"rate", CheckOutcome::Unknown, "the library does not say", ""};
    }
    if (rate_hz == static_cast<int>(servo_rate_hz)) {
        return {"rate", CheckOutcome::Ok, fmt::format("{} ticks a second", rate_hz), ""};
    }
    return {"rate", CheckOutcome::Unknown,
            fmt::format("{} ticks a second, not {}", rate_hz, servo_rate_hz), ""};
}

DeviceCheck check_motors(const hd::Library& library) {
    std::array<double, 16> share{};
    library.get_doublev(hd::motor_temperature, share.data());
    const hd::Code error = first_error(library);
    const double hottest = *std::max_element(share.begin(), share.begin() + 6);
    if (error == hd::warm_motors || hottest >= 1) {
        return {"motors", CheckOutcome::Failed, std::string(hd::describe(hd::warm_motors).what),
                std::string(hd::describe(hd::warm_motors).remedy)};
    }
    if (error != hd::success || !std::isfinite(hottest)) {
        return {"motors", CheckOutcome::Unknown, "the library does not report their temperature",
                ""};
    }
    return {"motors", CheckOutcome::Ok,
            fmt::format("at {:.0f} % of their thermal limit", 100 * hottest), ""};
}

}  // namespace

OpenHaptics::OpenHaptics(const hd::Library& library, hd::Handle handle, DeviceSpec spec,
                         const Vec3& centre_m, const OpenHapticsSettings& settings)
    : library_(library),
      settings_(settings),
      spec_(std::move(spec)),
      centre_m_(centre_m),
      handle_(handle) {
    open_one = this;
    // After the library was loaded, so before the library's own end.
    static const bool is_registered = std::atexit(close_open_one) == 0;
    (void)is_registered;
    start();
    keeper_ = std::thread([this] { keep(); });
}

OpenHaptics::~OpenHaptics() {
    OpenHaptics* self = this;
    open_one.compare_exchange_strong(self, nullptr);
    close();
}

void OpenHaptics::start() noexcept {
    library_.make_current_device(handle_);
    calibration_style_ = query_calibration_style(library_);
    library_.enable(hd::max_force_clamping);
    library_.enable(hd::force_output);
    library_.set_scheduler_rate(static_cast<unsigned long>(servo_rate_hz));
    (void)first_error(library_);
    schedule_ = library_.schedule_asynchronous(
        [](void* self) -> hd::Code { return static_cast<OpenHaptics*>(self)->tick(); }, this,
        priority);
    library_.start_scheduler();
    const hd::Code error = first_error(library_);
    if (error == hd::success) return;
    // Without its ticks there is no device: keep() tries again.
    last_error_ = error;
    state_ = State::Lost;
    is_lost_ = true;
}

// No tick runs any more when the scheduler has stopped: this thread may then speak for it.
void OpenHaptics::stop() noexcept {
    library_.stop_scheduler();
    library_.unschedule(schedule_);
    library_.make_current_device(handle_);
    const std::array<double, 3> zero{};
    library_.begin_frame(handle_);
    library_.set_doublev(hd::current_force, zero.data());
    library_.end_frame(handle_);
    library_.disable(hd::force_output);
    library_.disable_device(handle_);
    (void)first_error(library_);
    handle_ = hd::no_device;
}

void OpenHaptics::close() noexcept {
    std::call_once(closed_, [this] {
        is_closing_ = true;
        {
            const std::lock_guard lock(mutex_);
            is_over_ = true;
        }
        wake_.notify_one();
        if (keeper_.joinable()) keeper_.join();
        if (handle_ == hd::no_device) return;
        // One more tick takes the force away gently; a scheduler that hangs is not waited for.
        for (int i = 0; i < 50 && !played_zero_; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        stop();
    });
}

DeviceReading OpenHaptics::read() noexcept {
    const bool is_new = readings_.read(last_);
    DeviceReading reading = last_;
    reading.valid = reading.valid && is_new;
    return reading;
}

std::string_view OpenHaptics::status() const noexcept {
    switch (state_.load()) {
        case State::Starting:
        case State::Ready:
            return {};
        case State::NeedsCalibration:
            return "The device is being calibrated: move the stylus a little, or put it into its "
                   "inkwell.";
        case State::NeedsInkwell:
            return "Put the stylus into its inkwell, wait for two seconds, and take it out again.";
        case State::Warm:
            return "The motors are too warm: the device switched the force off, and it returns by "
                   "itself.";
        case State::Refused:
            return "The device switched off a force that was too large or too sudden; it returns "
                   "by itself.";
        case State::Lost:
            return "The device does not answer: check power and cable. Palpa keeps looking for it.";
    }
    return {};
}

hd::Code OpenHaptics::tick() noexcept {
    if (is_lost_) return hd::callback_continue;
    library_.make_current_device(handle_);
    const bool is_calibrated = update_calibration();
    const bool was_without_force = warm_left_ticks_ > 0 || refused_left_ticks_ > 0;
    warm_left_ticks_ = std::max(0, warm_left_ticks_ - 1);
    refused_left_ticks_ = std::max(0, refused_left_ticks_ - 1);
    const bool is_without_force = warm_left_ticks_ > 0 || refused_left_ticks_ > 0;
    // The library may have switched it off itself.
    if (was_without_force && !is_without_force) library_.enable(hd::force_output);

    library_.begin_frame(handle_);
    DeviceReading reading = take_reading();
    Vec3 force = forces_.take(spec_.peak_force_newton);
    const bool is_closing = is_closing_;
    if (!is_calibrated || is_without_force || is_closing) force.setZero();
    library_.set_doublev(hd::current_force, force.data());
    library_.end_frame(handle_);
    const bool is_believed = take_errors();

    reading.valid = reading.valid && is_calibrated && is_believed;
    if (warm_left_ticks_ > 0) {
        reading.trouble = DeviceTrouble::WarmMotors;
    } else if (refused_left_ticks_ > 0) {
        reading.trouble = DeviceTrouble::ForceRefused;
    }
    if (is_lost_) {
        state_ = State::Lost;
    } else if (is_calibrated) {
        state_ = warm_left_ticks_ > 0      ? State::Warm
                 : refused_left_ticks_ > 0 ? State::Refused
                                           : State::Ready;
    }
    readings_.post(reading);
    ++ticks_;
    if (is_closing) played_zero_ = true;
    return hd::callback_continue;
}

bool OpenHaptics::update_calibration() noexcept {
    const hd::Code calibration = library_.check_calibration();
    const auto style = static_cast<hd::Code>(calibration_style_);
    if (calibration == hd::calibration_ok) return true;
    const bool needs_hand = calibration == hd::calibration_needs_hand;
    state_ = needs_hand ? State::NeedsInkwell : State::NeedsCalibration;
    if (!needs_hand || ticks_ % inkwell_ticks == 0) {
        library_.update_calibration(style);
        (void)first_error(library_);  // that the stylus is not there yet is no news
    }
    return false;
}

DeviceReading OpenHaptics::take_reading() noexcept {
    std::array<double, 16> m{};
    m.fill(no_value);
    int buttons = 0;
    library_.get_doublev(hd::current_transform, m.data());
    library_.get_integerv(hd::current_buttons, &buttons);
    DeviceReading reading;
    reading.time_s = static_cast<double>(ticks_) / spec_.rate_hz;
    reading.buttons = static_cast<std::uint32_t>(buttons) & 0xFU;
    const Vec3 place_m = metre_per_mm * Vec3(m[12], m[13], m[14]);
    Mat3 axes;
    axes << m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10];
    constexpr double rounding = 1e-2;
    const bool is_turn =
        (axes * axes.transpose() - Mat3::Identity()).norm() < rounding && axes.determinant() > 0;
    if (!place_m.allFinite() || place_m.norm() > farthest_reading_m || !is_turn) return reading;
    reading.position_m = place_m - centre_m_;
    reading.orientation = Quat(axes).normalized();
    reading.valid = true;
    return reading;
}

bool OpenHaptics::take_errors() noexcept {
    bool is_believed = true;
    for (int i = 0; i < most_errors; ++i) {
        const hd::Code error = library_.get_error().code;
        if (error == hd::success) break;
        last_error_ = error;
        if (error == hd::warm_motors) {
            warm_left_ticks_ = warm_ticks;
        } else if (is_force_error(error)) {
            refused_left_ticks_ = refused_ticks;
        } else {
            is_believed = false;
        }
        if (is_loss(error)) is_lost_ = true;
    }
    return is_believed;
}

// The scheduler cannot be stopped from its own thread, and the servo must not wait for it.
void OpenHaptics::keep() {
    const std::chrono::duration<double> retry(settings_.retry_s);
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, std::min(retry, std::chrono::duration<double>(0.05)),
                           [&] { return is_over_; })) {
        if (!is_lost_) continue;
        lock.unlock();
        if (handle_ != hd::no_device) stop();
        hd::Code error = hd::success;
        handle_ = find_device(library_, settings_.device_name, error);
        if (handle_ != hd::no_device) {
            is_lost_ = false;  // the state stays Lost until its first tick
            start();
        }
        lock.lock();
        if (is_lost_) wake_.wait_for(lock, retry, [&] { return is_over_; });
    }
}

OpenedDevice open_haptics(const OpenHapticsSettings& settings, const DeviceRequest& request) {
    OpenedDevice opened;
    std::vector<DeviceCheck>& checks = opened.checks;
    const hd::LibrarySearch search = hd::find_library(settings.library);
    const bool is_whole = search.is_found && search.missing.empty();
    // The reason is the last check; that the device was seen stands before it.
    if (!is_whole) check_touch_on_bus(request.system_root, checks);
    checks.push_back(check_library(search, open_haptics_remedy()));
    if (!search.is_found) return opened;
    checks.push_back(check_symbols(search, "install OpenHaptics 3.4 or newer"));
    if (!is_whole) return opened;
    check_touch_on_bus(request.system_root, checks);
    const hd::Library& library = search.library;
    if (open_one.load()) {
        checks.push_back({"init", CheckOutcome::Failed, "this program has a device open already",
                          "close it first: the library supports one device at a time"});
        return opened;
    }
    hd::Code error = hd::success;
    const hd::Handle handle = find_device(library, settings.device_name, error);
    if (handle == hd::no_device) {
        const hd::ErrorWords why = hd::describe(error);
        checks.push_back({"init", CheckOutcome::Failed,
                          fmt::format("{} (0x{:04x})", why.what, error), std::string(why.remedy)});
        return opened;
    }
    library.make_current_device(handle);
    const std::string model = text_of(library, hd::model_type);
    const std::string serial = text_of(library, hd::serial_number);
    const std::string name = model.empty() ? "OpenHaptics device" : model;
    checks.push_back({"init", CheckOutcome::Ok,
                      serial.empty() ? name : fmt::format("{}, serial number {}", name, serial),
                      ""});

    DeviceSpec spec;
    spec.name = name;
    const double peak = query(library, hd::nominal_max_force);
    const double continuous = query(library, hd::nominal_max_continuous_force);
    const double stiffness = query(library, hd::nominal_max_stiffness);
    const Box box = query_box(library);
    const bool is_known = is_positive(peak) && is_positive(continuous) && box.is_known;
    spec.peak_force_newton = is_positive(peak) ? peak : omni_peak_newton;
    spec.continuous_force_newton = is_positive(continuous) ? continuous : omni_continuous_newton;
    spec.half_workspace_m = box.half_m;
    const Vec3 mm = 2 / metre_per_mm * box.half_m;
    checks.push_back(
        {"limits", is_known ? CheckOutcome::Ok : CheckOutcome::Unknown,
         fmt::format(
             "up to {:.2f} N, {:.2f} N continuously, {:.0f} × {:.0f} × {:.0f} mm{}{}",
             spec.peak_force_newton, spec.continuous_force_newton, mm.x(), mm.y(), mm.z(),
             is_positive(stiffness) ? fmt::format(", {:.2f} N/mm", stiffness) : "",
             is_known
                 ? ""
                 : "; partly assumed values of an Omni, because the library does not report them"),
         ""});
    checks.push_back(check_calibration(library, query_calibration_style(library)));
    checks.push_back(check_motors(library));
    checks.push_back(check_rate(library));
    opened.device = std::make_unique<OpenHaptics>(library, handle, spec, box.centre_m, settings);
    return opened;
}

bool is_omni_there(const DeviceRequest& request) {
    return !find_on_bus(request.system_root).empty();
}

OpenedDevice open_omni(const DeviceRequest& request) {
    OpenHapticsSettings settings;
    // No name at all would stand for this program itself.
    const char* const path = std::getenv("PALPA_OPENHAPTICS");
    if (path && *path != '\0') settings.library = path;
    if (const char* const name = std::getenv("PALPA_OMNI")) settings.device_name = name;
    return open_haptics(settings, request);
}

}  // namespace palpa
