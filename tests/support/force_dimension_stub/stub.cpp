#include "tests/support/force_dimension_stub/stub.h"

#include "devices/emulated_omni.h"
#include "devices/force_dimension_library.h"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr dhd::Id the_device = 0;
constexpr int failed = -1;

// Everything under one mutex, as slow as it likes to be.
class Stub final : public test::ForceDimensionStub {
public:
    // PALPA_DHD_STUB in the environment, for programs that no test steps: words with commas
    // between.
    explicit Stub(bool runs_freely) : omni_(EmulatedOmniSettings{}), runs_freely_(runs_freely) {
        const char* const text = std::getenv("PALPA_DHD_STUB");
        const std::string words = "," + std::string(text ? text : "") + ",";
        const auto is_told = [&](const char* word) {
            return words.find("," + std::string(word) + ",") != std::string::npos;
        };
        is_plugged_ = !is_told("absent");
        needs_calibration_ = is_told("uncalibrated");
    }

    // The test's side.
    void step(int ticks) override {
        std::unique_lock lock(mutex_);
        if (!is_open_) return;
        granted_ += ticks;
        wake_.notify_all();
        wake_.wait(lock, [&] { return !is_open_ || (granted_ == 0 && is_waiting_); });
        granted_ = 0;
    }
    void run_freely() override {
        const std::lock_guard lock(mutex_);
        runs_freely_ = true;
        wake_.notify_all();
    }
    void plug(bool is_plugged) override {
        const std::lock_guard lock(mutex_);
        is_plugged_ = is_plugged;
    }
    void set_type(int type) override {
        const std::lock_guard lock(mutex_);
        type_ = type;
    }
    void fail(int positions) override {
        const std::lock_guard lock(mutex_);
        failing_ = positions;
    }
    void need_calibration(bool is_needed) override {
        const std::lock_guard lock(mutex_);
        needs_calibration_ = is_needed;
    }
    void switch_off(int cause) override {
        const std::lock_guard lock(mutex_);
        off_cause_ = cause;
    }
    void press_force_button() override {
        const std::lock_guard lock(mutex_);
        off_cause_ = 0;
    }
    void press(unsigned buttons) override {
        const std::lock_guard lock(mutex_);
        buttons_ = buttons;
    }
    void report(const double* place, const double* axes) override {
        const std::lock_guard lock(mutex_);
        is_reporting_ = place != nullptr;
        if (!place) return;
        std::copy_n(place, 3, place_.begin());
        std::copy_n(axes, 9, axes_.begin());
    }
    double motor_newton(int axis) override {
        const std::lock_guard lock(mutex_);
        return motors()[static_cast<std::size_t>(axis)];
    }
    double handle_m(int axis) override {
        const std::lock_guard lock(mutex_);
        return handle(omni_.true_position_m())[static_cast<std::size_t>(axis)];
    }
    bool is_open() override {
        const std::lock_guard lock(mutex_);
        return is_open_;
    }
    bool is_force_enabled() override {
        const std::lock_guard lock(mutex_);
        return is_force_enabled_;
    }
    bool is_gravity_compensated() override {
        const std::lock_guard lock(mutex_);
        return is_gravity_compensated_;
    }
    bool is_button_emulated() override {
        const std::lock_guard lock(mutex_);
        return is_button_emulated_;
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

    // The library's side.
    int open() {
        const std::lock_guard lock(mutex_);
        if (is_open_ || !is_plugged_) return failed;
        is_open_ = true;
        ++opened_;
        return the_device;
    }
    int close(dhd::Id id) {
        const std::lock_guard lock(mutex_);
        if (!is_known(id)) return failed;
        if (is_force_enabled_) violate("a device was closed with its motors on");
        is_open_ = is_gravity_compensated_ = is_button_emulated_ = false;
        force_ = {};
        wake_.notify_all();
        return 0;
    }
    int type(dhd::Id id) {
        const std::lock_guard lock(mutex_);
        return is_known(id) ? type_ : failed;
    }
    bool has_wrist(dhd::Id id) {
        const std::lock_guard lock(mutex_);
        return is_known(id) && type_ != dhd::omega_3 && type_ != dhd::falcon;
    }
    int enable_force(unsigned char value, dhd::Id id) {
        const std::lock_guard lock(mutex_);
        if (!is_known(id)) return failed;
        is_force_enabled_ = value == dhd::on;
        if (is_force_enabled_ && off_cause_ != dhd::off_by_button) off_cause_ = 0;
        return 0;
    }
    int compensate_gravity(int value, dhd::Id id) {
        const std::lock_guard lock(mutex_);
        if (!is_known(id)) return failed;
        is_gravity_compensated_ = value == dhd::on;
        return 0;
    }
    int emulate_button(unsigned char value, dhd::Id id) {
        const std::lock_guard lock(mutex_);
        if (!is_known(id)) return failed;
        is_button_emulated_ = value == dhd::on;
        return 0;
    }
    int status(int* values, dhd::Id id) {
        const std::lock_guard lock(mutex_);
        if (!is_known(id) || !is_plugged_) return failed;
        std::fill_n(values, 17, 0);
        values[dhd::status_reset] = needs_calibration_ ? 1 : 0;
        values[dhd::status_force] = is_force_enabled_ && off_cause_ == 0 ? 1 : 0;
        values[dhd::status_force_off_cause] = off_cause_;
        return 0;
    }
    unsigned buttons(dhd::Id id) {
        const std::lock_guard lock(mutex_);
        return is_known(id) ? buttons_ : 0;
    }
    int position(double* x, double* y, double* z, dhd::Id id) {
        std::unique_lock lock(mutex_);
        if (!is_known(id)) return failed;
        is_waiting_ = true;
        wake_.notify_all();
        wake_.wait(lock, [&] { return granted_ > 0 || runs_freely_; });
        is_waiting_ = false;
        granted_ = std::max(0, granted_ - 1);
        if (failing_ > 0) {
            --failing_;
            return failed;
        }
        if (!is_plugged_) return failed;
        const std::array<double, 3> place =
            is_reporting_ ? place_ : handle(omni_.read().position_m);
        *x = place[0], *y = place[1], *z = place[2];
        return 0;
    }
    int frame(double* x, double* y, double* z, double (*axes)[3], dhd::Id id) {
        const int answer = position(x, y, z, id);
        const std::lock_guard lock(mutex_);
        for (std::size_t i = 0; i < 9; ++i) {
            const bool is_diagonal = i % 4 == 0;
            axes[i / 3][i % 3] = is_reporting_ ? axes_[i] : is_diagonal ? 1 : 0;
        }
        return answer;
    }
    int set_force(double x, double y, double z, dhd::Id id) {
        const std::lock_guard lock(mutex_);
        if (!is_known(id)) return failed;
        force_ = {x, y, z};
        if (!Vec3(x, y, z).allFinite()) violate("a force that is no number");
        if (!is_plugged_) return failed;
        // To the right is the library's y, and so on.
        const std::array<double, 3> now = motors();
        omni_.write({now[1], now[2], now[0]});
        return 0;
    }
    const char* error() {
        const std::lock_guard lock(mutex_);
        return is_plugged_ ? "device is in use" : "no device found";
    }

private:
    // With the mutex held.
    bool is_known(dhd::Id id) {
        if (id == the_device && is_open_) return true;
        violate("a call to a device that is not open");
        return false;
    }
    void violate(const char* what) {
        if (violations_++ == 0) first_violation_ = what;
    }
    std::array<double, 3> motors() const {
        const bool works = is_open_ && is_plugged_ && is_force_enabled_ && off_cause_ == 0;
        return works ? force_ : std::array<double, 3>{};
    }
    static std::array<double, 3> handle(const Vec3& place) {
        return {place.z(), place.x(), place.y()};
    }

    std::mutex mutex_;
    std::condition_variable wake_;
    EmulatedOmni omni_;
    std::array<double, 3> force_{}, place_{};
    std::array<double, 9> axes_{};
    int type_ = dhd::omega_3;
    int granted_ = 0, failing_ = 0, off_cause_ = 0, opened_ = 0, violations_ = 0;
    unsigned buttons_ = 0;
    const char* first_violation_ = "";
    bool runs_freely_, is_waiting_ = false, is_plugged_ = true, is_open_ = false;
    bool is_force_enabled_ = false, is_gravity_compensated_ = false, is_button_emulated_ = false;
    bool needs_calibration_ = false, is_reporting_ = false;
};

// Never destroyed: a program may end while a device is open.
std::vector<std::unique_ptr<Stub>>& stubs() {
    static auto& all = *new std::vector<std::unique_ptr<Stub>>;
    if (all.empty()) all.push_back(std::make_unique<Stub>(true));
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

PALPA_EXPORT test::ForceDimensionStub* force_dimension_stub() {
    stubs().push_back(std::make_unique<Stub>(false));
    return &stub();
}

PALPA_EXPORT int dhdOpen() { return stub().open(); }
PALPA_EXPORT int dhdClose(dhd::Id id) { return stub().close(id); }
PALPA_EXPORT int dhdGetSystemType(dhd::Id id) { return stub().type(id); }
PALPA_EXPORT const char* dhdGetSystemName(dhd::Id) { return "emulated omega"; }
PALPA_EXPORT bool dhdHasWrist(dhd::Id id) { return stub().has_wrist(id); }
PALPA_EXPORT int dhdEnableForce(unsigned char value, dhd::Id id) {
    return stub().enable_force(value, id);
}
PALPA_EXPORT int dhdSetGravityCompensation(int value, dhd::Id id) {
    return stub().compensate_gravity(value, id);
}
PALPA_EXPORT int dhdEmulateButton(unsigned char value, dhd::Id id) {
    return stub().emulate_button(value, id);
}
PALPA_EXPORT int dhdGetStatus(int* status, dhd::Id id) { return stub().status(status, id); }
PALPA_EXPORT unsigned int dhdGetButtonMask(dhd::Id id) { return stub().buttons(id); }
PALPA_EXPORT int dhdGetPosition(double* x, double* y, double* z, dhd::Id id) {
    return stub().position(x, y, z, id);
}
PALPA_EXPORT int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z,
                                                   double (*axes)[3], dhd::Id id) {
    return stub().frame(x, y, z, axes, id);
}
#ifndef PALPA_STUB_LACKS_A_FUNCTION
PALPA_EXPORT int dhdSetForce(double x, double y, double z, dhd::Id id) {
    return stub().set_force(x, y, z, id);
}
#endif
PALPA_EXPORT const char* dhdErrorGetLastStr() { return stub().error(); }
// NOLINTEND(readability-identifier-naming)
