// Servo and simulation on their own threads: what is asked happens, in its order, and nothing
// races. No test here says how fast; they wait until something is so.
#include "app/live_session.h"

#include "devices/emulated_omni.h"
#include "devices/mouse_handle.h"
#include "haptics/hand.h"
#include "simulation/step.h"
#include "tests/support/water_scene.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

using namespace palpa;

namespace {

// An emulated Omni whose servo cycles other threads can count: so they wait for what happens, and
// not for a time.
class CountedOmni : public Device {
public:
    explicit CountedOmni(const EmulatedOmniSettings& settings) : omni_(settings) {}

    const DeviceSpec& spec() const noexcept override { return omni_.spec(); }
    DeviceReading read() noexcept override { return omni_.read(); }
    void show(const TouchModel& touch) noexcept override { omni_.show(touch); }
    void write(const Vec3& force_newton) noexcept override {
        omni_.write(force_newton);
        const DeviceReading reading = omni_.read();
        time_s_ = reading.time_s;
        handle_m_ = reading.position_m.x();
        ++cycles_;
    }

    std::uint64_t cycles() const noexcept { return cycles_; }
    double time_s() const noexcept { return time_s_; }
    double handle_m() const noexcept { return handle_m_; }

private:
    EmulatedOmni omni_;
    std::atomic<double> time_s_{0}, handle_m_{0};
    std::atomic<std::uint64_t> cycles_{0};
};

// A live session of the water scene, with a mouse's hand on the handle or one that follows a path,
// which is to the session like any device.
struct Live {
    explicit Live(const std::vector<std::string>& settings = {})
        : device(make_settings(&orders)),
          session(test::water_scene(settings), {}, device, &orders) {}
    Live(const std::vector<std::string>& settings, const std::vector<HandWaypoint>& path)
        : device(make_settings(path)), session(test::water_scene(settings), {}, device, nullptr) {}

    static EmulatedOmniSettings make_settings(HandOrders* orders) {
        EmulatedOmniSettings settings;
        settings.hand = hand_model(Grip::Medium);
        settings.orders = orders;
        settings.driver = HandDriver::Mouse;
        settings.half_workspace_m = Vec3::Constant(0.5);
        return settings;
    }

    static EmulatedOmniSettings make_settings(const std::vector<HandWaypoint>& path) {
        EmulatedOmniSettings settings;
        settings.hand = hand_model(Grip::Medium);
        settings.script.path = path;
        return settings;
    }

