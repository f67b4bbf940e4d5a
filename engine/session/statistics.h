// Statistics of a run, collected tick by tick.
#pragma once
#include "haptics/servo.h"
#include "session/accuracy_report.h"
#include "session/ripple.h"
#include "session/unbinding_path.h"
#include "simulation/remote_engine.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

// For scenes in which only some degrees of freedom are active at a time.
struct Activity {
    double active = 0;  // active degrees of freedom, mean over the steps
    // Share of the weighted squares of accelerations that belongs to inactive degrees of freedom,
    // mean over the selections.
    double neglected_share = 0;
    std::uint64_t choices = 0;
    double within_budget = 1;  // share of steps within the time budget; 1 without a budget
};

// For scenes whose molecules relax. Errors are estimates of the force on the hand compared with
// complete relaxation.
struct RelaxationSummary {
    std::uint64_t estimates = 0;
    double error_median_pN = 0, error_90_pN = 0;
    std::uint64_t renewals = 0;  // number of linearisations
    // Wall time of steps without a renewal, and of steps with one.
    double between_median_us = 0, between_90_us = 0, between_99_us = 0;
    double renewal_median_us = 0;
    // Number of renewals that released more than 1 kcal/mol because a minimum had vanished, and the
    // energy that they released in total, kcal/mol.
    std::uint64_t snaps = 0;
    double released = 0;
};

// The way of a hand's handle, without that under the clutch.
struct HandTravel {
    double handle_m = 0;        // length of the way; tremor below half a millimetre does not count
    double lost_m = 0;          // handle travel that the molecule will never follow (clipped)
    std::uint64_t strokes = 0;  // ways between two clutches
    double at_stop_s = 0;       // time at an end of the workspace, s
};

struct Summary {
    std::string device = "emulated Omni";
    std::uint64_t ticks = 0, steps = 0;
    std::uint64_t steps_not_finite = 0;
    std::uint64_t client_pulls = 0;  // steps in which clients applied a force (ClientPull)
    // Force evaluations since the scene was loaded, and how many of them fast pairs handed to
    // double precision. 0 if no molecule moves by itself.
    std::uint64_t sums = 0, sums_in_double = 0;
    double step_median_us = 0, step_p99_us = 0;  // wall time
    std::optional<Ripple> ripple;  // of the device force along its strongest axis, last 4 s
    double net_work_J = 0;         // done on the hand; + = generated
    double largest_felt_N = 0;     // in any direction
    // For a held molecule on one axis: the largest attraction towards the other one, and the
    // largest repulsion.
    bool is_on_axis = true;
    double largest_attraction_N = 0, largest_repulsion_N = 0;
    double closest_angstrom = 0;  // smallest distance of the reference atoms
    double last_angstrom = 0;     // negative on the other side
    bool went_through = false;    // the molecule passed through the other one
    HandTravel travel;
    double clamped_share = 0;  // share of the time with clipped force
    // Share of the time in which a safety measure reduced the force, and the gravest of these.
    double safety_share = 0;
    SafetyStage gravest = SafetyStage::None;
    bool is_safety_full = true;              // the whole safety chain was active in every tick
    bool stopped = false;                    // a force was not finite
    std::uint64_t overruns = 0;              // late servo ticks; none in lockstep
    std::optional<UnbindingPath> unbinding;  // in space, if molecules move by themselves
    std::optional<Activity> activity;
    std::optional<RelaxationSummary> relaxation;
    std::optional<EngineReport> engine;
    std::vector<std::string> neglected;      // interactions and motions that the model leaves out
    std::optional<AccuracyReport> accuracy;  // if the scene states what must be felt
    std::vector<std::string> warnings;
    // The second and further hands in order: the device of each, what it felt and did.
    std::vector<Summary> other_hands;
};

// Distribution of step times in constant memory.
class StepTimes {
public:
    StepTimes();

    void add(double seconds);
    // Quantile: the middle of the class (1 % wide) that contains it; 0 without any step.
    double quantile_us(double share) const;

private:
    std::uint64_t steps_ = 0;
    std::vector<std::uint64_t> counts_;  // counts by class
};

// Statistics of one hand in constant memory.
class Statistics {
public:
    // `tick_s`: period of the servo.
    explicit Statistics(double tick_s);

    void add(const ServoTick& tick);
    void add_step(double seconds, bool finite);

    Summary summary() const;
    std::uint64_t ticks() const noexcept { return running_.ticks; }
    const HandTravel& travel() const noexcept { return running_.travel; }

private:
    void add_place(const ContactModel& contact);
    void add_travel(const ServoTick& tick);

    double tick_s_;
    Summary running_;
    Vec3 first_place_angstrom_ = Vec3::Zero();  // when the grip began
    std::uint32_t grip_number_ = 0;
    std::uint64_t clamped_ticks_ = 0, safety_ticks_ = 0, stop_ticks_ = 0;
    std::optional<Vec3> counted_m_;  // handle position up to which the way is counted
    bool is_in_stroke_ = false;
    std::array<std::vector<double>, 3> recent_force_;  // by axis, N: ring buffer of the last 4 s
    StepTimes step_times_;
};

}  // namespace palpa
