#include "tests/support/open_haptics_stub/stub.h"

#include "devices/emulated_omni.h"
#include "devices/open_haptics_library.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

using namespace palpa;

namespace {

using test::StubCalibration;

constexpr hd::Handle the_device = 7;
constexpr hd::Schedule the_schedule = 3;

// Everything under one mutex, as slow as it likes to be.
class Stub final : public test::OpenHapticsStub {
public:
    // PALPA_STUB in the environment, for programs that no test steps: words with commas between.
    Stub() : omni_(EmulatedOmniSettings{}) {
        const char* const text = std::getenv("PALPA_STUB");
        const std::string words = "," + std::string(text ? text : "") + ",";
        const auto is_said = [&](const char* word) {
            return words.find("," + std::string(word) + ",") != std::string::npos;
        };
        runs_freely_ = is_said("free");
        is_plugged_ = !is_said("absent");
        if (is_said("inkwell")) calibration_ = StubCalibration::NeedsInkwell;
        if (is_said("broken-calibration")) calibration_ = StubCalibration::Broken;
        is_warm_ = is_said("warm");
        is_silent_ = is_said("silent");
    }

    ~Stub() override { stop(); }

    // The test's side.
    void step(int ticks) override {
        std::unique_lock lock(mutex_);
        granted_ += ticks;
        wake_.notify_all();
        wake_.wait(lock, [&] { return granted_ == 0 || !is_running_; });
        granted_ = 0;
    }
    void block() override {
        const std::lock_guard lock(mutex_);
        is_blocking_ = true;
    }
    void wait_until_blocked() override {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [&] { return is_blocked_; });
    }
    void unblock() override {
        const std::lock_guard lock(mutex_);
        is_blocking_ = false;
        wake_.notify_all();
    }
    void plug(bool is_plugged) override {
        const std::lock_guard lock(mutex_);
        is_plugged_ = is_plugged;
    }
    void refuse_starts(int starts) override {
        const std::lock_guard lock(mutex_);
        refused_starts_ = starts;
    }
    void raise_error(unsigned code) override {
        const std::lock_guard lock(mutex_);
        coming_.push_back(code);
    }
    void set_calibration(StubCalibration calibration) override {
        const std::lock_guard lock(mutex_);
        calibration_ = calibration;
        is_in_inkwell_ = false;
    }
    void put_into_inkwell() override {
        const std::lock_guard lock(mutex_);
        is_in_inkwell_ = true;
    }
    void press(int buttons) override {
        const std::lock_guard lock(mutex_);
        buttons_ = buttons;
    }
    void report_transform(const double* numbers) override {
        const std::lock_guard lock(mutex_);
        is_reporting_ = numbers != nullptr;
        if (numbers) std::copy_n(numbers, report_.size(), report_.begin());
    }
    double motor_newton(int axis) override {
        const std::lock_guard lock(mutex_);
        return motors()(axis);
    }
    double handle_m(int axis) override {
        const std::lock_guard lock(mutex_);
        return omni_.true_position_m()(axis);
    }
    bool is_open() override {
        const std::lock_guard lock(mutex_);
        return is_open_;
    }
    bool is_running() override {
        const std::lock_guard lock(mutex_);
        return is_running_;
    }
    bool is_force_enabled() override {
        const std::lock_guard lock(mutex_);
        return is_force_enabled_;
    }
    int devices_opened() override {
        const std::lock_guard lock(mutex_);
        return opened_;
    }
    int violations() override {
        const std::lock_guard lock(mutex_);
        return violations_;
    }
    const char* first_violation() override { return first_violation_; }
    bool was_stopped_under_force() override {
        const std::lock_guard lock(mutex_);
        return stopped_under_force_;
    }

