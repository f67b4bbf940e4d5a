// What guarded coupling must keep to on the dimer: six hands, four periods, with the device's
// friction and without. Each limit and its number come from a study of this loop in another
// program.
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/guarded_loop.h"
#include "tests/support/water_run.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>

using namespace palpa;
using namespace palpa::test;

namespace {

constexpr std::array grips{HandGrip::None,   HandGrip::Light, HandGrip::Slack,
                           HandGrip::Medium, HandGrip::Firm,  HandGrip::FirmGrip};
constexpr std::array hands{HandGrip::Light, HandGrip::Slack, HandGrip::Medium, HandGrip::Firm,
                           HandGrip::FirmGrip};
constexpr std::array<std::uint64_t, 4> periods_ms{1, 5, 14, 83};
constexpr std::array frictions_newton{0.0, 0.26};

std::string words_of(const GuardedCase& c) {
    return std::string(grip_names[static_cast<std::size_t>(c.grip)]) + ", " +
           std::to_string(c.period_ms) + " ms, friction " + std::to_string(c.friction_newton) +
           " N";
}

void check_held(const GuardedCase& c) {
    INFO(words_of(c));
    const Measured measured = run_guarded(c);
    CHECK(measured.ripple_N < 0.02);
    CHECK(std::abs(measured.last_angstrom - rest_angstrom) < 0.3);
    CHECK(measured.stage <= SafetyStage::Slewed);
}

void check_stroke(const GuardedCase& c, double largest_error_N) {
    INFO(words_of(c));
    const Measured measured = run_guarded(c);
    CHECK(measured.energy_J <= 0.001);
    CHECK(measured.error_N <= largest_error_N);
    CHECK(measured.attraction_N >= 0.85);
    CHECK(measured.largest_nN <= 3);
    CHECK(measured.at_clamp == 0);
    CHECK(measured.stage <= SafetyStage::Slewed);
}

// The quicker the stroke, the more the one tick of delay shows.
double allowed_error(double stroke_s) { return stroke_s < 2 ? 0.02 : 0.01; }

// Every period from 5 ms to ten times that, where 14 ms were declared.
DueFunction jittered(unsigned seed) {
    const auto random = std::make_shared<std::mt19937>(seed);
    return [random] { return Due{5 + (*random)() % 46, false}; };
}

// Every 14 ms, but one result of five never arrives.
DueFunction lossy(unsigned seed) {
    const auto random = std::make_shared<std::mt19937>(seed);
    return [random] { return Due{14, (*random)() % 5 == 0}; };
}

// At rest, and in strokes of 3 s and 1 s.
void check_unsteady(DueFunction (*draw)(unsigned seed)) {
    for (const double friction : frictions_newton)
        for (const HandGrip grip : grips) {
            GuardedCase c = held(grip, friction, 14);
            c.draw = draw(1);
            check_held(c);
        }
    for (const double stroke_s : {3.0, 1.0})
        for (const HandGrip grip : hands) {
            INFO(stroke_s << " s");
            const double depth = depth_to_peak({.grip = grip}, stroke_s);
            for (const double friction : frictions_newton) {
                GuardedCase c = stroke(grip, friction, 14, stroke_s, depth);
                c.draw = draw(1);
                check_stroke(c, allowed_error(stroke_s));
            }
        }
}

// In and out to 3 nN, each hand at every period.
void check_strokes(double stroke_s) {
    for (const HandGrip grip : hands) {
        const double depth = depth_to_peak({.grip = grip}, stroke_s);
        for (const std::uint64_t period_ms : periods_ms)
            for (const double friction : frictions_newton)
                check_stroke(stroke(grip, friction, period_ms, stroke_s, depth),
                             allowed_error(stroke_s));
    }
}

}  // namespace

TEST_CASE("guarded, a knocked hand stays at rest without a ripple", "[session][coupling]") {
    for (const HandGrip grip : grips)
        for (const std::uint64_t period_ms : periods_ms)
            for (const double friction : frictions_newton)
                check_held(held(grip, friction, period_ms));
}

TEST_CASE("guarded, ten times the force gain leaves rest without a ripple", "[session][coupling]") {
    for (const HandGrip grip : {HandGrip::None, HandGrip::Light, HandGrip::Medium, HandGrip::Firm})
        for (const std::uint64_t period_ms : periods_ms)
            for (const double friction : frictions_newton) {
                GuardedCase c = held(grip, friction, period_ms);
                c.settings = {"coupling.A_f_max=51e9", "coupling.A_f_min=6.4e9"};
                check_held(c);
            }
}

// No energy for the hand, the law at rest, its attraction, nothing cut off.
TEST_CASE("guarded, slow strokes to 3 nN feel as the law at rest", "[session][coupling]") {
    check_strokes(3);
}

