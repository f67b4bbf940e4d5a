#include "devices/two_hands.h"

#include "devices/emulated_omni.h"

#include <catch2/catch.hpp>
#include <memory>
#include <numbers>

using namespace palpa;

namespace {

class Handle final : public Device {
public:
    const DeviceSpec& spec() const noexcept override { return limits; }
    DeviceReading read() noexcept override { return reading; }
    void write(const Vec3& force_newton) noexcept override { written = force_newton; }
    std::string_view status() const noexcept override { return says; }

    DeviceSpec limits{.name = "handle"};
    DeviceReading reading{.valid = true};
    Vec3 written = Vec3::Zero();
    std::string_view says;
};

struct Pair {
    Handle* first = new Handle;
    Handle second;
    TwoHands both{std::unique_ptr<Device>(first), second};
};

}  // namespace

TEST_CASE("of two hands the way between the handles counts, and the force is on both",
          "[devices][two-hands]") {
    Pair pair;
    pair.first->reading.position_m = {0.03, 0.01, 0};
    pair.second.reading.position_m = {-0.02, 0.01, 0.005};
    pair.first->reading.orientation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));

    CHECK((pair.both.read().position_m - Vec3(0.05, 0, -0.005)).norm() < 1e-15);
    CHECK(pair.both.read().orientation.isApprox(pair.first->reading.orientation));
    pair.both.write({1, -2, 0.5});
    CHECK(pair.first->written == Vec3(1, -2, 0.5));
    CHECK(pair.second.written == Vec3(-1, 2, -0.5));
}

TEST_CASE("what one of two hands lacks, both lack", "[devices][two-hands]") {
    const bool is_first = GENERATE(true, false);
    Pair pair;
    Handle& one = is_first ? *pair.first : pair.second;
    CHECK(pair.both.read().valid);
    CHECK_FALSE(is_pressed(pair.both.read().buttons, Button::Clutch));

    one.reading.buttons = 1;
    one.reading.trouble = DeviceTrouble::WarmMotors;
    one.says = "Let it rest.";
    CHECK(is_pressed(pair.both.read().buttons, Button::Clutch));
    CHECK(pair.both.read().trouble == DeviceTrouble::WarmMotors);
    CHECK(pair.both.status() == "Let it rest.");
    one.reading.valid = false;
    CHECK_FALSE(pair.both.read().valid);
}

TEST_CASE("two devices can do together what the weaker one can", "[devices][two-hands]") {
    auto first = std::make_unique<Handle>();
    Handle second;
    first->limits = {"one", 1000, 3.3, 0.88, 0.3, {0.08, 0.06, 0.035}};
    second.limits = {"other", 1000, 7, 0, 0.6, {0.06, 0.06, 0.06}};

    const TwoHands both(std::move(first), second);

    CHECK(both.spec().name == "one and other");
    CHECK(both.spec().peak_force_newton == 3.3);
    CHECK(both.spec().continuous_force_newton == 0.88);
    CHECK(both.spec().viscosity_N_s_per_m == Approx(0.2));
    CHECK(both.spec().half_workspace_m.isApprox(Vec3(0.14, 0.12, 0.095)));
}

// Two free masses on a spring swing with omega^2 = K/m1 + K/m2.
TEST_CASE("two free handles on a spring swing as one of both masses in series",
          "[devices][two-hands]") {
    constexpr double spring = 40;  // N/m
    EmulatedOmniSettings settings;
    settings.dynamics = {0.045, 0};
    settings.friction_newton = 0;
    settings.encoder_step_m = 1e-9;
    EmulatedOmniSettings heavier = settings;
    heavier.dynamics.inertia_kg = 0.09;
    EmulatedOmni second(heavier);
    TwoHands both(std::make_unique<EmulatedOmni>(settings), second);

    for (int i = 0; i < 10; ++i) {
        (void)both.read();
        both.write({2, 0, 0});
    }
    int ticks = 0, crossings = 0, first_at = 0, last_at = 0;
    double before = 0;
    while (crossings < 7) {
        const double x = both.read().position_m.x();
        if (ticks > 0 && (x > 0) != (before > 0)) {
            if (crossings++ == 0) first_at = ticks;
            last_at = ticks;
        }
        before = x;
        both.write({-spring * x, 0, 0});
        ++ticks;
        REQUIRE(ticks < 2000);
    }

    const double swing_s = 1e-3 * (last_at - first_at) / 3;
    const double mass = in_series(0.045, 0.09);
    CHECK(mass == Approx(0.03));
    CHECK(swing_s == Approx(2 * std::numbers::pi * std::sqrt(mass / spring)).epsilon(0.02));
}