    // The library's side.
    hd::Handle init(const char* name) {
        const std::lock_guard lock(mutex_);
        if (is_open_) return fail(hd::already_initiated);
        if (!is_plugged_) return fail(name ? hd::bad_handle : hd::device_fault);
        is_open_ = true;
        ++opened_;
        return the_device;
    }
    void disable_device(hd::Handle handle) {
        const std::lock_guard lock(mutex_);
        if (handle != the_device || !is_open_) return raise(hd::bad_handle);
        if (is_running_ && callback_) violate("a device was given back under a running callback");
        is_open_ = is_force_enabled_ = false;
        newton_ = wanted_ = Vec3::Zero();
    }
    hd::Handle current() {
        const std::lock_guard lock(mutex_);
        return is_open_ ? the_device : hd::no_device;
    }
    void make_current(hd::Handle handle) {
        const std::lock_guard lock(mutex_);
        if (handle != the_device || !is_open_) raise(hd::bad_handle);
    }
    void begin(hd::Handle handle) {
        std::unique_lock lock(mutex_);
        if (std::this_thread::get_id() == scheduler_id_) {
            is_blocked_ = is_blocking_;
            wake_.notify_all();
            wake_.wait(lock, [&] { return !is_blocking_; });
            is_blocked_ = false;
            if (++frames_of_tick_ > 1) violate("more than one frame in a tick");
        } else if (is_running_) {
            violate("a frame of another thread than the scheduler's");
        }
        if (is_in_frame_) violate("a frame in a frame");
        is_in_frame_ = true;
        if (handle != the_device || !is_open_) return raise(hd::bad_handle);
        if (!is_plugged_) raise(hd::comm_error);
    }
    void end(hd::Handle) {
        const std::lock_guard lock(mutex_);
        if (!is_in_frame_) violate("a frame ended that had not begun");
        is_in_frame_ = false;
        if (is_plugged_) newton_ = wanted_;
        if (is_warm_) coming_.push_back(hd::warm_motors);
        for (; !coming_.empty(); coming_.pop_front()) {
            const hd::Code code = coming_.front();
            raise(code);
            // Its own limits make the library let go.
            if (code >= hd::warm_motors && code <= hd::force_error) is_force_enabled_ = false;
        }
    }
    hd::ErrorInfo error() {
        const std::lock_guard lock(mutex_);
        hd::ErrorInfo info{hd::success, 0, the_device};
        if (errors_.empty()) return info;
        info.code = errors_.front();
        errors_.pop_front();
        return info;
    }
    void enable(hd::Code capability, bool is_on) {
        const std::lock_guard lock(mutex_);
        if (!is_open_) return raise(hd::bad_handle);
        if (capability == hd::force_output) {
            is_force_enabled_ = is_on;
        } else if (capability != hd::max_force_clamping) {
            raise(hd::invalid_enum);
        }
    }
    void get(hd::Code parameter, int* value) {
        const std::lock_guard lock(mutex_);
        if (parameter == hd::current_buttons) {
            *value = buttons_;
        } else if (parameter == hd::update_rate) {
            *value = static_cast<int>(rate_hz_);
        } else if (parameter == hd::calibration_styles) {
            *value = static_cast<int>(hd::inkwell);
        } else {
            raise(hd::invalid_enum);
        }
    }
    void get(hd::Code parameter, double* values) {
        const std::lock_guard lock(mutex_);
        if (is_silent_ && parameter != hd::current_transform) return raise(hd::invalid_enum);
        if (parameter == hd::current_transform) {
            if (!is_in_frame_) violate("the transform was read outside of a frame");
            if (is_plugged_) write_transform(values);
        } else if (parameter == hd::usable_workspace) {
            for (int i = 0; i < 3; ++i) {
                values[i] = centre_mm[i] - half_mm[i];
                values[i + 3] = centre_mm[i] + half_mm[i];
            }
        } else if (parameter == hd::nominal_max_force) {
            *values = peak_newton;
        } else if (parameter == hd::nominal_max_continuous_force) {
            *values = continuous_newton;
        } else if (parameter == hd::nominal_max_stiffness) {
            *values = 0.5;
        } else if (parameter == hd::motor_temperature) {
            std::fill_n(values, 6, is_warm_ ? 1.0 : 0.25);
        } else {
            raise(hd::invalid_enum);
        }
    }
    void set(hd::Code parameter, const double* values) {
        const std::lock_guard lock(mutex_);
        if (parameter != hd::current_force) return raise(hd::invalid_enum);
        if (!is_in_frame_) violate("a force outside of a frame");
        const Vec3 force(values[0], values[1], values[2]);
        if (!force.allFinite()) return violate("a force that is no number");
        if (force.norm() > peak_newton * (1 + 1e-12)) violate("a force beyond the peak");
        wanted_ = force;
    }
    hd::Code check_calibration() {
        const std::lock_guard lock(mutex_);
        switch (calibration_) {
            case StubCalibration::Done:
                return hd::calibration_ok;
            case StubCalibration::NeedsInkwell:
                return hd::calibration_needs_hand;
            default:
                return hd::calibration_needs_update;
        }
    }
    void update_calibration(hd::Code style) {
        const std::lock_guard lock(mutex_);
        if (style != hd::inkwell) return raise(hd::invalid_value);
        const bool is_done = calibration_ == StubCalibration::NeedsUpdate ||
                             (calibration_ == StubCalibration::NeedsInkwell && is_in_inkwell_);
        if (is_done)
            calibration_ = StubCalibration::Done;
        else
            raise(hd::invalid_operation);
    }
    void set_rate(unsigned long rate_hz) {
        const std::lock_guard lock(mutex_);
        rate_hz_ = rate_hz;
    }
    hd::Schedule schedule(hd::Callback callback, void* data) {
        const std::lock_guard lock(mutex_);
        callback_ = callback;
        data_ = data;
        return the_schedule;
    }
    void unschedule(hd::Schedule schedule) {
        const std::lock_guard lock(mutex_);
        if (schedule != the_schedule) raise(hd::invalid_value);
        callback_ = nullptr;
    }
    void start() {
        const std::lock_guard lock(mutex_);
        if (is_running_) return;
        if (refused_starts_ > 0) {
            --refused_starts_;
            return raise(hd::timer_error);
        }
        is_running_ = true;
        is_stopping_ = false;
        thread_ = std::thread([this] { run(); });
        scheduler_id_ = thread_.get_id();
    }
    void stop() {
        {
            const std::lock_guard lock(mutex_);
            if (!is_running_) return;
            if (std::this_thread::get_id() == scheduler_id_) {
                return violate("the scheduler was stopped from its own thread");
            }
            stopped_under_force_ = stopped_under_force_ || motors() != Vec3::Zero();
            is_stopping_ = true;
            wake_.notify_all();
        }
        thread_.join();
        const std::lock_guard lock(mutex_);
        is_running_ = false;
        scheduler_id_ = {};
        wake_.notify_all();
    }

private:
    // With the mutex held.
    void raise(hd::Code code) { errors_.push_back(code); }
    hd::Handle fail(hd::Code code) {
        raise(code);
        return hd::no_device;
    }
    void violate(const char* what) {
        if (violations_++ == 0) first_violation_ = what;
    }
    Vec3 motors() const {
        const bool works = is_open_ && is_plugged_ && is_force_enabled_;
        return works ? newton_ : Vec3(Vec3::Zero());
    }
    // The stylus points up: its x is the world's y.
    void write_transform(double* values) {
        const Vec3 mm = 1e3 * omni_.read().position_m;
        const std::array<double, 16> numbers{0,
                                             1,
                                             0,
                                             0,
                                             -1,
                                             0,
                                             0,
                                             0,
                                             0,
                                             0,
                                             1,
                                             0,
                                             mm.x() + centre_mm[0],
                                             mm.y() + centre_mm[1],
                                             mm.z() + centre_mm[2],
                                             1};
        const std::array<double, 16>& from = is_reporting_ ? report_ : numbers;
        std::copy(from.begin(), from.end(), values);
    }