TEST_CASE("guarded, quick strokes to 3 nN feel as the law at rest", "[session][coupling]") {
    check_strokes(1);
}

TEST_CASE("guarded, no hand is too quick for the wall", "[session][coupling]") {
    const double mean_m_per_s = GENERATE(0.03, 0.1, 0.3, 0.6);
    for (const std::uint64_t period_ms : periods_ms)
        for (const double friction : frictions_newton)
            // At eight places and moments within a period.
            for (int phase = 0; phase < 8; ++phase) {
                GuardedCase c{HandGrip::Firm, friction, period_ms, 10 + 0.15 * phase};
                const double out = 0.3 + 0.003 * phase, stroke_s = 0.09 / mean_m_per_s;
                c.script.path = {{out, 0},
                                 {out + stroke_s, -0.09},
                                 {out + stroke_s + 0.5, -0.09},
                                 {out + 2 * stroke_s + 0.5, 0}};
                c.seconds = out + 2 * stroke_s + 1;
                INFO(words_of(c) << ", " << mean_m_per_s << " m/s, phase " << phase);

                const Measured measured = run_guarded(c);

                CHECK(measured.closest_angstrom > 2.6);
                CHECK(measured.largest_nN < 1);
                CHECK(measured.stage <= SafetyStage::Slewed);
            }
}

TEST_CASE("guarded, no push goes through the wall", "[session][coupling]") {
    // 9.5 cm lead to 3 nN.
    const double too_far_m = GENERATE(0.03, 0.06, 0.12), stroke_s = GENERATE(0.5, 2.0);
    for (const std::uint64_t period_ms : periods_ms)
        for (const double friction : frictions_newton) {
            const GuardedCase c =
                stroke(HandGrip::Firm, friction, period_ms, stroke_s, 0.095 + too_far_m, 0.5);
            INFO(words_of(c) << ", " << too_far_m << " m too far in " << stroke_s << " s");

            const Measured measured = run_guarded(c);

            CHECK(measured.closest_angstrom >= 2.32);
            CHECK(measured.largest_nN <= 10);
            CHECK(measured.energy_J <= 0);
            CHECK(measured.stage <= SafetyStage::Clamped);
        }
}

TEST_CASE("guarded, a molecule drifts by 0.1 Å at most each time it goes in and out",
          "[session][coupling]") {
    constexpr int cycles = 10;
    const double stroke_s = GENERATE(2.0, 0.7);
    for (const std::uint64_t period_ms : periods_ms)
        for (const double friction : frictions_newton) {
            GuardedCase c{HandGrip::Firm, friction, period_ms};
            c.hand = HandModel{0.3, 500, 2e4};  // hardly gives way
            // What ten strokes without a rest heat is not what is asked here.
            c.thermal_limit_newton = std::numeric_limits<double>::infinity();
            double time = 0.2;
            c.script.path = {{time, 0}};
            for (int cycle = 0; cycle < cycles; ++cycle) {
                c.script.path.push_back({time += stroke_s, -0.1});
                c.script.path.push_back({time += stroke_s, 0});
            }
            c.seconds = time + 0.5;
            INFO(words_of(c) << ", " << stroke_s << " s");

            const Measured measured = run_guarded(c);

            CHECK(std::abs(measured.last_angstrom - c.start_angstrom) <= 0.1 * cycles);
            CHECK(measured.stage <= SafetyStage::Slewed);
        }
}

TEST_CASE("guarded, a target on a spring is felt as it gives way", "[session][coupling]") {
    const double spring_N_per_m = GENERATE(20.0, 100.0);
    for (const HandGrip grip : hands) {
        const double depth = depth_to_peak({.grip = grip, .spring_N_per_m = spring_N_per_m}, 3);
        for (const double friction : frictions_newton) {
            GuardedCase c = stroke(grip, friction, 14, 3, depth);
            c.spring_N_per_m = spring_N_per_m;
            INFO(words_of(c) << ", " << spring_N_per_m << " N/m");

            const Measured measured = run_guarded(c);

            CHECK(measured.error_N <= 0.05);
            CHECK(measured.energy_J <= 0);
            CHECK(measured.attraction_N >= 0.85);
            CHECK(measured.at_clamp == 0);
            CHECK(measured.stage <= SafetyStage::Slewed);
            GuardedCase at_rest = held(grip, friction, 14);
            at_rest.spring_N_per_m = spring_N_per_m;
            check_held(at_rest);
        }
    }
}

TEST_CASE("guarded, periods that vary tenfold change nothing of that", "[session][coupling]") {
    check_unsteady(jittered);
}

TEST_CASE("guarded, steps that are lost change nothing of that", "[session][coupling]") {
    check_unsteady(lossy);
}

