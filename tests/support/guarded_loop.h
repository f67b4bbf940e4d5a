// Guarded coupling in the whole loop on the water dimer, and what its acceptance bars ask about it.
#pragma once
#include "core/units.h"
#include "devices/emulated_omni.h"
#include "ecs/world.h"
#include "session/lockstep.h"
#include "session/ripple.h"
#include "session/run_headless.h"
#include "simulation/probe.h"
#include "simulation/step.h"
#include "simulation/systems/publish_contact.h"
#include "tests/support/held_scene.h"
#include "tests/support/water_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpa::test {

inline constexpr double rest_angstrom = 2.767;

// Ticks from each publishing to the next, and whether what is due then is lost.
struct Due {
    std::uint64_t ticks = 1;
    bool is_lost = false;
};
using DueFunction = std::function<Due()>;

struct GuardedCase {
    HandGrip grip = HandGrip::Medium;
    double friction_newton = 0;
    std::uint64_t period_ms = 1;
    double start_angstrom = 7;
    HandScript script = {};
    double seconds = 10;
    std::vector<std::string> settings = {};                           // of the scene, beside these
    std::optional<HandModel> hand = {};                               // in place of the grip's
    double thermal_limit_newton = 0.88;                               // of the motors
    double spring_N_per_m = std::numeric_limits<double>::infinity();  // of the fixed water
    DueFunction draw = {};                                            // in place of the period
};

struct Measured {
    double ripple_N = 0;  // of the last 4 s
    double closest_angstrom = std::numeric_limits<double>::infinity(), last_angstrom = 0;
    double largest_nN = 0;                  // on the molecule, by the law at rest
    double energy_J = 0;                    // given to the hand
    double error_N = 0;                     // rms, sent minus law at rest, without the damping
    double attraction_N = 0;                // felt, without the damping
    int at_clamp = 0;                       // ticks with the force at the clamp
    SafetyStage stage = SafetyStage::None;  // the gravest
};

// The loop's watcher: takes every tick.
class Watch {
public:
    // `law_newton`: of the molecule at rest, from the distance (Å).
    Watch(const ServoSettings& servo, std::function<double(double)> law_newton)
        : guarded_(*servo.guarded),
          clamp_newton_(servo.safety.clamp_newton),
          law_newton_(std::move(law_newton)) {}

    void add(const ServoTick& tick) {
        const double distance = tick.contact.molecule.place_angstrom.x();
        const double sent = tick.sent_newton.x();
        const double F_m = law_newton_(distance);
        // The damping of the tick before, which is when the force left: from a speed with the
        // coupling's filter of 2 ms.
        const double undamped = sent + guarded_.damping_N_s_per_m * speed_;
        const double handle = tick.reading.position_m.x();
        constexpr double keep = 2.0 / 3;
        speed_ = keep * speed_ + (1 - keep) * (handle - handle_) * servo_rate_hz;
        handle_ = handle;

        const double error = undamped - hand_force(guarded_.force_law, F_m);
        squares_ += error * error;
        measured_.closest_angstrom = std::min(measured_.closest_angstrom, distance);
        measured_.last_angstrom = distance;
        measured_.largest_nN = std::max(measured_.largest_nN, F_m * 1e9);
        measured_.energy_J = tick.hand_energy_J;
        measured_.attraction_N = std::max(measured_.attraction_N, -undamped);
        if (std::abs(sent) >= clamp_newton_ - 1e-9) ++measured_.at_clamp;
        measured_.stage = std::max(measured_.stage, tick.stage);
        sent_.push_back(sent);
    }

    Measured measured() const {
        Measured result = measured_;
        result.error_N = std::sqrt(squares_ / static_cast<double>(sent_.size()));
        const auto last = std::min<std::size_t>(sent_.size(), 4000);
        const std::span<const double> end(sent_.end() - static_cast<std::ptrdiff_t>(last),
                                          sent_.end());
        result.ripple_N = measure_ripple(end, servo_tick_s).value_or(Ripple{}).rms;
        return result;
    }

private:
    GuardedSettings guarded_;
    double clamp_newton_;
    std::function<double(double)> law_newton_;
    Measured measured_;
    std::vector<double> sent_;
    double squares_ = 0, speed_ = 0, handle_ = 0;
};

inline SceneDescription guarded_scene(const GuardedCase& c) {
    std::vector<std::string> settings{"mode=guarded", "stroke=hold",
                                      "period_ms=" + std::to_string(c.period_ms),
                                      "hand.start_angstrom=" + std::to_string(c.start_angstrom)};
    settings.insert(settings.end(), c.settings.begin(), c.settings.end());
    return water_scene(settings);
}

// On a bench long enough for every stroke: none here is about the clutch.
inline EmulatedOmni guarded_omni(const GuardedCase& c) {
    EmulatedOmniSettings settings;
    settings.friction_newton = c.friction_newton;
    settings.hand = c.hand ? c.hand : hand_model(c.grip);
    settings.script = c.script;
    settings.half_workspace_m = Vec3::Constant(0.5);
    return EmulatedOmni(settings);
}

