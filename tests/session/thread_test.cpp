// Servo and simulation on threads of their own, as a window will run them: the same functions as in
// lockstep, with the exchange as their only meeting point.
#include "devices/emulated_omni.h"
#include "haptics/servo.h"
#include "loading/load.h"
#include "simulation/grip_queries.h"
#include "simulation/step.h"
#include "tests/support/water_run.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

using namespace palpa;

TEST_CASE("the water scene runs on two threads without a race", "[session][thread]") {
    const SceneDescription scene = test::water_scene({"stroke_s=0.5"});
    World world = load_world(scene);
    EmulatedOmni device(test::build_played_omni(scene, world));
    const ServoSettings settings = build_servo_settings(scene, world, 0);
    Exchange exchange;
    ContactModel felt = contact_at(world, 0).model;
    exchange.contact.post(felt);
    std::atomic<bool> done = false;
    std::atomic<int> steps = 0;
    bool finite = true;

    std::thread simulating([&] {
        HandPose hand;
        while (!done) {
            if (!exchange.hand.read(hand)) continue;
            const StepReport& report = step_world(world, hand, felt);
            finite = finite && report.finite;
            felt = contact_at(world, 0).model;
            exchange.contact.post(felt);
            ++steps;
        }
    });
    ServoState state;
    double now_s = 0;
    bool stopped = false;
    for (int tick = 0; tick < 5'000 || steps < 50; ++tick) {
        const ServoTick servo = step_servo(settings, state, exchange, device.read(), now_s += 1e-3);
        device.write(servo.sent_newton);
        stopped = stopped || servo.stopped;
    }
    done = true;
    simulating.join();

    CHECK(finite);
    CHECK_FALSE(stopped);
}
