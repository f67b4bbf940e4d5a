// Servo and simulation on their own threads: what is asked happens, in its order, and nothing
// races. No test here says how fast; they wait until something is so.
#include "app/live_session.h"

#include "devices/emulated_omni.h"
#include "devices/mouse_handle.h"
#include "haptics/hand.h"
#include "scene/read_scene.h"
#include "simulation/step.h"
#include "tests/app/virtual_clock.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/water_scene.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
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
    void show(const ContactModel& contact, const Vec3& waiting_m) noexcept override {
        omni_.show(contact, waiting_m);
    }
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
        settings.hand = hand_model(HandGrip::Medium);
        settings.orders = orders;
        settings.driver = HandDriver::Mouse;
        settings.half_workspace_m = Vec3::Constant(0.5);
        return settings;
    }

    static EmulatedOmniSettings make_settings(const std::vector<HandWaypoint>& path) {
        EmulatedOmniSettings settings;
        settings.hand = hand_model(HandGrip::Medium);
        settings.script.path = path;
        return settings;
    }

    // Looks again and again until it is so; a minute is for machines that do other things as well.
    bool wait_until(const std::function<bool(const LiveFrame&)>& is_so) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (std::chrono::steady_clock::now() < end) {
            for (ServoTick tick; session.pop_ticks({&tick, 1});) last = tick;
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
    double distance() const { return frame.readout.contact.molecule.place_angstrom.x(); }

    HandOrders orders;
    CountedOmni device;
    LiveSession session;
    LiveFrame frame;
    ServoTick last;
};

// A hand that brings the molecule in until half a newton is felt, rests, takes what it is told to
// take, rests, goes outward for the molecule on the other side, and rests. Real as devices are: the
// whole chain acts.
class TakingHand final : public Device {
public:
    enum class Part { Settling, Approach, Resting, Taken, Away, Over };

    TakingHand(const std::vector<EditAction>& edits, test::VirtualClock& clock)
        : edits_(edits), clock_(clock) {
        spec_.name = "fake Omni";
        spec_.peak_force_newton = 3.3;
        spec_.continuous_force_newton = 0.88;
        spec_.half_workspace_m = Vec3::Constant(0.5);
    }

    const DeviceSpec& spec() const noexcept override { return spec_; }

    DeviceReading read() noexcept override {
        constexpr double m_per_s = 0.05, encoder_step_m = 55e-6;
        constexpr int settled_ticks = 3000, rest_ticks = 400, away_ticks = 1000;
        ++ticks_;
        ++part_ticks_;
        switch (part_) {
            case Part::Settling:
                if (ticks_ > settled_ticks) go_to(Part::Approach);
                break;
            case Part::Approach:
                x_m_ -= m_per_s * servo_tick_s;
                if (written_newton_.norm() > 0.5) go_to(Part::Resting);
                break;
            case Part::Resting:
                if (part_ticks_ < rest_ticks) break;
                before_newton = written_newton_;
                for (const EditAction& edit : edits_)
                    session.load()->send(EditDescription{0, 0, edit, {"not done"}});
                go_to(Part::Taken);
                break;
            case Part::Taken:
                if (part_ticks_ == 2 * rest_ticks) after_newton = written_newton_;
                if (part_ticks_ > 2 * rest_ticks) go_to(Part::Away);
                break;
            case Part::Away:
                if (part_ticks_ < away_ticks) {
                    x_m_ -= m_per_s * servo_tick_s;
                } else if (part_ticks_ > away_ticks + rest_ticks) {
                    go_to(Part::Over);
                    clock_.leave_servo_alone();
                    is_over = true;
                    is_over.notify_all();
                }
                break;
            case Part::Over:
                break;
        }
        DeviceReading reading;
        reading.time_s = ticks_ * servo_tick_s;
        reading.position_m = Vec3(x_m_, 0, ticks_ % 2 == 0 ? 0 : encoder_step_m);
        reading.valid = true;
        return reading;
    }

    void write(const Vec3& force_newton) noexcept override {
        const double change = (force_newton - written_newton_).norm();
        written_newton_ = force_newton;
        if (part_ >= Part::Taken && part_ < Part::Over)
            largest_change_newton = std::max(largest_change_newton, change);
    }

    std::atomic<LiveSession*> session{nullptr};
    std::atomic<bool> is_over{false};
    // The test's once it is over.
    Vec3 before_newton = Vec3::Zero(), after_newton = Vec3::Zero();
    double largest_change_newton = 0;  // from one tick to the next, since the edits

private:
    void go_to(Part part) {
        part_ = part;
        part_ticks_ = 0;
    }

