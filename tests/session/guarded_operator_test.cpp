// Somebody who feels for the place without force finds it better with guarded coupling than with
// the paper's constant gains.
#include "core/mailbox.h"
#include "haptics/hand.h"
#include "tests/support/guarded_loop.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

using namespace palpa;
using namespace palpa::test;

namespace {

// Goes in until there is repulsion, then after what is felt in ever smaller steps, and stops after
// a second without force. Feels late, with noise, and nothing below a threshold; the hand trembles.
class Seeker {
public:
    explicit Seeker(unsigned seed) : random_(seed) {
        threshold_N_ = draw(0.05, 0.1);
        start_angstrom_ = draw(6.8, 9);
        seen_angstrom_ = rest_angstrom + std::abs(0.3 * normal_(random_)) + 1.2;
        approach_m_per_s_ = draw(0.03, 0.06);
        phase_ = draw(0, 6.28);
    }

    double start_angstrom() const { return start_angstrom_; }
    double wish_m() const { return wish_m_; }
    bool is_done() const { return calm_s_ > 1; }

    void feel(double newton, double distance) {
        const double felt = perceive(newton);
        const bool is_far = distance > seen_angstrom_;  // the picture tells
        double speed = 0;
        if (!is_seeking_) {
            speed = -approach_m_per_s_;
            is_seeking_ = !is_far && felt > std::max(threshold_N_, 0.15);
            calm_s_ = 0;
        } else {
            speed = follow();
            is_seeking_ = !is_far;
        }
        move(speed);
    }

private:
    double draw(double least, double most) {
        return std::uniform_real_distribution(least, most)(random_);
    }

    double wander(double value, double size, double time_s) {
        return value - value * servo_tick_s / time_s +
               size * std::sqrt(2 * servo_tick_s / time_s) * normal_(random_);
    }

    double perceive(double newton) {
        smooth_N_ += (newton - smooth_N_) * servo_tick_s / 0.03;
        const double late = under_way_[tick_ % under_way_.size()];
        under_way_[tick_++ % under_way_.size()] = smooth_N_;
        noise_N_ = wander(noise_N_, 0.02, 0.1);
        share_ = wander(share_, 0.07, 0.3);
        const double felt = late * (1 + share_) + noise_N_;
        mean_N_ += (felt - mean_N_) * servo_tick_s / 0.2;
        return felt;
    }

    // The pace halves wherever the force turns round.
    double follow() {
        const double beyond = std::abs(mean_N_) - threshold_N_;
        if (beyond <= 0) {
            calm_s_ += servo_tick_s;
            return 0;
        }
        calm_s_ = 0;
        const double side = std::copysign(1.0, mean_N_);
        if (side == -side_) pace_m_per_s_ = std::max(0.5 * pace_m_per_s_, 0.0005);
        side_ = side;
        return side * std::min(pace_m_per_s_, 0.02 * beyond + 0.001);
    }

    void move(double speed) {
        const double before = unsteady_m_, time_s = static_cast<double>(tick_) * servo_tick_s;
        unsteady_m_ = wander(unsteady_m_, 0.0003, 0.5);
        const auto tremor = [&](double at_s) {
            return 0.00007 * std::sin(6.2832 * 9 * at_s + phase_);
        };
        wish_m_ += speed * servo_tick_s + unsteady_m_ - before + tremor(time_s + servo_tick_s) -
                   tremor(time_s);
    }

    std::mt19937 random_;
    std::normal_distribution<double> normal_;
    double threshold_N_ = 0, start_angstrom_ = 0, seen_angstrom_ = 0, approach_m_per_s_ = 0,
           phase_ = 0;
    double wish_m_ = 0, unsteady_m_ = 0;
    double smooth_N_ = 0, noise_N_ = 0, share_ = 0, mean_N_ = 0;
    std::array<double, 150> under_way_{};
    std::size_t tick_ = 0;
    bool is_seeking_ = false;
    double side_ = 0, pace_m_per_s_ = 0.02, calm_s_ = 0;
};

struct Found {
    double off_angstrom = 0, seconds = 0;
    int unfinished = 0;
};

// Means of as many trials, 14 ms a step.
Found seek(int trials, Grip grip, double friction_newton,
           const std::vector<std::string>& settings) {
    constexpr double longest_s = 40;
    Found found;
    for (int trial = 0; trial < trials; ++trial) {
        Seeker seeker(static_cast<unsigned>(trial));
        GuardedCase c{grip, friction_newton, 14, seeker.start_angstrom()};
        c.settings = settings;
        const SceneDescription scene = guarded_scene(c);
        Simulation simulation = load_simulation(scene);
        HandOrders orders;
        EmulatedOmniSettings device;
        device.friction_newton = friction_newton;
        device.hand = hand_model(grip);
        device.orders = &orders;
        device.live = true;
        device.half_workspace_m = Vec3::Constant(0.5);
        EmulatedOmni omni(device);
        double distance = 0;
        std::uint64_t ticks = 0;
        const auto step = [&](const HandPose& hand, const TouchModel& felt) {
            (void)step_simulation(simulation, hand, felt);
            return simulation.touch;
        };
        const auto on_tick = [&](const ServoTick& tick) {
            distance = tick.touch.molecule_angstrom.x();
            seeker.feel(tick.sent_newton.x(), distance);
            orders.post({.target_m = Vec3(seeker.wish_m(), 0, 0)});
            ++ticks;
            return !seeker.is_done();
        };
        run_unsteady(
            static_cast<std::uint64_t>(longest_s * servo_rate_hz), [] { return Due{14, false}; },
            build_servo_settings(scene, simulation), omni, simulation.touch, step, on_tick);
        found.off_angstrom += std::abs(distance - rest_angstrom) / trials;
        found.seconds += static_cast<double>(ticks) * servo_tick_s / trials;
        if (!seeker.is_done()) ++found.unfinished;
    }
    return found;
}

}  // namespace

TEST_CASE("guarded, the place without force is found three times better than with constant gains",
          "[session][coupling]") {
    constexpr int trials = 30;
    const Grip grip = GENERATE(Grip::Medium, Grip::Firm);
    const double friction_newton = GENERATE(0.0, 0.26);
    INFO(grip_names[static_cast<std::size_t>(grip)] << ", friction " << friction_newton << " N");

    const Found guarded = seek(trials, grip, friction_newton, {});
    const Found constant = seek(trials, grip, friction_newton, {"mode=4"});

    INFO(guarded.off_angstrom << " Å after " << guarded.seconds << " s; constant gains "
                              << constant.off_angstrom << " Å after " << constant.seconds << " s");
    CHECK(guarded.off_angstrom <= constant.off_angstrom / 3);
    CHECK(guarded.unfinished == 0);
    CHECK(guarded.seconds <= constant.seconds + 2);
}
