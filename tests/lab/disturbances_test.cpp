#include "tools/lab/experiments/disturbances.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>

using namespace palpa;

namespace {

// A device whose handle the test places.
class Handle final : public Device {
public:
    const DeviceSpec& spec() const noexcept override { return spec_; }
    DeviceReading read() noexcept override {
        DeviceReading reading;
        reading.position_m.x() = x_m;
        reading.valid = true;
        return reading;
    }
    void write(const Vec3& force_newton) noexcept override { written = force_newton; }

    double x_m = 0;
    Vec3 written = Vec3::Zero();

private:
    DeviceSpec spec_;
};

}  // namespace

TEST_CASE("a watched device knows force, change and work by what was written",
          "[experiments][disturbances]") {
    Handle handle;
    WatchedDevice watched(handle);
    const auto tick = [&](double x_m, double newton) {
        handle.x_m = x_m;
        (void)watched.read();
        watched.write(Vec3(newton, 0, 0));
    };

    tick(0, 0.4);
    tick(0.002, 0.7);   // 0.4 N over 2 mm
    tick(0.001, -0.1);  // 0.7 N over -1 mm
    tick(0.001, 0);     // at once
    (void)watched.read();

    CHECK(watched.work_J() == Approx(0.4 * 0.002 - 0.7 * 0.001));
    CHECK(watched.most_newton() == Approx(0.7));
    CHECK(watched.most_change_newton() == Approx(0.8));
    CHECK(handle.written.isZero(0));
}

TEST_CASE("dropping to zero is no slew, and what is no number exceeds every clamp",
          "[experiments][disturbances]") {
    Handle handle;
    WatchedDevice watched(handle);
    watched.write(Vec3(0.5, 0, 0));
    watched.write(Vec3::Zero());

    CHECK(watched.most_change_newton() == Approx(0.5));
    watched.write(Vec3(std::nan(""), 0, 0));
    CHECK(std::isinf(watched.most_newton()));
}

TEST_CASE("a time is disturbed from a fault or an edit until it is felt no more",
          "[experiments][disturbances]") {
    Disturbances disturbances;
    disturbances.faults = {{DeviceFault::Jump, 1000, 1010}};
    disturbances.edits = {{5.0, 0, ReleaseEdit{}, {"test"}}};
    const auto is = [&](double time_s) { return is_disturbed(disturbances, time_s, 0.1); };

    CHECK_FALSE(is(0.999));
    CHECK(is(1.000));
    CHECK(is(1.010));  // the reading leaps back
    CHECK_FALSE(is(1.0115));
    CHECK_FALSE(is(4.99));
    CHECK(is(5.0));
    CHECK(is(5.5));
    CHECK_FALSE(is(6));
}

TEST_CASE("disturbances are of every kind, in the order of time, and the same for a number",
          "[experiments][disturbances]") {
    std::set<DeviceFault> faults;
    std::set<std::size_t> edits;
    std::size_t quiet = 0;
    for (std::uint64_t number = 0; number < 300; ++number) {
        Draws draws(1, number), again(1, number);
        const Disturbances found = draw_disturbances(draws, 4);

        CHECK(found.settings == draw_disturbances(again, 4).settings);
        for (const FaultPeriod& fault : found.faults) {
            faults.insert(fault.fault);
            CHECK(fault.begin < fault.end);
        }
        for (const EditDescription& edit : found.edits) edits.insert(edit.action.index());
        if (found.edits.size() == 2) CHECK(found.edits[0].at_s <= found.edits[1].at_s);
        quiet += found.faults.empty() && found.edits.empty() ? 1 : 0;
    }

    CHECK(faults.size() == 4);
    CHECK(edits.size() == 6);  // take, let_go, pin, coupling, reset, undo
    CHECK(quiet > 40);
    CHECK(quiet < 120);
}