    const std::vector<EditAction> edits_;
    test::VirtualClock& clock_;
    DeviceSpec spec_;
    Part part_ = Part::Settling;
    int ticks_ = 0, part_ticks_ = 0;
    double x_m_ = 0;
    Vec3 written_newton_ = Vec3::Zero();
};

// The hand's course with these edits, and the frame at its end.
LiveFrame run_course(TakingHand& hand, test::VirtualClock& clock) {
    LiveFrame frame;
    LiveSession session(test::water_scene({"mode=guarded", "period_ms=14"}), {}, hand, nullptr,
                        &clock);
    hand.session = &session;
    hand.is_over.wait(false);
    while (session.read_frame(frame)) continue;
    session.send(ViewSettings{.force_arrow = false, .hydrogen_bonds = ShownBonds::None});
    while (!session.read_frame(frame) || frame.picture.cones.size() > 4)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return frame;
}

Vec3 place_of(const LiveFrame& frame, const std::string& molecule) {
    for (const AtomDirectory::Entry& entry : frame.atoms->molecules) {
        if (entry.molecule != molecule) continue;
        const glm::vec3 place = shapes_of(frame.picture, entry.atoms).front().centre;
        return {place.x, place.y, place.z};
    }
    return Vec3::Constant(1e9);
}

// Lets the servo wait longer than asked after one of its ticks.
class LateOmni final : public Device {
public:
    static constexpr int late_tick = 100;

    LateOmni(test::VirtualClock& clock, std::chrono::microseconds late)
        : omni_(EmulatedOmniSettings{}), clock_(clock), late_(late) {}

    const DeviceSpec& spec() const noexcept override { return omni_.spec(); }
    DeviceReading read() noexcept override { return omni_.read(); }
    void write(const Vec3& force_newton) noexcept override {
        omni_.write(force_newton);
        ++ticks;
        if (ticks == late_tick) clock_.delay_ticks(late_);
        if (ticks == late_tick + 1) clock_.delay_ticks(std::chrono::microseconds(0));
    }

    std::atomic<int> ticks{0};

private:
    EmulatedOmni omni_;
    test::VirtualClock& clock_;
    std::chrono::microseconds late_;
};

}  // namespace

TEST_CASE("a frame has the legend of the colours that it shows", "[app][threads]") {
    Live live;
    REQUIRE(live.wait_until([](const LiveFrame& frame) { return !frame.picture.spheres.empty(); }));
    CHECK(live.frame.legend.empty());  // elements and chains are seen without

    live.session.send(ViewSettings{.colouring = Colouring::Charge});
    REQUIRE(live.wait_until([](const LiveFrame& frame) { return !frame.legend.empty(); }));
    CHECK(live.frame.legend.front().text.find("-1 e") == 0);
    live.session.send(ViewSettings{.colouring = Colouring::Element});
    CHECK(live.wait_until([](const LiveFrame& frame) { return frame.legend.empty(); }));
}

TEST_CASE("another molecule is taken while a force is felt, which glides, and it follows",
          "[app][threads]") {
    test::VirtualClock clock;
    TakingHand hand({GrabEdit{"fixed"}}, clock);
    const LiveFrame frame = run_course(hand, clock);

    CHECK(frame.readout.problem.empty());
    // Drawn to the other water before; now that one is drawn to the first.
    CHECK(hand.before_newton.x() < -0.4);
    CHECK(hand.after_newton.x() > 0.4);
    CHECK(hand.largest_change_newton < 0.05);  // the chain would let 0.5 pass
    CHECK(place_of(frame, "fixed").x() < -1);
    CHECK(frame.hands[0].grabbed_angstrom.x() == Approx(place_of(frame, "fixed").x()).margin(1e-4));
    CHECK(frame.hands[0].grabbed_angstrom.tail<2>().norm() < 0.5);
}

TEST_CASE("undo in the window gives back what was held, without a jump", "[app][threads]") {
    test::VirtualClock clock;
    TakingHand hand({GrabEdit{"fixed"}, UndoEdit{}}, clock);
    const LiveFrame frame = run_course(hand, clock);

    CHECK(frame.readout.problem.empty());
    CHECK(hand.after_newton.x() == Approx(hand.before_newton.x()).margin(0.1));
    CHECK(hand.largest_change_newton < 0.05);
    CHECK(place_of(frame, "fixed").norm() < 1e-6);
    // It went on inward, to the wall.
    CHECK(frame.hands[0].grabbed_angstrom.x() == Approx(place_of(frame, "moved").x()).margin(1e-4));
    CHECK(frame.hands[0].grabbed_angstrom.x() < 2.9);
}

