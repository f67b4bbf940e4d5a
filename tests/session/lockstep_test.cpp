#include "session/lockstep.h"

#include "core/load_error.h"

#include <catch2/catch.hpp>
#include <vector>

using namespace palpa;

namespace {

// A device whose handle moves 1 mm a tick, and which notes what it is sent.
class Conveyor final : public Device {
public:
    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override {
        return {ticks_ * 1e-3, Vec3(ticks_ * 1e-3, 0, 0), 0, true};
    }
    void write(const Vec3& force_newton) noexcept override {
        sent.push_back(force_newton.x());
        ++ticks_;
    }

    std::vector<double> sent;

private:
    DeviceSpec spec_;
    int ticks_ = 0;
};

}  // namespace

TEST_CASE("a step's answer is felt one period after its hand pose, and held for one",
          "[session][lockstep]") {
    const ServoSettings servo{ConstantForceLaw{1e9}, {.is_full = false}, 0};
    Conveyor device;
    std::vector<double> poses, felt_by_step;
    int recorded = 0;
    // Answers the handle's travel in mm as nanonewtons over 100.
    const auto step = [&](const HandPose& hand, const TouchModel& felt) {
        poses.push_back(hand.travel_m.x());
        felt_by_step.push_back(felt.force_newton.x() * 1e9);
        TouchModel answer;
        answer.force_newton.x() = hand.travel_m.x() * 1e3 / 100 * 1e-9;
        return answer;
    };
    TouchModel first;
    first.force_newton.x() = -0.5e-9;

    run_lockstep({12, 4}, servo, device, first, step, [&](const ServoTick&) { ++recorded; });

    CHECK(recorded == 12);
    CHECK(poses == std::vector<double>{0, 4e-3, 8e-3});
    REQUIRE(device.sent.size() == 12);
    for (int tick = 0; tick < 12; ++tick) {
        // Travel at tick 0 was 0, at tick 4 4 mm; the answers arrive at ticks 4 and 8.
        const double expected = tick < 4 ? -0.5 : tick < 8 ? 0 : 0.04;
        CHECK(device.sent[static_cast<std::size_t>(tick)] == Approx(expected).margin(1e-15));
    }
    CHECK(felt_by_step[1] == Approx(0).margin(1e-15));
    CHECK(felt_by_step[2] == Approx(0.04));
}

TEST_CASE("a run ends after the tick at which it is said to be over", "[session][lockstep]") {
    const ServoSettings servo{ConstantForceLaw{1e9}, {.is_full = false}, 0};
    Conveyor device;
    int ticks = 0;
    const auto step = [](const HandPose&, const TouchModel&) { return TouchModel(); };

    run_lockstep(
        {12, 4}, servo, device, {}, step, [&](const ServoTick&) { ++ticks; },
        [&] { return ticks == 5; });

    CHECK(ticks == 5);
    CHECK(device.sent.size() == 5);
}