// As run_lockstep, at periods of any kind, and no longer than `on_tick` says yes. What is lost
// never arrives; the next step starts all the same.
inline void run_unsteady(std::uint64_t ticks, const DueFunction& draw, const ServoSettings& servo,
                         Device& device, const LocalContactModel& first, const StepFunction& step,
                         const std::function<bool(const ServoTick&)>& on_tick) {
    Exchange exchange;
    ServoState state;
    ContactModel felt;
    LocalContactModel next = first;
    HandPose hand;
    Due due{0, false};
    std::uint64_t due_at = 0;
    for (std::uint64_t tick = 0; tick < ticks; ++tick) {
        const bool period_begins = tick == due_at;
        if (period_begins && !due.is_lost) {
            exchange.contact.post(next);
            felt = next.model;
        }

        const ServoTick done = step_servo(servo, state, exchange, device.read(),
                                          static_cast<double>(tick) / servo_rate_hz);
        if (!on_tick(done)) return;
        device.write(done.sent_newton);

        exchange.hand.read(hand);
        if (!period_begins) continue;
        next = step(hand, felt);
        due = draw();
        due_at = tick + due.ticks;
    }
}

// The dimer with its fixed water on a spring (N/m) along x, at rest on it after every step. A rigid
// one is attached to an infinite spring.
class SprungDimer {
public:
    SprungDimer(const SceneDescription& scene, double spring_N_per_m)
        : world_(load_world(scene)),
          spring_(spring_N_per_m / units::newton_per_metre_per_kcal_per_mol_angstrom2) {}

    const World& world() const { return world_; }

    LocalContactModel step(const HandPose& hand, const ContactModel& felt) {
        if (std::isinf(spring_)) {
            (void)step_world(world_, hand, felt);
            return contact_at(world_, 0);
        }
        relax_at(hand.molecule.value().place_angstrom);
        update_contact(world_, hand_at(world_, 0), hand);
        return contact_at(world_, 0);
    }

    // Force on the moved water with the other at rest (N, along x).
    double newton_at(double distance) {
        if (std::isinf(spring_)) {
            return force_along_line_at(world_, distance).force *
                   units::newton_per_kcal_per_mol_angstrom;
        }
        relax_at(Vec3(distance, 0, 0));
        return field_on_grabbed(world_).force.x() * units::newton_per_kcal_per_mol_angstrom;
    }

private:
    // Newton's way with steps of 0.05 Å at most, from where it was.
    void relax_at(const Vec3& place) {
        place_grabbed(world_, place);
        for (int i = 0; i < 60; ++i) {
            const FieldSum field = field_on_grabbed(world_);
            const double slope = std::max(spring_ + field.stiffness(0, 0), 0.2 * spring_);
            const double by =
                std::clamp(-(spring_ * moved_ + field.force.x()) / slope, -0.05, 0.05);
            moved_ += by;
            for (const std::uint32_t i : atoms_around(world_))
                world_.write<AtomTable>().positions[i].x() += by;
            if (std::abs(by) < 1e-9) return;
        }
    }

    World world_;
    double spring_;     // kcal/mol/Å^2
    double moved_ = 0;  // Å, the fixed water
};

inline Measured run_guarded(const GuardedCase& c) {
    const SceneDescription scene = guarded_scene(c);
    SprungDimer dimer(scene, c.spring_N_per_m), at_rest(scene, c.spring_N_per_m);
    ServoSettings servo = build_servo_settings(scene, dimer.world(), 0);
    servo.safety.thermal_limit_newton = c.thermal_limit_newton;
    EmulatedOmni omni = guarded_omni(c);
    Watch watch(servo, [&](double distance) { return at_rest.newton_at(distance); });
    const auto step = [&](const HandPose& hand, const ContactModel& felt) {
        return dimer.step(hand, felt);
    };
    const auto on_tick = [&](const ServoTick& tick) {
        watch.add(tick);
        return true;
    };
    const auto ticks = static_cast<std::uint64_t>(std::lround(c.seconds * servo_rate_hz));
    const LocalContactModel& first = contact_at(dimer.world(), 0);
    if (c.draw) {
        run_unsteady(ticks, c.draw, servo, omni, first, step, on_tick);
    } else {
        run_lockstep({ticks, c.period_ms}, servo, omni, first, step, on_tick);
    }
    return watch.measured();
}

// Held at rest and knocked.
inline GuardedCase held(HandGrip grip, double friction_newton, std::uint64_t period_ms) {
    GuardedCase c{grip, friction_newton, period_ms, rest_angstrom};
    c.script.path = {{0, 0}};
    c.script.kick_N_s = 0.005;
    return c;
}

// In by `depth_m`, rest there, and out again.
inline GuardedCase stroke(HandGrip grip, double friction_newton, std::uint64_t period_ms,
                          double stroke_s, double depth_m, double pause_s = 1) {
    GuardedCase c{grip, friction_newton, period_ms};
    const double in = 0.3 + stroke_s, out = in + pause_s;
    c.script.path = {{0.3, 0}, {in, -depth_m}, {out, -depth_m}, {out + stroke_s, 0}};
    c.seconds = out + stroke_s + 1;
    return c;
}

// How deep (m), to half a millimetre, the stroke of a case goes to reach 3 nN at 1 ms without
// friction.
inline double depth_to_peak(const GuardedCase& c, double stroke_s) {
    double less = 0.08, more = 0.2;
    for (int halving = 0; halving < 8; ++halving) {
        const double depth = 0.5 * (less + more);
        GuardedCase tried = stroke(c.grip, 0, 1, stroke_s, depth);
        tried.spring_N_per_m = c.spring_N_per_m;
        tried.seconds = stroke_s + 1.3;
        (run_guarded(tried).largest_nN > 3 ? more : less) = depth;
    }
    return less;
}

}  // namespace palpa::test