TEST_CASE("a hand that lets go feels nothing and moves nothing", "[app][threads]") {
    test::VirtualClock clock;
    TakingHand hand({ReleaseEdit{}}, clock);
    const LiveFrame frame = run_course(hand, clock);

    CHECK(frame.readout.problem.empty());
    CHECK_FALSE(frame.readout.holds_something);
    CHECK(frame.hands[0].held.count == 0);
    CHECK(hand.after_newton.norm() == 0);
    CHECK(hand.largest_change_newton < 0.51);
    CHECK(place_of(frame, "moved").x() > 3);
}

TEST_CASE("an edit that cannot be made says why and changes nothing", "[app][threads]") {
    test::VirtualClock clock;
    TakingHand hand({GrabEdit{"third"}}, clock);
    const LiveFrame frame = run_course(hand, clock);

    CHECK(frame.readout.problem ==
          "not done: there is no molecule 'third'; there are fixed, moved");
    CHECK(frame.readout.refused_edits == 1);
    CHECK(hand.after_newton.x() == Approx(hand.before_newton.x()).margin(0.1));
    CHECK(frame.readout.holds_something);
}

TEST_CASE("a reset forgets edits, and another start is never one of before", "[app][threads]") {
    Live live;
    REQUIRE(live.wait_for_steps(2));
    const auto send = [&](EditAction action) {
        live.session.send(EditDescription{0, 0, std::move(action), {"not done"}});
    };
    const auto start = [&] { return live.frame.readout.contact.grip_number; };
    std::uint32_t last = start();
    for (const char* const name : {"fixed", "moved", "fixed"}) {
        send(GrabEdit{name});
        REQUIRE(live.wait_until([&](const LiveFrame&) { return start() != last; }));
        CHECK(start() > last);
        last = start();
    }
    live.session.send(Reset{});
    REQUIRE(live.wait_until([&](const LiveFrame&) { return start() != last; }));
    CHECK(start() > last);
    send(UndoEdit{});
    CHECK(live.wait_until([](const LiveFrame& f) {
        return f.readout.problem == "not done: there is nothing to undo";
    }));
}

TEST_CASE("the mouse's hand draws the molecule near, and the hand feels it", "[app][threads]") {
    Live live({"mode=2"});
    REQUIRE(live.wait_for_steps(10));
    CHECK(live.distance() == Approx(7).margin(0.01));
    CHECK(live.frame.picture.spheres.size() == 6);

    live.session.move_hand(Vec3(-0.0925, 0, 0));  // 3.7 Å at 2.5 cm/Å

    CHECK(live.wait_until([&](const LiveFrame&) { return live.distance() < 3.5; }));
    CHECK(live.wait_until([&](const LiveFrame&) { return live.last.sent_newton.x() < -0.5; }));
    CHECK(live.frame.hands[0].grabbed_angstrom.x() - live.distance() == Approx(0).margin(1e-9));
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
        if (!live.session.pop_ticks({&tick, 1})) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            continue;
        }
        time_s = tick.reading.time_s;
        is_other = is_other || time_s < 0.5;
        if (!is_other || (mode == "mode=2" && !tick.contact.is_still)) continue;
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
        if (!live.session.pop_ticks({&later, 1}))
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
          Approx(time_s + live.frame.readout.contact.period_s).margin(0.1 * servo_tick_s));
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
        strongest = std::max(strongest, f.readout.contact.force_newton.norm());
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
        return f.readout.contact.period_s == 0.005 && f.readout.contact.displacement_gain == 1e9 &&
               f.picture.cones.empty();
    }));

    live.session.move_hand(Vec3(-0.2, 0, 0));
    REQUIRE(live.wait_until([&](const LiveFrame&) { return live.distance() < 5.5; }));
    live.session.send(Reset{});
    CHECK(live.wait_until([&](const LiveFrame&) { return live.distance() > 6.5; }));
    CHECK(live.frame.readout.contact.displacement_gain == 1e9);  // the settings stay
    CHECK(live.frame.readout.problem.empty());
}

