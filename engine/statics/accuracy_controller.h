// Controls the work of a quasi-static step so that the force stays within a tolerance of complete
// relaxation, by error estimates made now and then (simulation/paper_step.h).
#pragma once
#include "math/vec.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa {

// The work that a step may do.
struct WorkBudget {
    std::size_t active = 0;  // active degrees of freedom
    std::size_t steps = 0;   // relaxation steps

    friend bool operator==(const WorkBudget&, const WorkBudget&) = default;
};

// Work is measured in steps with everything active, so that it does not depend on the speed of the
// machine: a run without a time budget repeats to the bit.
class AccuracyController {
public:
    static constexpr std::size_t estimate_steps =
        100;  // relaxation steps of one error estimate, at most
    static constexpr double estimate_share =
        0.2;  // share of all work that error estimates may take
    static constexpr std::size_t most_steps =
        20;  // relaxation steps in a step of the simulation, at most

    // Starts with the scene's work budget; the number of steps never falls below it. With a time
    // budget the number of steps stays constant, because more steps would leave less time for
    // joints.
    AccuracyController(double tolerance_pN, const WorkBudget& scene, std::size_t coordinates,
                       bool has_budget) noexcept;

    // Records a step that used this work budget.
    void add_step(const WorkBudget& used) noexcept;
    // True if the next error estimate is due, that is, if its work is within the allowed share.
    bool is_due() const noexcept;
    // Adjusts the work budget to an error estimate, found after `steps` steps with these rendered
    // forces, one per hand. The measure is the error that nine of the last ten estimates with this
    // budget do not exceed. Above 0.7 of the tolerance (the servo's prediction between steps adds
    // to the error) the number of active joints rises by half up to all, then the number of steps;
    // once more for every doubling of the error. Below half of that, first steps and then joints
    // fall by a fifth, but only after a change of force that could have caused an error. Without
    // changes estimates become rarer until one is too large.
    void add_estimate(double error_pN, std::span<const Vec3> rendered_pN, std::size_t steps);

    void set_tolerance(double tolerance_pN) noexcept { tolerance_pN_ = tolerance_pN; }
    double tolerance() const noexcept { return tolerance_pN_; }
    const WorkBudget& work_budget() const noexcept { return work_budget_; }
    bool has_budget() const noexcept { return has_budget_; }
    // The error, pN, that nine of ten estimates with this work budget do not exceed; nothing before
    // the first.
    std::optional<double> error() const;

private:
    void raise() noexcept;
    void lower() noexcept;

    static constexpr std::size_t least_active = 8;

    double tolerance_pN_;
    std::size_t coordinates_, scene_steps_;
    bool has_budget_;
    WorkBudget work_budget_;
    std::vector<double>
        errors_pN_;              // ring buffer of the last error estimates with this work budget
    std::size_t estimates_ = 0;  // number of estimates with this work budget
    double last_error_pN_ = 0;
    std::vector<Vec3> rendered_pN_;  // forces at the first estimate with this work budget
    double largest_change_pN_ = 0;   // largest change of one of them since then
    double saved_ = 0;               // work available for error estimates
    double since_estimate_ = 0;      // part of it gained since the last estimate
    double estimate_work_ = 20;
    double rareness_ = 1;
};

}  // namespace palpa