    void run() {
        std::unique_lock lock(mutex_);
        while (true) {
            wake_.wait(lock, [&] { return is_stopping_ || granted_ > 0 || runs_freely_; });
            if (is_stopping_) return;
            frames_of_tick_ = 0;
            if (const hd::Callback callback = callback_) {
                void* const data = data_;
                lock.unlock();
                const bool goes_on = callback(data) == hd::callback_continue;
                lock.lock();
                if (!goes_on) callback_ = nullptr;
            }
            omni_.write(motors());
            granted_ = std::max(0, granted_ - 1);
            wake_.notify_all();
            if (runs_freely_)
                wake_.wait_for(lock, std::chrono::milliseconds(1), [&] { return is_stopping_; });
        }
    }

    std::mutex mutex_;
    std::condition_variable wake_;
    std::thread thread_;
    std::thread::id scheduler_id_;
    EmulatedOmni omni_;
    std::deque<hd::Code> errors_, coming_;
    std::array<double, 16> report_{};
    hd::Callback callback_ = nullptr;
    void* data_ = nullptr;
    Vec3 wanted_ = Vec3::Zero(), newton_ = Vec3::Zero();
    StubCalibration calibration_ = StubCalibration::Done;
    unsigned long rate_hz_ = 500;
    int granted_ = 0, frames_of_tick_ = 0, buttons_ = 0;
    int opened_ = 0, refused_starts_ = 0, violations_ = 0;
    const char* first_violation_ = "";
    bool is_running_ = false, is_stopping_ = false, runs_freely_ = false;
    bool is_blocking_ = false, is_blocked_ = false;
    bool is_plugged_ = true, is_open_ = false, is_force_enabled_ = false, is_in_frame_ = false;
    bool is_in_inkwell_ = false, is_reporting_ = false, is_warm_ = false, is_silent_ = false;
    bool stopped_under_force_ = false;
};