TEST_CASE("the loop of varying periods is the other loop where they do not vary",
          "[session][coupling]") {
    GuardedCase c = stroke(HandGrip::Medium, 0.26, 14, 1, 0.1);
    const Measured steady = run_guarded(c);
    c.draw = [] { return Due{14, false}; };
    const Measured drawn = run_guarded(c);

    CHECK(drawn.energy_J == steady.energy_J);
    CHECK(drawn.error_N == steady.error_N);
    CHECK(drawn.last_angstrom == steady.last_angstrom);
}

// Found by hand: both vibrated by 0.3 N to 0.9 N and gained 0.05 J and more.
TEST_CASE("damping that is late shakes no handle that nobody holds", "[session][coupling]") {
    const auto [damping, delay, inertia] = GENERATE(
        table<std::string, std::string, std::string>({{"2", "7", "0.045"}, {"0.5", "7", "0.01"}}));
    const Summary summary = test::run_water(
        {"mode=guarded", "stroke=hold", "grip=none", "friction_N=0", "kick_N_s=0.0005",
         "damping_N_s_per_m=" + damping, "servo_delay_ticks=" + delay, "inertia_kg=" + inertia});

    CHECK(summary.ripple->rms < 0.02);
    CHECK(summary.net_work_J < 0.001);
    CHECK(summary.warnings.empty());
}

// While the hand carries the handle back the molecule stays in the wall, and must not push.
TEST_CASE("guarded, a hand that clutches in the wall is given nothing", "[session][coupling]") {
    const int inward_mm = GENERATE(120, 200, 400);
    const Summary summary = run_water({"hand.stroke=path", "hand.start_angstrom=7",
                                       "hand.path=[[0.3,70],[3,-" + std::to_string(inward_mm) +
                                           "],[4,-" + std::to_string(inward_mm) + "],[7,70]]",
                                       "run.seconds=25"});

    CHECK(summary.net_work_J <= 0.001);
    CHECK(summary.largest_repulsion_N > 1);
}

namespace {

// A handle that is led along x, whatever pushes it: in until the molecule is in its well, there
// until the force has gone down, out until the molecule is where it began.
class LedHandle final : public Device {
public:
    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override {
        return {static_cast<double>(tick_) * servo_tick_s, Vec3(x_m_, 0, 0), 0, true};
    }
    void show(const ContactModel& contact, const Vec3& /*waiting_m*/) noexcept override {
        place_angstrom_ = contact.molecule.place_angstrom.x();
    }
    void write(const Vec3& force_newton) noexcept override {
        constexpr double step_m = 5e-6, well_angstrom = 3.2, start_angstrom = 7, low_newton = 0.21;
        ++tick_;
        largest_newton = std::max(largest_newton, force_newton.norm());
        if (way_ == Way::In && place_angstrom_ < well_angstrom) way_ = Way::Rest;
        if (way_ == Way::Rest && force_newton.norm() < low_newton) way_ = Way::Out;
        if (way_ == Way::Out && place_angstrom_ > start_angstrom) way_ = Way::Home;
        if (way_ == Way::In) x_m_ -= step_m;
        if (way_ == Way::Out) x_m_ += step_m;
    }
    bool is_home() const noexcept { return way_ == Way::Home; }

    double largest_newton = 0;

private:
    enum class Way { In, Rest, Out, Home };

    DeviceSpec spec_{.name = "led", .is_real = false};
    Way way_ = Way::In;
    double x_m_ = 0, place_angstrom_ = 7;
    std::uint64_t tick_ = 0;
};

}  // namespace

// Into the well with the whole attraction, and out when the motors are warm: nobody would have paid
// for the difference.
TEST_CASE("guarded, no way into the well and out of it with warm motors gives energy",
          "[session][coupling]") {
    const bool gets_hot = GENERATE(true, false);
    const SceneDescription scene =
        water_scene({"mode=guarded", "start_angstrom=7", "period_ms=14"});
    World world = load_world(scene);
    ServoSettings servo = build_servo_settings(scene, world, 0);
    servo.safety.thermal_limit_newton = gets_hot ? 0.2 : 0.9;
    servo.safety.heat_s = gets_hot ? 100 : 1e9;
    if (!gets_hot) servo.safety.clamp_newton = 0.2;  // on the way in as well: nothing to find
    LedHandle handle;
    const auto step = [&](const HandPose& hand, const ContactModel& felt) {
        (void)step_world(world, hand, felt);
        return contact_at(world, 0);
    };
    double work_J = 0;

    run_lockstep(
        {200'000, 14}, servo, handle, contact_at(world, 0), step,
        [&](const ServoTick& tick) { work_J = tick.hand_energy_J; },
        [&] { return handle.is_home(); });

    REQUIRE(handle.is_home());
    if (gets_hot) CHECK(handle.largest_newton > 0.85);
    CHECK(work_J < 0.5e-3);
    CHECK(work_J > -5e-3);
}
