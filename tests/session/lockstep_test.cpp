#include "session/lockstep.h"

#include "core/load_error.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <span>
#include <vector>

using namespace palpa;

namespace {

// A device whose handle moves by so much a tick, and which notes what it is sent.
class Conveyor final : public Device {
public:
    explicit Conveyor(double mm = 1) : mm_(mm) {}

    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override {
        return {ticks_ * 1e-3, Vec3(ticks_ * mm_ * 1e-3, 0, 0), 0, true};
    }
    void write(const Vec3& force_newton) noexcept override {
        sent.push_back(force_newton.x());
        ++ticks_;
    }

    std::vector<double> sent;

private:
    DeviceSpec spec_;
    double mm_;
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
    const auto step = [&](const HandPose& hand, const ContactModel& felt) {
        poses.push_back(hand.travel_m.x());
        felt_by_step.push_back(felt.force_newton.x() * 1e9);
        ContactModel answer;
        answer.force_newton.x() = hand.travel_m.x() * 1e3 / 100 * 1e-9;
        return answer;
    };
    ContactModel first;
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
    const auto step = [](const HandPose&, const ContactModel&) { return ContactModel(); };

    run_lockstep(
        {12, 4}, servo, device, {}, step, [&](const ServoTick&) { ++ticks; },
        [&] { return ticks == 5; });

    CHECK(ticks == 5);
    CHECK(device.sent.size() == 5);
}

TEST_CASE("each of two hands feels the answer to its own pose, found in one step of both",
          "[session][lockstep]") {
    const ServoSettings plain{ConstantForceLaw{1e9}, {.is_full = false}, 0};
    const ServoSettings doubled{ConstantForceLaw{2e9}, {.is_full = false}, 0};
    Conveyor slow(1), fast(3);
    const std::array hands{LockstepHand{slow, plain, LocalContactModel()},
                           LockstepHand{fast, doubled, LocalContactModel()}};
    std::vector<std::array<double, 2>> poses, felt_by_step;
    // Answers travel in mm as nanonewtons over 100.
    const auto step = [&](std::span<const HandPose> now, std::span<const ContactModel> felt) {
        poses.push_back({now[0].travel_m.x(), now[1].travel_m.x()});
        felt_by_step.push_back({felt[0].force_newton.x(), felt[1].force_newton.x()});
        std::vector<LocalContactModel> answers(2);
        for (std::size_t i = 0; i < 2; ++i)
            answers[i].model.force_newton.x() = now[i].travel_m.x() * 1e3 / 100 * 1e-9;
        return answers;
    };
    int recorded = 0;

    run_lockstep({12, 4}, hands, step, [&](std::span<const ServoTick> ticks) {
        REQUIRE(ticks.size() == 2);
        CHECK(ticks[1].reading.position_m.x() == Approx(3 * ticks[0].reading.position_m.x()));
        ++recorded;
    });

    CHECK(recorded == 12);
    REQUIRE(poses.size() == 3);
    CHECK(poses[1][0] == Approx(4e-3));
    CHECK(poses[1][1] == Approx(12e-3));
    CHECK(felt_by_step[2][0] == Approx(0.04e-9));
    CHECK(felt_by_step[2][1] == Approx(0.12e-9));
    CHECK(slow.sent[7] == Approx(0).margin(1e-15));
    CHECK(slow.sent[8] == Approx(0.04));
    CHECK(fast.sent[8] == Approx(0.24));  // by its own law
}
