// Whether the force that steps tell is within a tolerance of what all joints would give: found now
// and then by an audit on a copy. From that follows how much work a step does.
#pragma once
#include "statics/step_quasi_static.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa {

// What a step may use.
struct Effort {
    std::size_t active = 0;  // degrees of freedom
    std::size_t steps = 0;   // towards rest

    friend bool operator==(const Effort&, const Effort&) = default;
};

// Work is told in steps with everything active, so that it does not hang on the machine's speed: a
// run whose steps have no time budget repeats to the bit.
class Exactness {
public:
    static constexpr std::size_t audit_steps = 100;  // of one audit, at most
    static constexpr double audit_share = 0.2;       // of all work, at most
    static constexpr std::size_t most_steps = 20;    // of a step of the simulation

    // Begins with the scene's effort, and never has fewer steps. With a time budget steps stay the
    // scene's: time that more of them take would only be taken from joints.
    Exactness(double tolerance_pN, const Effort& scene, std::size_t coordinates,
              bool has_budget) noexcept;

    // A step was made with this effort.
    void add_step(const Effort& used) noexcept;
    // Whether it is time for the next audit, and the work of those before it is made up for.
    bool is_due() const noexcept;
    // What an audit of so many steps found where that force was told. Nine of ten of the last ten
    // since the effort changed tell: more than 0.7 of the tolerance, since between steps the
    // servo's guess adds to it, and active joints are raised by half up to all, then steps, once
    // more for each doubling of it; less than half of that, and first steps, then joints are
    // lowered by a fifth, but only after a change of the force that could have been wrong. Where
    // nothing is to be changed audits become rarer, until one finds too much.
    void add_audit(double error_pN, const Vec3& told_pN, std::size_t steps);

    void set_tolerance(double tolerance_pN) noexcept { tolerance_pN_ = tolerance_pN; }
    double tolerance() const noexcept { return tolerance_pN_; }
    const Effort& effort() const noexcept { return effort_; }
    bool has_budget() const noexcept { return has_budget_; }
    // pN, of nine of ten audits with this effort, at most; nothing before the first.
    std::optional<double> error() const;

private:
    void raise() noexcept;
    void lower() noexcept;

    static constexpr std::size_t least_active = 8;

    double tolerance_pN_;
    std::size_t coordinates_, scene_steps_;
    bool has_budget_;
    Effort effort_;
    std::vector<double> errors_pN_;  // of the last audits with this effort, a ring
    std::size_t audits_ = 0;         // with this effort
    double last_error_pN_ = 0;
    Vec3 told_pN_ = Vec3::Zero();   // at the first audit with this effort
    double largest_change_pN_ = 0;  // of what was told since
    double saved_ = 0;              // work that audits may take
    double since_audit_ = 0;        // of it, saved since the last
    double audit_work_ = 20;
    double rareness_ = 1;
};

// One audit: a copy of a state on its way to where all joints bring it while the hand stays.
struct Audit {
    TorsionState state;
    QuasiStatics statics;
    Vec3 told = Vec3::Zero();    // kcal/mol/Å on what the hand holds, as it was told
    Vec3 found = Vec3::Zero();   // and as the copy has it now
    std::size_t steps = 0;       // so far
    std::size_t calm_steps = 0;  // of these the last, that hardly changed the force
    bool is_under_way = false, is_finite = true;
};

// What pulls at the molecule `grabbed`, or at the hand's end of the tether; the state has all
// forces.
Vec3 find_force_on_held(const TorsionModel& model, const TorsionState& state,
                        std::uint32_t grabbed) noexcept;

// Begins at a state for which this force was told (kcal/mol/Å), with steps that go about as far,
// h in AKMA time.
void start_audit(const TorsionModel& model, const QuasiStaticSettings& settings,
                 const TorsionState& state, double h, const Vec3& told, std::uint32_t grabbed,
                 Audit& audit);

struct AuditLimits {
    double change;      // of the force by a step, kcal/mol/Å, above which the audit goes on
    std::size_t steps;  // in all, at most
};

// One step with all joints; ends the audit where there were ten and the last three that were taken
// each changed the force by less, or where there were so many.
void step_audit(const TorsionModel& model, const QuasiStaticSettings& settings,
                std::uint32_t grabbed, const AuditLimits& limits, Audit& audit);

}  // namespace palpa