TEST_CASE("what is added is in the next frame, drawn or not, and what can be added with it",
          "[app][threads]") {
    Live live;
    REQUIRE(live.wait_for_steps(1));
    CHECK(live.frame.places.size() == 6);
    REQUIRE(live.frame.atoms->force_field);
    CHECK(live.frame.atoms->force_field->residues.contains("TIP3"));
    live.session.send(edit_now(AppearanceEdit{"fixed", {}, {}, false}));
    live.session.send(edit_now(AddEdit{"TIP3", "", "w2", {1, 8, 2}}));

    REQUIRE(live.wait_until([](const LiveFrame& f) { return f.atoms->names.size() == 9; }));

    const AtomDirectory::Entry* const added = find_molecule(*live.frame.atoms, "w2");
    REQUIRE(added);
    CHECK(added->atoms.first == 6);
    CHECK(added->reference_atom == 6);
    REQUIRE(live.frame.places.size() == 9);
    CHECK(live.frame.picture.spheres.size() == 6);
    CHECK(live.frame.places[6] == glm::vec3(1, 8, 2));
    CHECK(live.frame.places[0] == glm::vec3(0, 0, 0));
    live.session.send(edit_now(RemoveEdit{"fixed"}));
    REQUIRE(live.wait_until([](const LiveFrame& f) { return f.atoms->names.size() == 6; }));
    CHECK_FALSE(find_molecule(*live.frame.atoms, "fixed"));
    CHECK(find_molecule(*live.frame.atoms, "w2")->reference_atom == 3);
    CHECK(live.frame.places.size() == 6);
}

TEST_CASE("what the force field lacks of something added is named in the readout",
          "[app][threads]") {
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "water";
    std::filesystem::copy(test::in_project("scenes/water"), file);
    folder.add_file("water/more.str",
                    "* More\n*\nread rtf card append\n* More\n*\n36 1\n"
                    "RESI OXY 0.0\nATOM O1 OT 0.0\nATOM O2 OT 0.0\nBOND O1 O2\nEND\n");
    const SceneDescription scene = read_scene(
        file, std::vector<std::string>{R"(force_field.files=["tip3p.str", "more.str"])"});
    HandOrders orders;
    CountedOmni device(Live::make_settings(&orders));
    LiveSession session(scene, {}, device, &orders);
    LiveFrame frame;
    const auto wait_for_refused = [&](std::uint64_t count) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (std::chrono::steady_clock::now() < end) {
            if (session.read_frame(frame) && frame.readout.refused_edits == count) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    };

    session.send(edit_now(AddEdit{"OXY", "", "new", {0, 9, 0}}));
    REQUIRE(wait_for_refused(1));
    CHECK_THAT(frame.readout.problem, Catch::Contains("residue OXY: no bond parameters for OT OT"));
    session.send(edit_now(AddEdit{"NONE", "", "new", {0, 9, 0}}));
    REQUIRE(wait_for_refused(2));
    CHECK_THAT(frame.readout.problem,
               Catch::StartsWith("not done: ") && Catch::Contains("no residue 'NONE'"));
    CHECK(frame.atoms->names.size() == 6);
    session.send(edit_now(AddEdit{"TIP3", "", "new", {0, 9, 0}}));
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (frame.atoms->names.size() < 9 && std::chrono::steady_clock::now() < end)
        (void)session.read_frame(frame);
    CHECK(frame.atoms->names.size() == 9);
    CHECK(frame.readout.problem.empty());
}

TEST_CASE("ticks that were missed are counted and left out, and a short delay is caught up",
          "[app][threads]") {
    // A tick that begins up to 2 ms late is followed by a shorter one.
    const auto [late_us, missed] = GENERATE(
        table<int, std::uint64_t>({{0, 0}, {1500, 0}, {1999, 0}, {5000, 4}, {18'000, 17}}));
    test::VirtualClock clock;
    LateOmni device(clock, std::chrono::microseconds(late_us));
    LiveSession session(test::water_scene(), {}, device, nullptr, &clock);
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (device.ticks < 2 * LateOmni::late_tick && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));

    clock.leave_servo_alone();  // the session ends

    REQUIRE(device.ticks >= 2 * LateOmni::late_tick);
    CHECK(session.servo_health().overruns == missed);
    SafetyStage gravest = SafetyStage::None;
    for (ServoTick tick; session.pop_ticks({&tick, 1});) {
        // Before the simulation left the servo alone.
        const bool counts = tick.reading.time_s < 1.5e-3 * LateOmni::late_tick;
        if (counts && tick.stage >= SafetyStage::Stale) gravest = std::max(gravest, tick.stage);
    }
    CHECK(gravest == SafetyStage::None);  // below 20 ms the force goes on
}
