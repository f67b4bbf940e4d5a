// What is worth knowing of a run, gathered tick by tick.
#pragma once
#include "haptics/servo.h"
#include "session/accuracy_report.h"
#include "session/ripple.h"
#include "session/unbinding_path.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// Of scenes in which few degrees of freedom are active at a time.
struct Activity {
    double active = 0;  // degrees of freedom, on average over the steps
    // Of the weighted squares of accelerations, on average over the choices: how much was not
    // chosen.
    double neglected_share = 0;
    std::uint64_t choices = 0;
    double within_budget = 1;  // share of the steps; 1 without a budget
};

// Of steps in which molecules relaxed. Errors are those of the force on the hand against complete
// relaxation, as estimated.
struct RelaxationSummary {
    std::uint64_t estimates = 0;
    double error_median_pN = 0, error_90_pN = 0;
    std::uint64_t renewals = 0;  // linearisations
    // Wall time of steps within which none was made, and of those within which one was.
    double between_median_us = 0, between_90_us = 0, between_99_us = 0;
    double renewal_median_us = 0;
    // Renewals that set more than 1 kcal/mol free, since a minimum had vanished; and how much these
    // set free in all, kcal/mol.
    std::uint64_t snaps = 0;
    double released = 0;
};

// Of a run that a remote engine moved.
struct EngineSummary {
    std::uint64_t frames = 0;         // that came
    double frames_per_s = 0;          // wall time, towards the end; 0: not known
    double delay_ms = 0;              // from the atoms' motion to the force on the hand
    std::uint64_t interruptions = 0;  // how often frames ceased to come
    std::string state;                // at the end, a sentence
};

struct Summary {
    std::string device = "emulated Omni";
    std::uint64_t ticks = 0, steps = 0;
    std::uint64_t steps_not_finite = 0;
    std::uint64_t client_pulls = 0;  // steps in which clients pulled (ClientPull)
    // Sums of forces since the scene was loaded, and those that fast pairs left to double. 0 where
    // nothing moves by itself.
    std::uint64_t sums = 0, sums_in_double = 0;
    double step_median_us = 0, step_p99_us = 0;  // wall time
    std::optional<Ripple> ripple;  // of the device force, along the axis where it is most, last 4 s
    double net_work_J = 0;         // done on the hand; + = generated
    double largest_felt_N = 0;     // in any direction
    // Where the molecule in hand has one axis: what drew it to the other one, and what drove it
    // away.
    bool is_on_axis = true;
    double largest_attraction_N = 0, largest_repulsion_N = 0;
    double closest_angstrom = 0;  // smallest distance of the reference atoms
    double last_angstrom = 0;     // negative on the other side
    bool went_through = false;    // the molecule came out on the other side
    double clamped_share = 0;     // of the time
    // Of the time in which something was wrong that held the force back, and the gravest of that.
    double safety_share = 0;
    SafetyStage gravest = SafetyStage::None;
    bool is_safety_full = true;              // the whole chain guarded every tick
    bool stopped = false;                    // a force was not finite
    std::uint64_t overruns = 0;              // servo ticks that came too late; none in lockstep
    std::optional<UnbindingPath> unbinding;  // in space, where something moves by itself
    std::optional<Activity> activity;
    std::optional<RelaxationSummary> relaxation;
    std::optional<EngineSummary> engine;
    std::vector<std::string> neglected;      // of the interactions and the motion of the molecules
    std::optional<AccuracyReport> accuracy;  // where the scene says what must be felt
    std::vector<std::string> warnings;
    // Second hand and on, in their order: of each its device and what it felt and did.
    std::vector<Summary> other_hands;
};

// How long steps take, in as much memory however many there are.
class StepTimes {
public:
    StepTimes();

    void add(double seconds);
    // The middle of the class, 1 % wide, in which that share of the steps is reached; 0 without
    // any.
    double quantile_us(double share) const;

private:
    std::uint64_t steps_ = 0;
    std::vector<std::uint64_t> counts_;  // by class
};

// Of one hand; takes the same memory however long the run is.
class Statistics {
public:
    // `tick_s`: of the servo.
    explicit Statistics(double tick_s);

    void add(const ServoTick& tick);
    void add_step(double seconds, bool finite);

    Summary summary() const;
    std::uint64_t ticks() const noexcept { return running_.ticks; }

private:
    void add_place(const ContactModel& contact);

    double tick_s_;
    Summary running_;
    Vec3 first_place_angstrom_ = Vec3::Zero();  // since the last start
    std::uint32_t start_ = 0;
    std::uint64_t clamped_ticks_ = 0, safety_ticks_ = 0;
    std::array<std::vector<double>, 3> recent_force_;  // by axis, N: a ring of the last 4 s
    StepTimes step_times_;
};

}  // namespace palpa
