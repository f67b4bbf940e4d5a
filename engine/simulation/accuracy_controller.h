// How much work a quasi-static step does, so that the force stays within a tolerance of complete
// relaxation: by error estimates that are made now and then (simulation/observe.h).
#pragma once
#include "statics/step_quasi_static.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// What a step may use.
struct WorkBudget {
    std::size_t active = 0;  // degrees of freedom
    std::size_t steps = 0;   // towards rest

    friend bool operator==(const WorkBudget&, const WorkBudget&) = default;
};

// Work is counted in steps with everything active, so that it does not depend on the machine's
// speed: a run whose steps have no time budget repeats to the bit.
class AccuracyController {
public:
    static constexpr std::size_t estimate_steps = 100;  // of one error estimate, at most
    static constexpr double estimate_share = 0.2;       // of all work, at most
    static constexpr std::size_t most_steps = 20;       // of a step of the simulation

    // Begins with the scene's work budget, and never has fewer steps. With a time budget steps stay
    // the scene's: time that more of them take would only be taken from joints.
    AccuracyController(double tolerance_pN, const WorkBudget& scene, std::size_t coordinates,
                       bool has_budget) noexcept;

    // A step was made with this work budget.
    void add_step(const WorkBudget& used) noexcept;
    // Whether it is time for the next error estimate, and the work of those before it is made up
    // for.
    bool is_due() const noexcept;
    // What an error estimate of so many steps found where that force was rendered. Nine of ten of
    // the last ten since the work budget changed tell: more than 0.7 of the tolerance, since
    // between steps the servo's guess adds to it, and active joints are raised by half up to all,
    // then steps, once more for each doubling of it; less than half of that, and first steps, then
    // joints are lowered by a fifth, but only after a change of the force that could have been
    // wrong. Where nothing is to be changed error estimates become rarer, until one finds too much.
    void add_estimate(double error_pN, const Vec3& rendered_pN, std::size_t steps);

    void set_tolerance(double tolerance_pN) noexcept { tolerance_pN_ = tolerance_pN; }
    double tolerance() const noexcept { return tolerance_pN_; }
    const WorkBudget& work_budget() const noexcept { return work_budget_; }
    bool has_budget() const noexcept { return has_budget_; }
    // pN, of nine of ten error estimates with this work budget, at most; nothing before the first.
    std::optional<double> error() const;

private:
    void raise() noexcept;
    void lower() noexcept;

    static constexpr std::size_t least_active = 8;

    double tolerance_pN_;
    std::size_t coordinates_, scene_steps_;
    bool has_budget_;
    WorkBudget work_budget_;
    std::vector<double> errors_pN_;  // of the last error estimates with this work budget, a ring
    std::size_t estimates_ = 0;      // with this work budget
    double last_error_pN_ = 0;
    Vec3 rendered_pN_ = Vec3::Zero();  // at the first error estimate with this work budget
    double largest_change_pN_ = 0;     // of the rendered force since
    double saved_ = 0;                 // work that error estimates may take
    double since_estimate_ = 0;        // of it, saved since the last
    double estimate_work_ = 20;
    double rareness_ = 1;
};

// What a hand has hold of in a state: a molecule of the torsion model, or the spring of that
// number.
struct HeldInState {
    std::uint32_t base = 0;
    std::int32_t spring = -1;  // none
};

// What pulls at the molecule, or at the hand's end of its spring; the state has all forces.
Vec3 find_force_on_held(const TorsionModel& model, const TorsionState& state,
                        const HeldInState& held) noexcept;

}  // namespace palpa