// Never destroyed: a program may end while the scheduler runs.
std::vector<std::unique_ptr<Stub>>& stubs() {
    static auto& all = *new std::vector<std::unique_ptr<Stub>>;
    if (all.empty()) all.push_back(std::make_unique<Stub>());
    return all;
}

Stub& stub() { return *stubs().back(); }

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): the names are the library's.
#ifdef _WIN32
#define PALPA_EXPORT extern "C" __declspec(dllexport)
#else
#define PALPA_EXPORT extern "C" __attribute__((visibility("default")))
#endif

PALPA_EXPORT test::OpenHapticsStub* open_haptics_stub() {
    stubs().push_back(std::make_unique<Stub>());
    return &stub();
}

PALPA_EXPORT hd::Handle hdInitDevice(const char* name) { return stub().init(name); }
PALPA_EXPORT void hdDisableDevice(hd::Handle handle) { stub().disable_device(handle); }
PALPA_EXPORT hd::Handle hdGetCurrentDevice() { return stub().current(); }
PALPA_EXPORT void hdMakeCurrentDevice(hd::Handle handle) { stub().make_current(handle); }
PALPA_EXPORT void hdBeginFrame(hd::Handle handle) { stub().begin(handle); }
PALPA_EXPORT void hdEndFrame(hd::Handle handle) { stub().end(handle); }
PALPA_EXPORT hd::ErrorInfo hdGetError() { return stub().error(); }
PALPA_EXPORT void hdEnable(hd::Code capability) { stub().enable(capability, true); }
PALPA_EXPORT void hdDisable(hd::Code capability) { stub().enable(capability, false); }
PALPA_EXPORT void hdGetIntegerv(hd::Code parameter, int* value) { stub().get(parameter, value); }
PALPA_EXPORT void hdGetDoublev(hd::Code parameter, double* value) { stub().get(parameter, value); }
PALPA_EXPORT const char* hdGetString(hd::Code parameter) {
    return parameter == hd::model_type ? "emulated PHANTOM Omni" : "0000";
}
PALPA_EXPORT void hdSetDoublev(hd::Code parameter, const double* value) {
    stub().set(parameter, value);
}
PALPA_EXPORT hd::Code hdCheckCalibration() { return stub().check_calibration(); }
PALPA_EXPORT void hdUpdateCalibration(hd::Code style) { stub().update_calibration(style); }
PALPA_EXPORT void hdSetSchedulerRate(unsigned long rate_hz) { stub().set_rate(rate_hz); }
PALPA_EXPORT void hdStartScheduler() { stub().start(); }
PALPA_EXPORT void hdStopScheduler() { stub().stop(); }
PALPA_EXPORT hd::Schedule hdScheduleAsynchronous(hd::Callback callback, void* data,
                                                 unsigned short) {
    return stub().schedule(callback, data);
}
#ifndef PALPA_STUB_LACKS_A_FUNCTION
PALPA_EXPORT void hdUnschedule(hd::Schedule schedule) { stub().unschedule(schedule); }
#endif
// NOLINTEND(readability-identifier-naming)