    // Looks again and again until it is so; a minute is for machines that do other things as well.
    bool wait_until(const std::function<bool(const LiveFrame&)>& is_so) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (std::chrono::steady_clock::now() < end) {
            for (ServoTick tick; session.pop_tick(tick);) last = tick;
            if (session.read_frame(frame) && is_so(frame)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }
    bool wait_for_steps(std::uint64_t more) {
        const std::uint64_t from = frame.readout.steps;
        return wait_until([&](const LiveFrame& f) { return f.readout.steps >= from + more; });
    }
    // The servo's and the simulation's loops have gone round so often after this call began.
    bool wait_for_rounds(int rounds) {
        const std::uint64_t from = device.cycles();
        for (int i = 0; i < rounds; ++i) {
            if (!wait_until([](const LiveFrame&) { return true; })) return false;
        }
        return wait_until([&](const LiveFrame&) {
            return device.cycles() > from + static_cast<std::uint64_t>(rounds);
        });
    }
    double distance() const { return frame.readout.touch.molecule.place_angstrom.x(); }

    HandOrders orders;
    CountedOmni device;
    LiveSession session;
    LiveFrame frame;
    ServoTick last;
};

}  // namespace

TEST_CASE("the mouse's hand draws the molecule near, and the hand feels it", "[app][threads]") {
    Live live({"mode=2"});
    REQUIRE(live.wait_for_steps(10));
    CHECK(live.distance() == Approx(7).margin(0.01));
    CHECK(live.frame.picture.spheres.size() == 6);

    live.session.move_hand(Vec3(-0.0925, 0, 0));  // 3.7 Å at 2.5 cm/Å

    CHECK(live.wait_until([&](const LiveFrame&) { return live.distance() < 3.5; }));
    CHECK(live.wait_until([&](const LiveFrame&) { return live.last.sent_newton.x() < -0.5; }));
    CHECK(live.frame.grabbed_angstrom.x() - live.distance() == Approx(0).margin(1e-9));
}

TEST_CASE("another device takes hold of the molecule where it is", "[app][threads]") {
    const std::string mode = GENERATE("mode=guarded", "mode=2");
    Live live({mode});
    REQUIRE(live.wait_until([&](const LiveFrame&) {  // waited, risen
        return live.last.reading.time_s > 1 && live.last.stage == SafetyStage::None;
    }));
    live.session.move_hand(Vec3(-0.0975, 0, 0));  // 3.9 Å at 2.5 cm/Å
    REQUIRE(live.wait_until([&](const LiveFrame&) { return live.last.sent_newton.x() < -0.5; }));
    HandOrders orders;
    MouseHandle mouse({.orders = &orders});

    live.session.change_device(mouse, &orders);
    // No force before the hand was quiet; in paper mode as soon as it rests. Ticks of the device
    // before come first, whose clock is further on.
    double strongest = 0, time_s = 1;
    int without_force = 0;
    for (bool is_other = false; !is_other || time_s < 0.3;) {
        ServoTick tick;
        if (!live.session.pop_tick(tick)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            continue;
        }
        time_s = tick.reading.time_s;
        is_other = is_other || time_s < 0.5;
        if (!is_other || (mode == "mode=2" && !tick.touch.is_still)) continue;
        strongest = std::max(strongest, tick.sent_newton.norm());
        ++without_force;
    }
    CHECK(strongest == 0);
    CHECK(without_force > 0);
    REQUIRE(live.wait_for_steps(1));
    const double there = live.distance();
    CHECK(there < 5);
    ServoTick later;  // the very one: a slow machine's newest frame may be seconds on
    while (!(later.reading.time_s > 1)) {
        if (!live.session.pop_tick(later))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK((later.sent_newton.x() < -0.2) == (mode == "mode=2"));
    CHECK(live.distance() == Approx(there).margin(0.3));

    live.session.move_hand(Vec3(0.075, 0, 0));  // 3 Å outward
    CHECK(live.wait_until([&](const LiveFrame&) {
        return live.distance() > there + 2 && live.last.stage == SafetyStage::None;
    }));
    live.session.change_device(live.device, &live.orders);  // which outlives the session
}

TEST_CASE("while paused nothing moves and going on nothing jumps", "[app][threads]") {
    Live live({"mode=2", "start_angstrom=3.1"});
    REQUIRE(live.wait_until([&](const LiveFrame&) { return live.last.sent_newton.x() < -0.5; }));
    live.session.send(Pause{true});
    REQUIRE(live.wait_until([](const LiveFrame& f) { return f.readout.paused; }));
    REQUIRE(live.wait_for_rounds(2));  // the handle stands still as well
    const double there = live.distance();
    const double handle = live.device.handle_m(), time_s = live.device.time_s();
    const std::uint64_t steps = live.frame.readout.steps;
    live.session.move_hand(Vec3(0.2, 0, 0));
    REQUIRE(live.wait_for_rounds(50));
    CHECK(live.distance() == there);
    CHECK(live.frame.readout.steps == steps);
    CHECK(live.device.handle_m() == handle);
    CHECK(live.device.time_s() == time_s);

    live.session.send(StepOnce{});
    REQUIRE(live.wait_until([&](const LiveFrame& f) { return f.readout.steps == steps + 1; }));
    REQUIRE(live.wait_for_rounds(50));
    // The ticks of one period, and not one more.
    CHECK(live.device.time_s() ==
          Approx(time_s + live.frame.readout.touch.period_s).margin(0.1 * servo_tick_s));
    CHECK(live.frame.readout.paused);
    CHECK(live.distance() == Approx(there).margin(0.02));

    live.session.send(Pause{false});
    REQUIRE(live.wait_for_steps(2));
    CHECK(live.distance() == Approx(there).margin(0.1));  // not 8 Å further on
}

TEST_CASE("a device that goes on while paused moves nothing and feels nothing", "[app][threads]") {
    const std::string mode = GENERATE("mode=guarded", "mode=2");
    Live live({mode, "start_angstrom=3.1", "period_ms=14"}, {{0, 0}, {1.5, 0}, {2.5, 0.04}});
    REQUIRE(live.wait_until([&](const LiveFrame&) { return live.last.reading.time_s > 0.5; }));
    live.session.send(Pause{true});
    REQUIRE(live.wait_until([](const LiveFrame& f) { return f.readout.paused; }));
    const double there = live.distance();
    const std::uint64_t steps = live.frame.readout.steps;

    REQUIRE(live.wait_until([&](const LiveFrame&) { return live.last.reading.time_s > 3; }));
    CHECK(live.last.reading.position_m.x() > 0.03);
    CHECK(live.distance() == there);
    CHECK(live.last.sent_newton.norm() < 0.05);  // but for the damping
    live.session.send(StepOnce{});
    REQUIRE(live.wait_until([&](const LiveFrame& f) { return f.readout.steps == steps + 1; }));
    CHECK(live.frame.readout.paused);
    CHECK(live.distance() == Approx(there).margin(0.02));

    live.session.send(Pause{false});
    REQUIRE(live.wait_for_steps(20));
    // The bond pulls again, and the hand, which stands still, yields a little: 4 cm would be 1 Å.
    CHECK(live.distance() == Approx(there).margin(0.3));
}

TEST_CASE("a push on the wall stays outside of it, and a reset brings the start back",
          "[app][threads]") {
    Live live;
    REQUIRE(live.wait_for_steps(2));
    live.session.move_hand(Vec3(-1, 0, 0));  // far beyond
    REQUIRE(live.wait_until([&](const LiveFrame&) { return live.distance() < 2.6; }));
    double closest = live.distance(), strongest = 0;
    const double begin = live.last.reading.time_s;
    REQUIRE(live.wait_until([&](const LiveFrame& f) {
        closest = std::min(closest, live.distance());
        strongest = std::max(strongest, f.readout.touch.force_newton.norm());
        return live.last.reading.time_s > begin + 2;
    }));
    CHECK(closest > 2.2);
    CHECK(strongest < 20e-9);

    live.session.move_hand(live.last.reading.position_m);
    live.session.send(Reset{});
    REQUIRE(live.wait_until([&](const LiveFrame&) { return live.distance() > 6; }));
    // The hand was still pushed when the reset came, by some ticks more or less, and goes back.
    const auto wait_a_second = [&] {
        const double now_s = live.last.reading.time_s;
        return live.wait_until(
            [&](const LiveFrame&) { return live.last.reading.time_s > now_s + 1; });
    };
    REQUIRE(wait_a_second());
    CHECK(live.distance() == Approx(7).margin(0.3));
    live.session.send(Reset{});
    REQUIRE(wait_a_second());
    CHECK(live.distance() == Approx(7).margin(0.01));
}

TEST_CASE("settings, view and reset reach the running scene", "[app][threads]") {
    Live live;
    LiveSettings settings{test::water_scene().coupling, 5};
    settings.coupling.displacement_law = DisplacementLawChoice::Constant;
    settings.coupling.A_d = 1e9;
    live.session.send(settings);
    live.session.send(
        ViewSettings{.representation = Representation::SpaceFilling, .force_arrow = false});
    REQUIRE(live.wait_until([](const LiveFrame& f) {
        return f.readout.touch.period_s == 0.005 && f.readout.touch.displacement_gain == 1e9 &&
               f.picture.cones.empty();
    }));

    live.session.move_hand(Vec3(-0.2, 0, 0));
    REQUIRE(live.wait_until([&](const LiveFrame&) { return live.distance() < 5.5; }));
    live.session.send(Reset{});
    CHECK(live.wait_until([&](const LiveFrame&) { return live.distance() > 6.5; }));
    CHECK(live.frame.readout.touch.displacement_gain == 1e9);  // the settings stay
    CHECK(live.frame.readout.problem.empty());
}
