// A real device in a live session: whatever goes wrong, in whatever mode, takes its force away. On
// a clock that does not depend on the machine.
#include "app/live_session.h"
#include "core/load_error.h"
#include "devices/emulated_omni.h"
#include "devices/mouse_handle.h"
#include "devices/played_handle.h"
#include "haptics/safety.h"
#include "loading/load.h"
#include "session/run_headless.h"
#include "simulation/grip_queries.h"
#include "tests/app/virtual_clock.h"
#include "tests/support/water_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace palpa;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr int period_ms = 14;

struct Setting {
    DeviceReading& reading;
    const DeviceReading& before;  // the last one without the fault
    int ticks;                    // since it began
    test::VirtualClock& clock;
};

struct Fault {
    std::string name;
    int most_ticks;  // with a force, after it began
    SafetyStage stage;
    std::function<void(const Setting&)> act;
    bool lowers_clamp = false;
};

std::vector<Fault> list_faults() {
    using std::chrono::microseconds;
    return {
        {"unplugged", 10, SafetyStage::Unplugged,
         [](const Setting& s) { s.reading.valid = false; }},
        {"position is no number", 10, SafetyStage::Unplugged,
         [](const Setting& s) { s.reading.position_m.z() = no_number; }},
        {"time stamp is no number", 10, SafetyStage::Unplugged,
         [](const Setting& s) { s.reading.time_s = no_number; }},
        {"turn is no number", 10, SafetyStage::Unplugged,
         [](const Setting& s) { s.reading.orientation.y() = no_number; }},
        {"jump by 6 mm", 1, SafetyStage::Jump,
         [](const Setting& s) { s.reading.position_m.y() += 6e-3; }},
        {"3 m/s", 10, SafetyStage::TooFast,
         [](const Setting& s) { s.reading.position_m.y() += 3e-3 * s.ticks; }},
        // The order to lower the clamp, which changes the force, takes two periods at most.
        {"frozen", 50 + 2 * period_ms, SafetyStage::Frozen,
         [](const Setting& s) { s.reading = s.before; }, true},
        {"a tick 25 ms late", 1, SafetyStage::Late,
         [](const Setting& s) { s.clock.delay_ticks(microseconds(s.ticks == 1 ? 25'000 : 0)); }},
        {"ticks of 19.9 ms", 25, SafetyStage::Late,  // half a second
         [](const Setting& s) { s.clock.delay_ticks(microseconds(18'900)); }},
        {"dead simulation", 200, SafetyStage::Stale,
         [](const Setting& s) { s.clock.leave_servo_alone(); }},
        {"warm motors", 100, SafetyStage::CoolDown,
         [](const Setting& s) { s.reading.trouble = DeviceTrouble::WarmMotors; }},
        {"refused", 1, SafetyStage::Refused,
         [](const Setting& s) { s.reading.trouble = DeviceTrouble::ForceRefused; }},
    };
}

// Goes inward once the ramp is over, until half a newton is felt or for 12 cm, rests there by an
// encoder step more or less, and then breaks.
class FakeOmni final : public Device {
public:
    FakeOmni(const SceneDescription& scene, const Fault& fault, test::VirtualClock& clock)
        : scene_(scene), fault_(fault), clock_(clock) {
        spec_.name = "fake Omni";
        spec_.peak_force_newton = 3.3;
        spec_.continuous_force_newton = 0.88;
        spec_.half_workspace_m = Vec3::Constant(0.5);
    }

    const DeviceSpec& spec() const noexcept override { return spec_; }

    DeviceReading read() noexcept override {
        constexpr double m_per_s = 0.05, farthest_m = 0.12, encoder_step_m = 55e-6;
        constexpr int settled_ticks = 3000, rest_ticks = 300;
        ++tick_;
        if (tick_ > settled_ticks && rested_ == 0) x_m_ -= m_per_s * servo_tick_s;
        if (written_newton_.norm() > 0.5 || x_m_ < -farthest_m || rested_ > 0) ++rested_;
        if (rested_ == rest_ticks && fault_.lowers_clamp) lower_clamp(*session.load());
        DeviceReading reading;
        reading.time_s = tick_ * servo_tick_s;
        reading.position_m = Vec3(x_m_, 0, tick_ % 2 == 0 ? 0 : encoder_step_m);
        reading.valid = true;
        is_broken_ = rested_ >= rest_ticks;
        if (!is_broken_) {
            before_ = reading;
            return reading;
        }
        if (rested_ == rest_ticks) before_newton = written_newton_.norm();
        fault_.act({reading, before_, rested_ - rest_ticks + 1, clock_});
        return reading;
    }

    void write(const Vec3& force_newton) noexcept override {
        constexpr std::size_t watched_ticks = 800;
        written_newton_ = force_newton;
        if (!is_broken_ || is_over) return;
        forces_newton.push_back(force_newton.norm());
        if (forces_newton.size() < watched_ticks) return;
        clock_.delay_ticks(std::chrono::microseconds(0));
        clock_.leave_servo_alone();
        is_over = true;
        is_over.notify_all();
    }

    std::atomic<LiveSession*> session{nullptr};  // set long before the fault
    double before_newton = 0;
    std::vector<double> forces_newton;  // since the fault; the test's once it is over
    std::atomic<bool> is_over{false};

private:
    void lower_clamp(LiveSession& live) const {
        LiveSettings settings{scene_.coupling, scene_.period_ms};
        settings.coupling.clamp_N = 0.3;
        live.send(settings);
    }

    const SceneDescription& scene_;
    const Fault& fault_;
    test::VirtualClock& clock_;
    DeviceSpec spec_;
    DeviceReading before_;
    Vec3 written_newton_ = Vec3::Zero();
    double x_m_ = 0;
    int tick_ = 0, rested_ = 0;
    bool is_broken_ = false;
};

struct Outcome {
    double before_newton = 0;
    int felt_ticks = 0;     // after the fault
    bool stays_off = true;  // from there on
    bool is_full = true;
    std::vector<SafetyStage> stages;
};

Outcome break_device(const SceneDescription& scene, const Fault& fault) {
    test::VirtualClock clock;
    FakeOmni device(scene, fault, clock);
    Outcome outcome;
    LiveSession session(scene, {}, device, nullptr, &clock);
    device.session = &session;
    device.is_over.wait(false);
    constexpr int most_ticks = 8000;  // the servo goes on meanwhile
    ServoTick tick;
    for (int i = 0; i < most_ticks && session.pop_ticks({&tick, 1}); ++i) {
        outcome.is_full = outcome.is_full && tick.is_safety_full;
        outcome.stages.push_back(tick.stage);
    }
    const std::vector<double>& forces = device.forces_newton;
    outcome.before_newton = device.before_newton;
    const auto off = std::ranges::find(forces, 0.0);
    outcome.felt_ticks = static_cast<int>(off - forces.begin());
    outcome.stays_off = std::all_of(off, forces.end(), [](double newton) { return newton == 0; });
    return outcome;
}

}  // namespace

TEST_CASE("every fault of a real device takes its force away in every mode", "[app][threads]") {
    const std::array<std::string, 6> modes{"1", "2", "3", "4", "5", "guarded"};
    std::string table = fmt::format("{:32}", "ticks to zero force, in mode");
    for (const std::string& mode : modes) table += fmt::format("{:>9}", mode);
    for (const Fault& fault : list_faults()) {
        table += fmt::format("\n{:24} (<= {:3})", fault.name, fault.most_ticks);
        for (const std::string& mode : modes) {
            INFO(fault.name << " in mode " << mode);
            const SceneDescription scene = test::water_scene(
                {"mode=" + mode, fmt::format("period_ms={}", period_ms), "A_f=2e9"});

            const Outcome outcome = break_device(scene, fault);

            table += fmt::format("{:>9}", outcome.felt_ticks);
            CHECK((outcome.before_newton > 0.5) == (mode != "5"));
            CHECK(outcome.felt_ticks <= fault.most_ticks);
            CHECK(outcome.stays_off);
            CHECK(outcome.is_full);
            // Where no force changes nothing shows that a reading hangs.
            if (mode != "5" || !fault.lowers_clamp)
                CHECK(std::ranges::count(outcome.stages, fault.stage) > 0);
        }
    }
    fmt::print("{}\n", table);
}

TEST_CASE("the paper's chain alone is for devices that are not real", "[app][threads]") {
    test::VirtualClock clock;
    const Fault never{"", 0, SafetyStage::None, [](const Setting&) {}};
    const SceneDescription scene = test::water_scene({"mode=2"});
    FakeOmni real(scene, never, clock);
    EmulatedOmni emulated{EmulatedOmniSettings{}};
    MouseHandle mouse{MouseHandleSettings{}};
    const PlayedHandle played{PlayedHandleSettings{}};
    const World world = load_world(scene);
    const auto has_whole_chain = [&](const Device& device) {
        return build_servo_settings(scene, world, 0, device.spec()).safety.is_full;
    };

    CHECK(has_whole_chain(real));
    CHECK_FALSE(has_whole_chain(emulated));
    CHECK_FALSE(has_whole_chain(mouse));
    CHECK_FALSE(has_whole_chain(played));
    CHECK(DeviceSpec{}.is_real);  // what a device forgets to say is safe
}

TEST_CASE("a real device with motors refuses periods above a second", "[app][threads]") {
    const Fault never{"", 0, SafetyStage::None, [](const Setting&) {}};
    const SceneDescription slow = test::water_scene({"mode=2", "period_ms=1001"});
    const SceneDescription good = test::water_scene({"mode=2", "period_ms=1000"});
    test::VirtualClock clock;
    FakeOmni real(good, never, clock);
    EmulatedOmni emulated{EmulatedOmniSettings{}};

    const auto start = [](const SceneDescription& scene, Device& device) {
        return std::make_unique<LiveSession>(scene, ViewSettings{}, device, nullptr);
    };

    CHECK_THROWS_WITH(start(slow, real),
                      Catch::Contains("at most 1000 ms with a device that has motors"));
    CHECK_NOTHROW(start(good, real));
    CHECK_THROWS_AS(start(slow, emulated)->change_device(real, nullptr), LoadError);
    World world = load_world(slow);
    CHECK_THROWS_AS(run_headless(slow, world, real, {}, nullptr, {}), LoadError);
}

TEST_CASE("a period that a real device refuses is not set while it runs", "[app][threads]") {
    const Fault never{"", 0, SafetyStage::None, [](const Setting&) {}};
    const SceneDescription scene = test::water_scene({"mode=2"});
    test::VirtualClock clock;
    FakeOmni real(scene, never, clock);
    LiveSession session(scene, {}, real, nullptr);

    session.send(LiveSettings{scene.coupling, 2000});
    LiveFrame frame;
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (frame.readout.problem.empty() && std::chrono::steady_clock::now() < patience) {
        (void)session.read_frame(frame);
    }

    CHECK_THAT(frame.readout.problem, Catch::Contains("at most 1000 ms"));
    CHECK(frame.readout.contact.period_s == scene.period_ms * 1e-3);
}
